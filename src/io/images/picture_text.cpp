// SPDX-License-Identifier: Apache-2.0
#include "picture_text.h"

#include <png.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "pellucid/io/image_files.h"
#include "pellucid/scene/error.h"
#include "png_failure.h"

namespace pellucid {
namespace {

/// Memory for what libpng reads, made where nothing can be torn away.
struct PngText {
  const char* key;
  std::vector<png_byte> row;
  std::string text;
  bool found = false;
};

bool read_with_libpng(std::FILE* file, PngText& to, PngFailure& failure) {
  return read_png(file, failure, [&](png_structp png, png_infop info) {
    png_textp texts = nullptr;
    int count = 0;
    png_get_text(png, info, &texts, &count);
    for (int i = 0; i < count; ++i) {
      if (std::strcmp(texts[i].key, to.key) != 0) continue;
      to.text = texts[i].text;
      to.found = true;
    }
    to.row.resize(png_get_rowbytes(png, info));
    for (png_uint_32 y = 0; y < png_get_image_height(png, info); ++y) {
      png_read_row(png, to.row.data(), nullptr);
    }
  });
}

}  // namespace

std::optional<std::string> picture_text(const std::filesystem::path& path, const std::string& key) {
  if (path.extension() == ".exr") {
    try {
      const Image image = read_exr(path);
      const auto found = image.metadata.find(key);
      return found == image.metadata.end() ? std::nullopt : std::optional(found->second);
    } catch (const Error&) {
      return std::nullopt;
    }
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (!file) return std::nullopt;
  PngText text{key.c_str(), {}, {}, false};
  PngFailure failure;
  if (!read_with_libpng(file.get(), text, failure) || !text.found) return std::nullopt;
  return std::move(text.text);
}

}  // namespace pellucid
