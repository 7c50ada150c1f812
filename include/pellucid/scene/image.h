// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace pellucid {

/// Premultiplied linear RGBA, row 0 at the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::array<float, 4>> pixels;
  /// Distance from the ray's origin, in world units, at which half of the pixel's opacity is
  /// reached; the nearest of several samples. +infinity in an empty pixel. Empty vector: not
  /// requested.
  std::vector<float> depth;
  /// Largest possible error of the pixel in any channel; +infinity if unknown (sampling methods).
  /// Empty vector: not requested.
  std::vector<float> error;
  /// 1 if `error` is a proved bound, 0 if it is an estimate. As many elements as `error`.
  std::vector<std::uint8_t> proved;
  /// Value of the projected layer along the pixel's ray (Layer::projection), rounded to float. NaN
  /// where the ray meets no data, but 0 for a sum. Empty vector: not requested.
  std::vector<float> values;
  /// Attributes that are written into the file's header: version, transfer function, camera,
  /// method.
  std::map<std::string, std::string> metadata;

  std::array<float, 4>& at(int column, int row) {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(column)];
  }
  const std::array<float, 4>& at(int column, int row) const {
    return const_cast<Image*>(this)->at(column, row);
  }
};

}  // namespace pellucid
