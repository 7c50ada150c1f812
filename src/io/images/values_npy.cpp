// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <span>
#include <string>

#include "image_checks.h"
#include "npy/npy.h"
#include "pellucid/io/image_files.h"
#include "pellucid/io/internal/atomic_file.h"

namespace pellucid {
void write_values_npy(const Image& image, const std::filesystem::path& path) {
  check_image(image, path);
  check_values(image, path);
  const std::size_t height = static_cast<std::size_t>(image.height);
  std::string file = npy_header("f32", {height, static_cast<std::size_t>(image.width)});
  file.reserve(file.size() + 4 * image.values.size());
  const auto bytes = std::as_bytes(std::span(image.values));
  file.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  write_text_file(path, file);
}

}  // namespace pellucid
