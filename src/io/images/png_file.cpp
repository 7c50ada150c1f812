// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "image_checks.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"
#include "pellucid/scene/error.h"
#include "png_bytes.h"
#include "png_failure.h"

namespace pellucid {

namespace {

// What libpng is given, with nothing in it that it could not be torn away from.
struct PngContent {
  png_uint_32 width, height;
  int color_type;
  png_bytepp rows;
  png_textp text;
  int texts;
  png_uint_32 pixels_per_metre;
};

// libpng leaves by longjmp where it fails, so nothing in here may need a destructor.
bool write_with_libpng(std::FILE* file, const PngContent& content, PngFailure& failure) {
  png_structp png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, leave_png, ignore_png_warning);
  if (png == nullptr) return false;
  png_infop info = png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_init_io(png, file);
  png_set_IHDR(png, info, content.width, content.height, 8, content.color_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
  if (content.pixels_per_metre > 0) {
    png_set_pHYs(png, info, content.pixels_per_metre, content.pixels_per_metre,
                 PNG_RESOLUTION_METER);
  }
  if (content.texts > 0) png_set_text(png, info, content.text, content.texts);
  png_write_info(png, info);
  png_write_image(png, content.rows);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

/// Throws Error where the image or the background cannot be written.
void check_picture(const Image& image, const std::filesystem::path& path,
                   const std::optional<Background>& background) {
  check_image(image, path);
  check_finite(image, path);
  const auto is_finite = [](const Rgb<double>& color) {
    return std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b);
  };
  if (background && !(is_finite(background->top) && is_finite(background->bottom))) {
    throw Error(path.string() + ": cannot write: the background is not a finite color");
  }
}

/// Bytes of sRGB, with alpha or without, and what is written beside them.
struct PngBytes {
  int width, height;
  std::vector<std::uint8_t>& bytes;
  std::size_t channels;
  std::uint32_t pixels_per_metre;
  std::map<std::string, std::string> texts;
};

/// Writes checked bytes. Returns false where libpng fails.
bool write_stream(std::FILE* stream, PngBytes picture, PngFailure& failure) {
  const std::size_t stride = static_cast<std::size_t>(picture.width) * picture.channels;
  std::vector<png_bytep> rows(static_cast<std::size_t>(picture.height));
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = &picture.bytes[y * stride];

  std::vector<png_text> text;
  for (auto& [key, value] : picture.texts) {
    png_text entry{};
    entry.compression = PNG_ITXT_COMPRESSION_zTXt;
    entry.key = const_cast<char*>(key.c_str());  // read only, by a C signature that cannot say so
    entry.text = value.data();
    entry.itxt_length = value.size();
    text.push_back(entry);
  }
  return write_with_libpng(
      stream,
      {static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height),
       picture.channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, rows.data(),
       text.data(), static_cast<int>(text.size()), picture.pixels_per_metre},
      failure);
}

/// Writes a checked picture. Returns false where libpng fails.
bool write_stream(std::FILE* stream, const Image& image,
                  const std::optional<Background>& background, PngFailure& failure) {
  std::vector<std::uint8_t> bytes = to_srgb8(image, background);
  return write_stream(
      stream,
      {image.width, image.height, bytes, background ? std::size_t{3} : 4, 0, image.metadata},
      failure);
}

/// Returns the file that `write(stream, failure)` writes. Throws Error.
template <class Write>
std::string encoded(const Write& write) {
  char* bytes = nullptr;
  std::size_t size = 0;
  std::FILE* const stream = open_memstream(&bytes, &size);
  if (stream == nullptr) throw std::bad_alloc();
  PngFailure failure;
  const bool written = write(stream, failure);
  const bool closed = std::fclose(stream) == 0;
  const std::unique_ptr<char, void (*)(void*)> owner(bytes, std::free);
  if (!written || !closed) throw Error(std::string("PNG: cannot encode: ") + failure.text);
  return {bytes, size};
}

}  // namespace

void write_png(const Image& image, const std::filesystem::path& path,
               const std::optional<Background>& background) {
  check_picture(image, path, background);
  AtomicFile file(path);
  std::FILE* stream = std::fopen(file.temporary_path().c_str(), "wb");
  if (stream == nullptr) throw Error(path.string() + ": cannot write the file");
  PngFailure failure;
  const bool written = write_stream(stream, image, background, failure);
  const bool closed = std::fclose(stream) == 0;
  if (!written) throw Error(path.string() + ": cannot write: " + failure.text);
  if (!closed) throw Error(path.string() + ": cannot write: is the disk full?");
  file.commit();
}

std::string encode_png(const Image& image, const std::optional<Background>& background) {
  check_picture(image, "PNG", background);
  return encoded([&](std::FILE* stream, PngFailure& failure) {
    return write_stream(stream, image, background, failure);
  });
}

std::string encode_png_bytes(int width, int height, std::vector<std::uint8_t>& rgb,
                             std::uint32_t pixels_per_metre,
                             std::map<std::string, std::string> texts) {
  return encoded([&](std::FILE* stream, PngFailure& failure) {
    return write_stream(stream, {width, height, rgb, 3, pixels_per_metre, std::move(texts)},
                        failure);
  });
}

}  // namespace pellucid
