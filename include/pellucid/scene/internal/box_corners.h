// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "pellucid/geometry/affine.h"
#include "pellucid/geometry/box.h"

namespace pellucid {

/// Returns the corners of a box; bit a of a corner's place says at which end of axis a it lies.
constexpr std::array<Vec3<double>, 8> box_corners(const Box<double>& box) noexcept {
  std::array<Vec3<double>, 8> corners{};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (int a = 0; a < 3; ++a) corners[i][a] = (i >> a & 1) != 0 ? box.upper[a] : box.lower[a];
  }
  return corners;
}

/// Returns them moved.
constexpr std::array<Vec3<double>, 8> box_corners(const Box<double>& box,
                                                  const Affine<double>& to) noexcept {
  std::array<Vec3<double>, 8> corners = box_corners(box);
  for (Vec3<double>& corner : corners) corner = to.point(corner);
  return corners;
}

}  // namespace pellucid
