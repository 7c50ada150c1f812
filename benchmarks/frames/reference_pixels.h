// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid::bench {

/// Pixels that stand for a whole image: `count` of them, or all where there are not more, as
/// row-major indices, ascending, always the same for one size. One row and one column whole, at
/// 3/8 and 5/8 of the image, the others at random.
std::vector<std::size_t> chosen_pixels(ImageSize size, std::size_t count);

/// What the reference sees there, not rounded.
struct ReferencePixels {
  std::vector<std::size_t> index;
  std::vector<std::array<double, 4>> value;
};

/// By reference_ray on `threads` >= 1, or from the folder if they were made before: the file's name
/// is a hash of all that they depend on. An empty folder: always made.
ReferencePixels reference_pixels(const Scene& scene, std::size_t count, int threads,
                                 const std::filesystem::path& folder);

/// Over the chosen pixels and the channels R, G, B, A; infinite where the image is not finite.
struct PixelError {
  double largest = 0, rms = 0;
};
PixelError error_of(const Image& image, const ReferencePixels& reference);

}  // namespace pellucid::bench
