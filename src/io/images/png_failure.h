// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <png.h>

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

}  // namespace pellucid
