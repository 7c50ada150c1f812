// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/frames/reference_cache.h"

#include <cstring>
#include <fstream>

#include "benchmarks/support/document.h"
#include "pellucid/io/atomic_file.h"
#include "pellucid/reference/render.h"
#include "tests/scenes/scene_hash.h"

namespace pellucid::bench {
Image cached_reference(const Scene& scene, const std::filesystem::path& folder) {
  if (folder.empty()) return render_reference(scene);
  std::filesystem::create_directories(folder);
  const std::filesystem::path file =
      folder /
      format("%016llx.rgba32f", static_cast<unsigned long long>(scenes::scene_hash(scene)));
  Image image;
  image.width = scene.size.width;
  image.height = scene.size.height;
  image.pixels.resize(static_cast<std::size_t>(image.width) *
                      static_cast<std::size_t>(image.height));
  const std::size_t size = image.pixels.size() * sizeof(image.pixels[0]);
  if (std::filesystem::exists(file) && std::filesystem::file_size(file) == size) {
    const std::string bytes = read_text_file(file, size);
    std::memcpy(image.pixels.data(), bytes.data(), size);
    return image;
  }
  image = render_reference(scene);
  std::string bytes(size, '\0');
  std::memcpy(bytes.data(), image.pixels.data(), size);
  write_text_file(file, bytes);
  return image;
}

}  // namespace pellucid::bench
