// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pellucid/packet/cells/corner_loads.h"
#include "pellucid/packet/steps/step_positions.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Loads the corners of cells, one in each lane, as they are: in double, or in binary32 where that
/// holds them.
template <int N>
class ExactCorners {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;

  /// `cell`: in plane coordinates; one outside of the grid counts as the nearest.
  ExactCorners(const PacketGrid& grid, const I* cell) noexcept
      : padded_(grid.padded()), row_(grid.row), slice_(grid.slice) {
    std::int32_t first[3][N];
    for (int a = 0; a < 3; ++a) {
      cell_[a] = min(max(cell[a], I(0)), I(grid.cells[a] - 1)) - I(grid.padding[a]);
      from_[a] = min(max(cell_[a], I(0)), I(grid.values[a] - 2));
      from_[a].store(first[a]);
    }
    for (int l = 0; l < N; ++l) {
      base_[l] = first[0][l] + row_ * first[1][l] + slice_ * first[2][l];
    }
  }

  /// Loads the corners from the values of one grid, x fastest.
  template <class Value>
  CellCorners<D> operator()(const Value* data) const noexcept {
    const Value* at[N];
    for (int l = 0; l < N; ++l) at[l] = data + base_[l];
    CellCorners<D> corners = load<Value>(at);
    if (padded_) repeat_border(cell_, from_, corners);
    return corners;
  }
  /// The same in binary32, of a type that it holds.
  template <class Value>
  CellCorners<F> in_single(const Value* data) const noexcept {
    const Value* at[N];
    for (int l = 0; l < N; ++l) at[l] = data + base_[l];
    CellCorners<F> corners = load_single<Value>(at);
    if (padded_) repeat_border(cell_, from_, corners);
    return corners;
  }

 private:
  template <class Value>
  CellCorners<F> load_single(const Value* const* at) const noexcept {
    static constexpr std::int32_t none_on[N] = {};
    return load_corners<Value, N>(at, none_on, row_, slice_);
  }
  template <class Value>
  CellCorners<D> load(const Value* const* at) const noexcept {
    CellCorners<D> result;
    if constexpr (sizeof(Value) > 2 && !std::is_same_v<Value, float>) {
      for (int n = 0; n < 8; ++n) {
        double of_lane[N];
        const std::ptrdiff_t to = (n & 1) + (n >> 1 & 1) * row_ + (n >> 2) * slice_;
        for (int l = 0; l < N; ++l) of_lane[l] = static_cast<double>(at[l][to]);
        result.value[n] = D::load(of_lane);
      }
    } else {
      const CellCorners<F> corners = load_single<Value>(at);
      for (int n = 0; n < 8; ++n) result.value[n] = convert<double>(corners.value[n]);
    }
    return result;
  }

  bool padded_;
  std::ptrdiff_t row_, slice_;
  I cell_[3], from_[3];
  std::ptrdiff_t base_[N];
};

}  // namespace pellucid
#endif
