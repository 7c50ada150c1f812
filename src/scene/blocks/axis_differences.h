// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "pellucid/field/structured_grid.h"

namespace pellucid {

/// First and second derivatives along one axis at its data values: those of the parabola through
/// three neighbours (Fornberg 1988, n = 2), in the middle of them but for the border; of the line
/// where there are two values; 0 where there is one. On a uniform axis, away from the border, these
/// are the central differences.
class AxisDifferences {
 public:
  /// Weights by which the derivatives follow from the three values v. Steps and not values are
  /// weighted, so that a constant has a derivative of exactly 0. A NaN is in every result that its
  /// value belongs to, also with a weight of 0.
  struct Stencil {
    std::array<int, 3> at{};  ///< indices along the axis
    int middle = 0;           ///< which of the three is the value itself
    std::array<double, 2> first_weight{}, second_weight{};

    double first(double v0, double v1, double v2) const noexcept {
      return first_weight[0] * (v1 - v0) + first_weight[1] * (v2 - v1);
    }
    double second(double v0, double v1, double v2) const noexcept {
      return second_weight[0] * (v1 - v0) + second_weight[1] * (v2 - v1);
    }
  };

  explicit AxisDifferences(const GridAxis<double>& axis) {
    const int n = axis.values;
    const auto width = [&](int i) {
      return axis.plane(i + 1 + axis.padding) - axis.plane(i + axis.padding);
    };
    if (n > 1) unit_ = width(0);
    for (int i = 1; i + 1 < n; ++i) unit_ = std::min(unit_, width(i));
    stencils_.resize(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      Stencil& s = stencils_[static_cast<std::size_t>(i)];
      const int base = std::clamp(i - 1, 0, std::max(n - 3, 0));
      s.middle = i - base;
      for (int m = 0; m < 3; ++m) s.at[static_cast<std::size_t>(m)] = std::min(base + m, n - 1);
      if (n == 2) {
        s.first_weight = {1, 0};
      } else if (n > 2) {
        const double h[2] = {width(base) / unit_, width(base + 1) / unit_};
        const double bend[2] = {-1 / (h[0] * (h[0] + h[1])), 1 / (h[1] * (h[0] + h[1]))};
        // The slope at the middle, carried to where the value is by the bend.
        const double from_middle = i == base ? -h[0] : i == base + 1 ? 0 : h[1];
        const double to_first = h[0] + 2 * from_middle;
        s.first_weight = {1 / h[0] + to_first * bend[0], to_first * bend[1]};
        s.second_weight = {2 * bend[0], 2 * bend[1]};
      }
    }
  }

  const Stencil& operator[](int i) const noexcept { return stencils_[static_cast<std::size_t>(i)]; }
  /// Returns the shortest distance of two neighbours: the unit of length of the derivatives, which
  /// keeps the weights small whatever the coordinates.
  double unit() const noexcept { return unit_; }

 private:
  std::vector<Stencil> stencils_;
  double unit_ = 1;
};

}  // namespace pellucid
