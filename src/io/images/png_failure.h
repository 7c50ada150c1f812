// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <png.h>

#include <csetjmp>
#include <cstdio>

namespace pellucid {

/// A message of libpng where it fails.
struct PngFailure {
  char text[128] = "not enough memory";
};

/// Takes the message and leaves by longjmp: libpng's own handler prints, and a handler may not
/// return.
[[noreturn]] inline void leave_png(png_structp png, png_const_charp message) {
  PngFailure& failure = *static_cast<PngFailure*>(png_get_error_ptr(png));
  std::snprintf(failure.text, sizeof(failure.text), "%s", message);
  png_longjmp(png, 1);
}
inline void ignore_png_warning(png_structp, png_const_charp) {}

/// Reads a PNG by `use(png, info)`, which is called behind the header, and then to its end; a wrong
/// checksum is a failure. libpng leaves by longjmp where it fails, so nothing in `use` may need a
/// destructor. Returns false then.
template <class Use>
bool read_png(std::FILE* file, PngFailure& failure, const Use& use) {
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, leave_png, ignore_png_warning);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_init_io(png, file);
  png_read_info(png, info);
  use(png, info);
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

}  // namespace pellucid
