// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/packet/blocks/packet_grid.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Places of rays in lanes, as cells and places in them. They are found in double every few
/// samples, the anchor, and in float from there: within 32 cells of it, to 6e-6 of a cell.
template <int N>
class StepPositions {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;

  explicit StepPositions(const PacketGrid& grid) noexcept : row(grid.row), slice(grid.slice) {
    for (int a = 0; a < 3; ++a) {
      padding_[a] = grid.padding[a];
      last_[a] = grid.values[a] - 1;
    }
  }

  const std::ptrdiff_t row, slice;  ///< values between neighbours along y, z

  /// Cells by world length.
  void set_direction(const D* direction) noexcept {
    for (int a = 0; a < 3; ++a) direction_[a] = convert<float>(direction[a]);
  }

  /// Samples are from these places on, in plane coordinates. `value` becomes the number of the
  /// value at the lower corner of each lane's cell there.
  PELLUCID_ALWAYS_INLINE void anchor(const D* at, std::ptrdiff_t* value) noexcept {
    double from[3][N];
    for (int a = 0; a < 3; ++a) {
      const D last(last_[a]), place = at[a] - D(padding_[a]);
      const D cell = min(floor(clamp(place, D(0), last)), last - D(1));
      place_[a] = convert<float>(place - cell);
      least_[a] = convert<float>(D(0) - cell);
      most_[a] = convert<float>(last - cell);
      cell.store(from[a]);
    }
    const auto along_y = static_cast<double>(row), along_z = static_cast<double>(slice);
    for (int l = 0; l < N; ++l) {
      value[l] =
          static_cast<std::ptrdiff_t>(from[0][l] + along_y * from[1][l] + along_z * from[2][l]);
    }
  }

  /// At K world lengths from the anchor: how many values on from the anchor's its cell lies, and
  /// the place in [0,1]³ of the cell.
  template <int K>
  PELLUCID_ALWAYS_INLINE void find(const F* offset, std::int32_t (*value)[N],
                                   Vec3<F>* local) const noexcept {
    const I along_y(static_cast<std::int32_t>(row)), along_z(static_cast<std::int32_t>(slice));
    for (int k = 0; k < K; ++k) {
      I cell[3];
      for (int a = 0; a < 3; ++a) {
        const F place =
            clamp(multiply_add(offset[k], direction_[a], place_[a]), least_[a], most_[a]);
        const F lower = min(floor(place), most_[a] - F(1));
        local[k][a] = place - lower;
        cell[a] = convert<std::int32_t>(lower);
      }
      (cell[0] + along_y * cell[1] + along_z * cell[2]).store(value[k]);
    }
  }

 private:
  std::int32_t padding_[3], last_[3];
  F direction_[3];
  F place_[3], least_[3], most_[3];  ///< of the anchor and of the data's ends, in its cell
};

/// The data at the corners of cells, one in each lane: the value at the lower corner stands at
/// at[lane] + on[lane].
template <class Value, int N>
PELLUCID_ALWAYS_INLINE CellCorners<Batch<float, N>> load_corners(const Value* const* at,
                                                                 const std::int32_t* on,
                                                                 std::ptrdiff_t row,
                                                                 std::ptrdiff_t slice) noexcept {
  const std::ptrdiff_t rows[4] = {0, row, slice, slice + row};
  CellCorners<Batch<float, N>> corners;
  pairs_in_rows<Value, N>(at, on, rows, corners.value);
  return corners;
}

/// The data in such cells.
template <class Value, int N>
PELLUCID_ALWAYS_INLINE Batch<float, N> load_trilinear(const Value* const* at,
                                                      const std::int32_t* on, std::ptrdiff_t row,
                                                      std::ptrdiff_t slice,
                                                      Vec3<Batch<float, N>> local) noexcept {
  return trilinear_value(load_corners<Value, N>(at, on, row, slice), local);
}

/// A datum as a sum of two, so that what is small beside it is not rounded off.
template <class T>
struct DatumInCell {
  T corner;  ///< that at the cell's lower corner
  T rest;
};
template <class Value, int N>
PELLUCID_ALWAYS_INLINE DatumInCell<Batch<float, N>> load_in_cell(
    const Value* const* at, const std::int32_t* on, std::ptrdiff_t row, std::ptrdiff_t slice,
    Vec3<Batch<float, N>> local) noexcept {
  CellCorners<Batch<float, N>> corners = load_corners<Value, N>(at, on, row, slice);
  const Batch<float, N> lower = corners.value[0];
  for (Batch<float, N>& corner : corners.value) corner -= lower;
  return {lower, trilinear_value(corners, local)};
}

}  // namespace pellucid
#endif
