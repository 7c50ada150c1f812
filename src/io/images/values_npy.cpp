// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <string>

#include "image_checks.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"

namespace pellucid {
namespace {

/// Preamble and header of NumPy's format 1.0: the values begin at a multiple of 64 bytes.
std::string npy_header(const Image& image) {
  std::string text = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                     std::to_string(image.height) + ", " + std::to_string(image.width) + "), }";
  constexpr std::size_t preamble = 10, alignment = 64;
  while ((preamble + text.size() + 1) % alignment != 0) text += ' ';
  text += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  header += static_cast<char>(text.size() & 0xff);
  header += static_cast<char>(text.size() >> 8);
  return header + text;
}

}  // namespace

void write_values_npy(const Image& image, const std::filesystem::path& path) {
  check_image(image, path);
  check_values(image, path);
  std::string file = npy_header(image);
  file.reserve(file.size() + 4 * image.values.size());
  for (const float value : image.values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) file += static_cast<char>(bits >> shift & 0xff);
  }
  write_text_file(path, file);
}

}  // namespace pellucid
