// SPDX-License-Identifier: Apache-2.0
#include "image_checks.h"

#include <cmath>
#include <string>

#include "pellucid/scene/error.h"

namespace pellucid {

void check_image(const Image& image, const std::filesystem::path& path) {
  if (image.width < 1 || image.height < 1 || image.width > largest_image_side ||
      image.height > largest_image_side) {
    throw Error(path.string() + ": cannot write an image of " + std::to_string(image.width) +
                " x " + std::to_string(image.height) + " pixels; sides are from 1 to " +
                std::to_string(largest_image_side));
  }
  const std::size_t count =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.pixels.size() != count || (!image.depth.empty() && image.depth.size() != count)) {
    throw Error(path.string() + ": cannot write: the image has " +
                std::to_string(image.pixels.size()) + " pixels and " +
                std::to_string(image.depth.size()) + " depths for a size of " +
                std::to_string(image.width) + " x " + std::to_string(image.height));
  }
}

void check_values(const Image& image, const std::filesystem::path& path) {
  if (image.values.size() == image.pixels.size()) return;
  throw Error(path.string() + ": cannot write: the image has " +
              std::to_string(image.values.size()) + " values and " +
              std::to_string(image.pixels.size()) + " pixels");
}

void check_finite(const Image& image, const std::filesystem::path& path) {
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (const float value : image.at(column, row)) {
        if (std::isfinite(value)) continue;
        throw Error(path.string() + ": cannot write: pixel (" + std::to_string(column) + ", " +
                    std::to_string(row) +
                    ") is not a finite number; write an .exr to look at the values");
      }
    }
  }
}

}  // namespace pellucid
