// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pellucid/scene/image.h"

namespace pellucid {

/// The memory of a picture, which another object owns: row by row from the top, without gaps.
/// Elements are those of Image.
struct ImageView {
  int width = 0, height = 0;
  std::array<float, 4>* pixels = nullptr;
  float* depth = nullptr;          ///< null: not requested
  float* error = nullptr;          ///< null: not requested
  std::uint8_t* proved = nullptr;  ///< null: not requested; there if `error` is
  float* values = nullptr;         ///< null: not requested

  ImageView() = default;
  /// Views the memory of an image, which must outlive the view and keep its size.
  explicit ImageView(Image& image) noexcept
      : width(image.width),
        height(image.height),
        pixels(image.pixels.data()),
        depth(image.depth.empty() ? nullptr : image.depth.data()),
        error(image.error.empty() ? nullptr : image.error.data()),
        proved(image.error.empty() ? nullptr : image.proved.data()),
        values(image.values.empty() ? nullptr : image.values.data()) {}

  /// Returns the index of a pixel.
  std::size_t index(int column, int row) const noexcept {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  }
  const std::array<float, 4>& at(int column, int row) const noexcept {
    return pixels[index(column, row)];
  }
};

}  // namespace pellucid
