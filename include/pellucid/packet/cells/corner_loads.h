// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/packet/blocks/packet_grid.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Cells outside of the outermost values, which they were loaded `from`, have the border's twice.
template <class Place, class T>
void repeat_border(const Place* cell, const Place* from, CellCorners<T>& corners) noexcept {
  for (int a = 0; a < 3; ++a) {
    const auto below = cell[a] < from[a], beyond = from[a] < cell[a];
    if (none(below | beyond)) continue;
    for (int n = 0; n < 8; ++n) {
      if ((n >> a & 1) != 0) continue;
      T &lower = corners.value[n], &upper = corners.value[n | 1 << a];
      upper = select(below, lower, upper);
      lower = select(beyond, upper, lower);
    }
  }
}

/// Data along ways through cells, in binary32.
template <class F>
struct CellCubic {
  CubicBernstein<F> data;  ///< NaN in vacuum: one corner that is NaN makes all of it so
  F last_rise;             ///< of the coefficients
  F range;                 ///< of the corners
  F rounding;

  /// `lower`, `upper`: of the corners. Of their differences from one of them: what is rounded is
  /// their range, by 13 u in trilinear_cubic(), 3 u in places and 1 u in themselves, and the value
  /// itself only at the end and in cuts.
  CellCubic(const CellCorners<F>& corners, F lower, F upper, const Vec3<F>& entry,
            const Vec3<F>& exit) noexcept {
    CellCorners<F> differences;
    const F* const v = corners.value;
    for (int n = 0; n < 8; ++n) differences.value[n] = v[n] - v[0];
    data = trilinear_cubic(differences, entry, exit);
    last_rise = data.b[3] - data.b[2];
    for (F& b : data.b) b += v[0];
    constexpr float u = rounding_unit<float>;
    range = upper - lower;
    rounding = F(8 * u) * max(abs(lower), abs(upper)) + F(24 * u) * range;
  }
};

/// Loads the corners of cells, one in each lane, that are given in their block.
template <int N>
class CornerLoads {
 public:
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  explicit CornerLoads(const PacketGrid& grid) noexcept
      : padded(grid.padded()), row_(grid.row), slice_(grid.slice) {}

  const bool padded;  ///< whether there are cells outside of the outermost values

  /// `base`: the value at the lower corner of cell `least`. At a border of cell-centred data both
  /// values of a cell are the border's: the cell `from` is taken, from `least` to `highest`, which
  /// have values. Where nothing is padded, neither is looked at.
  template <class Value>
  void load(const void* const* base, const F* cell, const F* least, const F* highest, F* from,
            CellCorners<F>& corners) const noexcept {
    I place[3];
    for (int a = 0; a < 3; ++a) {
      from[a] = padded ? clamp(cell[a], least[a], highest[a]) : cell[a];
      place[a] = convert<std::int32_t>(padded ? from[a] - least[a] : cell[a]);
    }
    const I offset = place[0] + I(static_cast<std::int32_t>(row_)) * place[1] +
                     I(static_cast<std::int32_t>(slice_)) * place[2];
    std::int32_t o[N];
    offset.store(o);
    const Value* at[N];
    for (int l = 0; l < N; ++l) at[l] = static_cast<const Value*>(base[l]) + o[l];
    const std::ptrdiff_t rows[4] = {0, row_, slice_, slice_ + row_};
    for (int k = 0; k < 4; ++k) {
      gather_pairs(at, SameOffset{rows[k]}, corners.value[2 * k], corners.value[2 * k + 1]);
    }
    if (padded) repeat_border(cell, from, corners);
  }

 private:
  std::ptrdiff_t row_, slice_;
};

}  // namespace pellucid
#endif
