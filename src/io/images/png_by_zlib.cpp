// SPDX-License-Identifier: Apache-2.0
//
// Stands in for png_file.cpp where there is no libpng: in a page. Portable Network Graphics, second
// edition: chunks with a length, a type and a checksum; one of them holds the rows, deflated.
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "files/deflater.h"
#include "image_checks.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"

namespace pellucid {

namespace {

const Bytef* bytes_of(std::string_view text) {
  return reinterpret_cast<const Bytef*>(text.data());
}

void append_number(std::string& text, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(number >> shift & 255);
}

void append_chunk(std::string& file, const std::string& type, const std::string& content) {
  append_number(file, static_cast<std::uint32_t>(content.size()));
  const std::string checked = type + content;
  file += checked;
  append_number(file, static_cast<std::uint32_t>(crc32(crc32(0, nullptr, 0), bytes_of(checked),
                                                       static_cast<uInt>(checked.size()))));
}

/// Returns the bytes as zlib packs them.
std::string packed(const std::string& bytes) {
  std::string result;
  Deflater zlib(Deflater::Wrapping::zlib, [&](std::span<const std::byte> part) {
    result.append(reinterpret_cast<const char*>(part.data()), part.size());
  });
  zlib.put(std::as_bytes(std::span(bytes)));
  zlib.finish();
  return result;
}

/// Returns the rows, each behind the number of its filter: of each byte the one to its left is
/// subtracted (1), which smooth pictures pack well with.
std::string filtered(const std::vector<std::uint8_t>& pixels, std::size_t row, std::size_t step) {
  std::string bytes;
  bytes.reserve(pixels.size() + pixels.size() / row);
  for (std::size_t begin = 0; begin < pixels.size(); begin += row) {
    bytes += '\1';
    for (std::size_t i = 0; i < row; ++i) {
      const int left = i < step ? 0 : pixels[begin + i - step];
      bytes += static_cast<char>((pixels[begin + i] - left) & 255);
    }
  }
  return bytes;
}

}  // namespace

std::string encode_png(const Image& image, const std::optional<Background>& background) {
  check_image(image, "PNG");
  check_finite(image, "PNG");
  const std::size_t channels = background ? 3 : 4;
  std::string header;
  append_number(header, static_cast<std::uint32_t>(image.width));
  append_number(header, static_cast<std::uint32_t>(image.height));
  header += '\x8';                       // bits
  header += background ? '\x2' : '\x6';  // RGB or RGBA
  header.append(3, '\0');                // deflate, filters by row, not interlaced
  std::string file("\x89PNG\r\n\x1a\n", 8);
  append_chunk(file, "IHDR", header);
  append_chunk(file, "sRGB", std::string(1, '\1'));
  for (const auto& [key, text] : image.metadata) {
    // Keyword, not compressed, no language, no translation.
    append_chunk(file, "iTXt", key + std::string(5, '\0') + text);
  }
  append_chunk(file, "IDAT",
               packed(filtered(to_srgb8(image, background),
                               static_cast<std::size_t>(image.width) * channels, channels)));
  append_chunk(file, "IEND", "");
  return file;
}

void write_png(const Image& image, const std::filesystem::path& path,
               const std::optional<Background>& background) {
  write_text_file(path, encode_png(image, background));
}

}  // namespace pellucid
