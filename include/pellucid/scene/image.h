// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace pellucid {

/// Premultiplied linear RGBA, row 0 at the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::array<float, 4>> pixels;
  /// Arc length from the ray's origin, in world units, at which half of the pixel's opacity is
  /// reached; +infinity where the pixel is empty. Empty vector: not asked for.
  std::vector<float> depth;
  /// Written into the file's header: version, transfer function, camera, method.
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
