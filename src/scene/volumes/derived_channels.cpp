// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/derived_channels.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "blocks/axis_differences.h"
#include "derived_volume.h"

namespace pellucid {
namespace {

/// Derivatives at one data value, in units of the axes (AxisDifferences).
struct Derivatives {
  Vec3<double> gradient;
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

/// The derivatives along y and z, and across, of a row along x.
struct RowDerivatives {
  std::vector<double> value, y, z, yy, zz, yz;

  explicit RowDerivatives(std::size_t n) : value(n), y(n), z(n), yy(n), zz(n), yz(n) {}
};

/// All that the derivatives of a grid need, in units in which no step of theirs overflows: lengths
/// in voxels, axes by their own units.
class GridDerivatives {
 public:
  explicit GridDerivatives(const Volume& volume)
      : axis_(volume.visit([](const auto& grid) {
          return std::array<AxisDifferences, 3>{AxisDifferences(grid.axis[0]),
                                                AxisDifferences(grid.axis[1]),
                                                AxisDifferences(grid.axis[2])};
        })),
        voxel_(volume.voxel_size()) {
    for (int c = 0; c < 3; ++c) {
      for (int a = 0; a < 3; ++a) {
        axes_from_voxels_.column[c][a] =
            volume.grid_from_world().matrix.column[c][a] * (voxel_ / axis(a).unit());
      }
    }
  }

  const AxisDifferences& axis(int a) const noexcept { return axis_[static_cast<std::size_t>(a)]; }

  double gradient_magnitude(const Derivatives& d) const noexcept {
    return length(world_gradient(d)) / voxel_;
  }

  double second_derivative(const Derivatives& d) const noexcept {
    const Vec3<double> g = world_gradient(d);
    const double size = std::abs(g.x) + std::abs(g.y) + std::abs(g.z);
    if (size == 0) return 0;
    const Vec3<double> u =
        axes_from_voxels_ * normalized(Vec3<double>{g.x / size, g.y / size, g.z / size});
    const double along = u.x * u.x * d.xx + u.y * u.y * d.yy + u.z * u.z * d.zz +
                         2 * (u.x * u.y * d.xy + u.x * u.z * d.xz + u.y * u.z * d.yz);
    return along / voxel_ / voxel_;
  }

 private:
  Vec3<double> world_gradient(const Derivatives& d) const noexcept {
    return {dot(axes_from_voxels_.column[0], d.gradient),
            dot(axes_from_voxels_.column[1], d.gradient),
            dot(axes_from_voxels_.column[2], d.gradient)};
  }

  std::array<AxisDifferences, 3> axis_;
  double voxel_;
  Mat3<double> axes_from_voxels_;
};

/// Calls result(i, derivatives) along row (j, k); second derivatives only where they are asked for.
template <bool with_second, class Value, class Result>
void each_value(const StructuredGrid<Value, double>& grid, const GridDerivatives& derivatives,
                int j, int k, RowDerivatives& row, const Result& result) {
  const AxisDifferences::Stencil &sy = derivatives.axis(1)[j], &sz = derivatives.axis(2)[k];
  const auto data = [&](int m, int n) {
    return grid.data +
           grid.offset(0, sy.at[static_cast<std::size_t>(m)], sz.at[static_cast<std::size_t>(n)]);
  };
  const int nx = grid.axis[0].values;
  const Value* v[3][3];
  for (int n = 0; n < 3; ++n) {
    for (int m = 0; m < 3; ++m) v[n][m] = data(m, n);
  }
  const auto at = [&](int m, int n, int i) { return static_cast<double>(v[n][m][i]); };
  for (int i = 0; i < nx; ++i) {
    const auto x = static_cast<std::size_t>(i);
    const int my = sy.middle, mz = sz.middle;
    row.value[x] = at(my, mz, i);
    row.y[x] = sy.first(at(0, mz, i), at(1, mz, i), at(2, mz, i));
    row.z[x] = sz.first(at(my, 0, i), at(my, 1, i), at(my, 2, i));
    if constexpr (with_second) {
      row.yy[x] = sy.second(at(0, mz, i), at(1, mz, i), at(2, mz, i));
      row.zz[x] = sz.second(at(my, 0, i), at(my, 1, i), at(my, 2, i));
      row.yz[x] = sz.first(sy.first(at(0, 0, i), at(1, 0, i), at(2, 0, i)),
                           sy.first(at(0, 1, i), at(1, 1, i), at(2, 1, i)),
                           sy.first(at(0, 2, i), at(1, 2, i), at(2, 2, i)));
    }
  }
  for (int i = 0; i < nx; ++i) {
    const auto x = static_cast<std::size_t>(i);
    const AxisDifferences::Stencil& sx = derivatives.axis(0)[i];
    const auto three = [&](const std::vector<double>& of) {
      return std::array<double, 3>{of[static_cast<std::size_t>(sx.at[0])],
                                   of[static_cast<std::size_t>(sx.at[1])],
                                   of[static_cast<std::size_t>(sx.at[2])]};
    };
    const std::array<double, 3> f = three(row.value);
    Derivatives d;
    d.gradient = {sx.first(f[0], f[1], f[2]), row.y[x], row.z[x]};
    if constexpr (with_second) {
      const std::array<double, 3> y = three(row.y), z = three(row.z);
      d.xx = sx.second(f[0], f[1], f[2]);
      d.yy = row.yy[x];
      d.zz = row.zz[x];
      d.xy = sx.first(y[0], y[1], y[2]);
      d.xz = sx.first(z[0], z[1], z[2]);
      d.yz = row.yz[x];
    }
    result(x, d);
  }
}

template <bool with_second, class Quantity>
Volume derive(const Volume& volume, const std::string& what, const ParallelFor& parallel,
              const Quantity& quantity) {
  DerivedVolume derived(volume, what + " of " + volume_name(volume));
  const GridDerivatives derivatives(volume);
  volume.visit([&](const auto& grid) {
    derived.each_rows(parallel, [&](std::size_t first, std::size_t last) {
      RowDerivatives row(static_cast<std::size_t>(grid.axis[0].values));
      const auto ny = static_cast<std::size_t>(grid.axis[1].values);
      for (std::size_t r = first; r < last; ++r) {
        const auto out = derived.row(r);
        each_value<with_second>(grid, derivatives, static_cast<int>(r % ny),
                                static_cast<int>(r / ny), row,
                                [&](std::size_t i, const Derivatives& d) {
                                  out[i] = derived.held(quantity(derivatives, d));
                                });
      }
    });
  });
  return derived.finish();
}

}  // namespace

Volume gradient_magnitude(const Volume& volume, const ParallelFor& parallel) {
  return derive<false>(
      volume, "gradient magnitude", parallel,
      [](const GridDerivatives& grid, const Derivatives& d) { return grid.gradient_magnitude(d); });
}

Volume second_derivative(const Volume& volume, const ParallelFor& parallel) {
  return derive<true>(
      volume, "second derivative", parallel,
      [](const GridDerivatives& grid, const Derivatives& d) { return grid.second_derivative(d); });
}

}  // namespace pellucid
