// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pellucid/packet/cells/cell_positions.h"
#include "pellucid/packet/light.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Loads the gradients of cells, one in each lane, from the data in their own type.
template <int N>
class GradientLoads {
 public:
  using F = Batch<float, N>;
  using M = BatchMask<N>;

  GradientLoads(const PacketGrid& grid, const PacketLight& light) noexcept
      : grid_(grid), light_(light) {}

  /// The gradient's components in the world, along the lanes' ways through their cells, and, if
  /// there is a factor of it, the magnitude.
  void operator()(M lanes, const CellPositions<N>& places, CubicBernstein<F> (&gradient)[3],
                  CubicBernstein<F>& magnitude) const noexcept {
    const Vec3<F> entry{convert<float>(places.entry.x), convert<float>(places.entry.y),
                        convert<float>(places.entry.z)};
    const Vec3<F> exit{convert<float>(places.exit.x), convert<float>(places.exit.y),
                       convert<float>(places.exit.z)};
    (*this)(lanes, places.cell, entry, exit, gradient, magnitude);
  }
  /// Loads the same of ways from `entry` to `exit`, places [0,1]³ in the cells.
  void operator()(M lanes, const Batch<std::int32_t, N> (&cell)[3], const Vec3<F>& entry,
                  const Vec3<F>& exit, CubicBernstein<F> (&gradient)[3],
                  CubicBernstein<F>& magnitude) const noexcept {
    load(lanes, cell);
    CellCorners<F> corners[3];
    for (int a = 0; a < 3; ++a) corners[a] = derivative(a, light_.of_field != 0);
    CubicBernstein<F> of_axis[3];
    for (int a = 0; a < 3; ++a) of_axis[a] = trilinear_cubic(corners[a], entry, exit);
    for (int c = 0; c < 3; ++c) {
      for (int k = 0; k < 4; ++k) {
        const F component = in_world(c, of_axis[0].b[k], of_axis[1].b[k], of_axis[2].b[k]);
        gradient[c].b[k] = select(lanes, component, gradient[c].b[k]);
      }
    }
    if (light_.factor == nullptr) return;
    if (light_.of_field != 0) {
      for (int a = 0; a < 3; ++a) corners[a] = derivative(a, false);
    }
    const CubicBernstein<F> along = trilinear_cubic(sizes_of(corners), entry, exit);
    for (int k = 0; k < 4; ++k) magnitude.b[k] = select(lanes, along.b[k], magnitude.b[k]);
  }

  /// The same at places [0,1]³ in cells, in plane coordinates.
  void at(M lanes, const Batch<std::int32_t, N> (&cell)[3], const Vec3<F>& place, Vec3<F>& gradient,
          F& magnitude) const noexcept {
    load(lanes, cell);
    CellCorners<F> corners[3];
    for (int a = 0; a < 3; ++a) corners[a] = derivative(a, light_.of_field != 0);
    Vec3<F> in_grid;
    for (int a = 0; a < 3; ++a) in_grid[a] = trilinear_value(corners[a], place);
    for (int c = 0; c < 3; ++c) gradient[c] = in_world(c, in_grid.x, in_grid.y, in_grid.z);
    if (light_.factor == nullptr) return;
    if (light_.of_field != 0) {
      for (int a = 0; a < 3; ++a) corners[a] = derivative(a, false);
    }
    magnitude = trilinear_value(sizes_of(corners), place);
  }

 private:
  void load(M lanes, const Batch<std::int32_t, N> (&cell)[3]) const noexcept {
    with_value_type(grid_.type, [&](auto value) noexcept {
      using Value = decltype(value);
      const bool inner = load_values<Value>(lanes, cell);
      is_complete_ = inner && (std::is_integral_v<Value> || !has_vacuum(lanes));
    });
  }
  /// The lengths of gradients at the corners, in the world.
  CellCorners<F> sizes_of(const CellCorners<F> (&corners)[3]) const noexcept {
    CellCorners<F> size;
    for (int n = 0; n < 8; ++n) {
      F square(0);
      for (int c = 0; c < 3; ++c) {
        const F x = in_world(c, corners[0].value[n], corners[1].value[n], corners[2].value[n]);
        square += x * x;
      }
      size.value[n] = sqrt(square);
    }
    return size;
  }
  /// Component c in the world of a gradient in the grid.
  F in_world(int c, const F& x, const F& y, const F& z) const noexcept {
    const float* const w = light_.world_gradient[c];
    return F(w[0]) * x + F(w[1]) * y + F(w[2]) * z;
  }
  /// Returns whether only the corners are needed.
  bool within_cells() const noexcept { return light_.of_field != 0 && light_.factor == nullptr; }

  /// Returns whether any of the values of these lanes is NaN, or too large to be told from it.
  bool has_vacuum(M lanes) const noexcept {
    F sum(0);
    for (int n = 0; n < 8; ++n) {
      sum += F::load(corner_[n]);
      if (within_cells()) continue;
      for (int a = 0; a < 3; ++a) sum += F::load(outside_[a][n]);
    }
    return any(lanes & is_nan(sum - sum));
  }

  /// Loads corners and what is beyond them along each axis. Returns whether all lanes have values
  /// there.
  template <class Value>
  [[gnu::flatten, gnu::noinline]] bool load_values(
      M lanes, const Batch<std::int32_t, N> (&of_lanes)[3]) const noexcept {
    using I = Batch<std::int32_t, N>;
    I place[3];
    M is_inner = lanes;
    for (int a = 0; a < 3; ++a) {
      place[a] = of_lanes[a] - I(grid_.padding[a]);
      is_inner = is_inner & (place[a] >= I(1)) & (place[a] < I(grid_.values[a] - 2));
    }
    const unsigned inner = bits(is_inner), at_border = bits(lanes) & ~inner;
    if (inner != 0) {
      // The other lanes load what one of these does.
      std::int32_t lower[3][N];
      for (int a = 0; a < 3; ++a) {
        select(is_inner, place[a], I(place[a][__builtin_ctz(inner)])).store(lower[a]);
      }
      const Value* const data = static_cast<const Value*>(grid_.data);
      const Value* lowest[N];
      for (int l = 0; l < N; ++l) {
        lowest[l] = data + lower[0][l] + lower[1][l] * grid_.row + lower[2][l] * grid_.slice;
      }
      load_inner(lowest);
    }
    for (int a = 0; a < 3; ++a) {
      F(1).store(has_before_[a]);
      F(1).store(has_behind_[a]);
      F(0).store(flat_[a]);
    }
    if (at_border == 0) return true;
    std::int32_t cell[3][N];
    for (int a = 0; a < 3; ++a) of_lanes[a].store(cell[a]);
    for (unsigned left = at_border; left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      const std::int32_t of_lane[3] = {cell[0][l], cell[1][l], cell[2][l]};
      load_at_border<Value>(l, of_lane);
    }
    return false;
  }

  /// Loads a cell in each lane that has values on all sides, from the place of its lowest corner.
  template <class Value>
  void load_inner(const Value* const (&lowest)[N]) const noexcept {
    const auto pair = [&](int i, int j, int k, float* first, float* second) noexcept {
      F a, b;
      gather_pairs(lowest, SameOffset{i + j * grid_.row + k * grid_.slice}, a, b);
      a.store(first);
      b.store(second);
    };
    for (int row = 0; row < 4; ++row) {
      const int j = row & 1, k = row >> 1, n = 2 * row;
      if (within_cells()) {
        pair(0, j, k, corner_[n], corner_[n + 1]);
        continue;
      }
      pair(-1, j, k, outside_[0][n], corner_[n]);
      pair(1, j, k, corner_[n + 1], outside_[0][n + 1]);
      pair(0, j == 0 ? -1 : 2, k, outside_[1][n], outside_[1][n + 1]);
      pair(0, j, k == 0 ? -1 : 2, outside_[2][n], outside_[2][n + 1]);
    }
  }

  template <class Value>
  void load_at_border(int l, const std::int32_t (&cell)[3]) const noexcept {
    const std::ptrdiff_t stride[3] = {1, grid_.row, grid_.slice};
    std::ptrdiff_t at[3][4];  // before, lower, upper, behind
    for (int a = 0; a < 3; ++a) {
      const int last = grid_.values[a] - 1, place = cell[a] - grid_.padding[a];
      const int lower = clamp(place, 0, last), upper = clamp(place + 1, 0, last);
      const int before = max(lower - 1, 0), behind = min(upper + 1, last);
      at[a][0] = before * stride[a];
      at[a][1] = lower * stride[a];
      at[a][2] = upper * stride[a];
      at[a][3] = behind * stride[a];
      // Of border cells both values are the same.
      has_before_[a][l] = lower > 0 ? 1.0f : 0.0f;
      has_behind_[a][l] = upper < last ? 1.0f : 0.0f;
      flat_[a][l] = lower == upper ? 1.0f : 0.0f;
    }
    const Value* const data = static_cast<const Value*>(grid_.data);
    for (int n = 0; n < 8; ++n) {
      const int i = 1 + (n & 1), j = 1 + (n >> 1 & 1), k = 1 + (n >> 2);
      corner_[n][l] = static_cast<float>(data[at[0][i] + at[1][j] + at[2][k]]);
      if (within_cells()) continue;
      outside_[0][n][l] = static_cast<float>(data[at[0][i == 1 ? 0 : 3] + at[1][j] + at[2][k]]);
      outside_[1][n][l] = static_cast<float>(data[at[0][i] + at[1][j == 1 ? 0 : 3] + at[2][k]]);
      outside_[2][n][l] = static_cast<float>(data[at[0][i] + at[1][j] + at[2][k == 1 ? 0 : 3]]);
    }
  }

  /// The derivative along an axis at the corners, by the distance of two values (GradientKind).
  /// It does not depend on other lanes, not even by a bit, where no value is missing.
  CellCorners<F> derivative(int a, bool of_field) const noexcept {
    if (of_field || is_complete_) return derivative_inside(a, of_field);
    CellCorners<F> result;
    const M flat = F::load(flat_[a]) > F(0);
    for (int n = 0; n < 8; ++n) {
      const bool is_upper = (n >> a & 1) != 0;
      const F here = F::load(corner_[n]), other = F::load(corner_[n ^ 1 << a]);
      // What is beyond, on the side of this corner; where the cell is flat, on both sides.
      const F own = F::load(outside_[a][n]), across = F::load(outside_[a][n ^ 1 << a]);
      const F own_step = is_upper ? own - here : here - own;
      const F beside = select(flat, across, other);
      const F in_cell = is_upper ? here - beside : beside - here;
      M has_own = F::load(is_upper ? has_behind_[a] : has_before_[a]) > F(0);
      M has_cell = (!flat) | (F::load(is_upper ? has_before_[a] : has_behind_[a]) > F(0));
      has_own = has_own & !is_nan(own);
      has_cell = has_cell & !is_nan(in_cell);
      const F central = is_upper ? own - beside : beside - own;
      result.value[n] = select(has_own & has_cell, F(0.5f) * central,
                               select(has_own, own_step, select(has_cell, in_cell, F(0))));
    }
    return result;
  }
  /// The same where no value is missing.
  CellCorners<F> derivative_inside(int a, bool of_field) const noexcept {
    CellCorners<F> result;
    for (int n = 0; n < 8; ++n) {
      if ((n >> a & 1) != 0) continue;
      const int upper = n | 1 << a;
      const F first = F::load(corner_[n]), second = F::load(corner_[upper]);
      if (of_field) {
        result.value[n] = result.value[upper] = second - first;
      } else {
        result.value[n] = F(0.5f) * (second - F::load(outside_[a][n]));
        result.value[upper] = F(0.5f) * (F::load(outside_[a][upper]) - first);
      }
    }
    return result;
  }

  const PacketGrid& grid_;
  const PacketLight& light_;
  mutable bool is_complete_ = false;  ///< whether all values are there, in all lanes
  mutable float corner_[8][N] = {}, outside_[3][8][N] = {};
  mutable float has_before_[3][N] = {}, has_behind_[3][N] = {}, flat_[3][N] = {};
};

}  // namespace pellucid
#endif
