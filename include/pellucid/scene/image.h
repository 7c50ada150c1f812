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
  /// Arc length from the ray's origin, in world units, at which half of the pixel's opacity is
  /// reached; of several samples that of the nearest. +infinity where the pixel is empty. Empty
  /// vector: not asked for.
  std::vector<float> depth;
  /// How far the pixel may be from the exact one in any channel; +infinity where nothing is known
  /// (sampling methods). Empty vector: not asked for.
  std::vector<float> error;
  /// 1 where `error` is a proved bound, 0 where it is an estimate. Of the size of `error`.
  std::vector<std::uint8_t> proved;
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
