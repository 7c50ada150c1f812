// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/packet/packet_grid.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// The data at places of rays in lanes. A place is found in double every few samples, the anchor,
/// and in float from there: within 32 cells of it, to 6e-6 of a cell.
template <class Value, int N>
class PacketSamples {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;

  explicit PacketSamples(const PacketGrid<Value>& grid) noexcept : grid_(grid) {
    const auto row = static_cast<std::int32_t>(grid.row);
    const auto slice = static_cast<std::int32_t>(grid.slice);
    row_[0] = 0;
    row_[1] = row;
    row_[2] = slice;
    row_[3] = slice + row;
  }

  /// Cells by world length.
  void set_direction(const D* direction) noexcept {
    for (int a = 0; a < 3; ++a) direction_[a] = convert<float>(direction[a]);
  }

  /// Samples are from these places on, in plane coordinates.
  void anchor(const D* at) noexcept {
    double from[3][N];
    for (int a = 0; a < 3; ++a) {
      const double last = grid_.values[a] - 1;
      const D place = at[a] - D(grid_.padding[a]);
      const D cell = min(floor(clamp(place, D(0), D(last))), D(last - 1));
      place_[a] = convert<float>(place - cell);
      least_[a] = convert<float>(D(0) - cell);
      most_[a] = convert<float>(D(last) - cell);
      cell.store(from[a]);
    }
    const auto row = static_cast<double>(grid_.row), slice = static_cast<double>(grid_.slice);
    for (int l = 0; l < N; ++l) {
      base_[l] = grid_.data +
                 static_cast<std::ptrdiff_t>(from[0][l] + row * from[1][l] + slice * from[2][l]);
    }
  }

  /// The data at K world lengths from the anchor; NaN in vacuum. All addresses first: what one
  /// sample waits for is done beside the others'.
  template <int K>
  PELLUCID_ALWAYS_INLINE void sample(const F* offset, F* value) const noexcept {
    Vec3<F> local[K];
    std::int32_t o[K][N];
    const I row(static_cast<std::int32_t>(grid_.row)),
        slice(static_cast<std::int32_t>(grid_.slice));
    for (int k = 0; k < K; ++k) {
      I cell[3];
      for (int a = 0; a < 3; ++a) {
        const F place =
            clamp(multiply_add(offset[k], direction_[a], place_[a]), least_[a], most_[a]);
        const F lower = min(floor(place), most_[a] - F(1));
        local[k][a] = place - lower;
        cell[a] = convert<std::int32_t>(lower);
      }
      (cell[0] + row * cell[1] + slice * cell[2]).store(o[k]);
    }
    // Addresses are loaded from there: taking lanes out of registers costs more.
    asm("" : "+m"(o));
    for (int k = 0; k < K; ++k) {
      const Value* at[N];
      for (int l = 0; l < N; ++l) at[l] = base_[l] + o[k][l];
      asm("" : "+m"(at));
      CellCorners<F> corners;
      for (int n = 0; n < 4; ++n) {
        std::int32_t to_row[N];
        for (std::int32_t& to : to_row) to = row_[n];
        gather_pairs(at, to_row, corners.value[2 * n], corners.value[2 * n + 1]);
      }
      value[k] = trilinear_value(corners, local[k]);
    }
  }

 private:
  const PacketGrid<Value>& grid_;
  F direction_[3];
  F place_[3], least_[3], most_[3];  ///< of the anchor and of the data's ends, in its cell
  const Value* base_[N];             ///< the anchor's cell
  std::int32_t row_[4];              ///< of a cell: its rows along x
};

}  // namespace pellucid
#endif
