// SPDX-License-Identifier: Apache-2.0
#include "grid_gradient.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace pellucid {

GridGradient::GridGradient(const Volume& volume, GradientKind kind) : volume_(volume), kind_(kind) {
  volume.visit([&](const auto& grid) {
    for (int a = 0; a < 3; ++a) {
      const auto& axis = grid.axis[a];
      const auto position = [&](int value) { return axis.plane(value + axis.padding); };
      for (int i = 0; i < axis.values; ++i) {
        neighbors_[a].push_back({i > 0 ? position(i) - position(i - 1) : 0,
                                 i + 1 < axis.values ? position(i + 1) - position(i) : 0});
      }
    }
  });
}

double GridGradient::derivative(const Neighbors& apart, double before, double value,
                                double behind) {
  const bool has_before = apart.before > 0 && !std::isnan(before);
  const bool has_behind = apart.behind > 0 && !std::isnan(behind);
  const double first = has_before ? (value - before) / apart.before : 0;
  const double second = has_behind ? (behind - value) / apart.behind : 0;
  if (!has_before) return second;
  if (!has_behind) return first;
  // Slopes of the two sides, weighted by the distance on the other side: the parabola's.
  return (apart.behind * first + apart.before * second) / (apart.before + apart.behind);
}

Vec3<double> GridGradient::to_world(const Vec3<double>& gradient_grid) const {
  const Mat3<double>& m = volume_.grid_from_world().matrix;
  return {dot(m.column[0], gradient_grid), dot(m.column[1], gradient_grid),
          dot(m.column[2], gradient_grid)};
}

GridGradient::Corners GridGradient::smooth_corners(const int (&cell)[3]) const {
  return volume_.visit([&](const auto& grid) {
    Corners result;
    const std::ptrdiff_t stride[3] = {1, grid.axis[0].values,
                                      std::ptrdiff_t{grid.axis[0].values} * grid.axis[1].values};
    for (int n = 0; n < 8; ++n) {
      int index[3];
      for (int a = 0; a < 3; ++a) index[a] = grid.axis[a].value_index(cell[a] + (n >> a & 1));
      const auto* const here = grid.data + grid.offset(index[0], index[1], index[2]);
      const double value = static_cast<double>(*here);
      Vec3<double> gradient;
      for (int a = 0; a < 3; ++a) {
        const Neighbors& apart = neighbors_[a][static_cast<std::size_t>(index[a])];
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        gradient[a] =
            derivative(apart, apart.before > 0 ? static_cast<double>(here[-stride[a]]) : none,
                       value, apart.behind > 0 ? static_cast<double>(here[stride[a]]) : none);
      }
      result.at[n] = to_world(gradient);
    }
    return result;
  });
}

GridGradient::Corners GridGradient::field_corners(const int (&cell)[3]) const {
  return volume_.visit([&](const auto& grid) {
    const CellCorners<double> v = grid.template corners<double>(cell[0], cell[1], cell[2]);
    double width[3];
    for (int a = 0; a < 3; ++a)
      width[a] = grid.axis[a].plane(cell[a] + 1) - grid.axis[a].plane(cell[a]);
    Corners result;
    for (int n = 0; n < 8; ++n) {
      Vec3<double> gradient;
      for (int a = 0; a < 3; ++a) {
        gradient[a] = (v.value[n | 1 << a] - v.value[n & ~(1 << a)]) / width[a];
      }
      result.at[n] = to_world(gradient);
    }
    return result;
  });
}

void GridGradient::along(const StructuredWalk<double>::Step& step,
                         CubicBernstein<double> (&gradient)[3]) const {
  const Corners corners =
      kind_ == GradientKind::smooth ? smooth_corners(step.cell) : field_corners(step.cell);
  for (int a = 0; a < 3; ++a) {
    CellCorners<double> component;
    for (int n = 0; n < 8; ++n) component.value[n] = corners.at[n][a];
    gradient[a] = trilinear_cubic(component, step.entry, step.exit);
  }
}

CubicBernstein<double> GridGradient::magnitude_along(
    const StructuredWalk<double>::Step& step) const {
  const Corners corners = smooth_corners(step.cell);
  CellCorners<double> size;
  for (int n = 0; n < 8; ++n) size.value[n] = length(corners.at[n]);
  return trilinear_cubic(size, step.entry, step.exit);
}

}  // namespace pellucid
