// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "pellucid/packet/cells/gradient_loads.h"
#include "pellucid/packet/steps/sample_places.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Loads cells of a grid, one in each lane. Its values are of a type that binary32 holds.
template <int N>
class CellLoads {
 public:
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// Ways of the lanes through cells.
  struct Ways {
    I cell[3];            ///< in plane coordinates
    Vec3<F> entry, exit;  ///< places in the cell, [0,1]³
  };

  CellLoads(const PellucidPacketJob& job, const PacketLight& light) noexcept
      : grid_(job), gradients_(grid_, light) {}
  // The gradients refer to the grid.
  CellLoads(const CellLoads&) = delete;
  CellLoads& operator=(const CellLoads&) = delete;

  /// The data along the lanes' ways, NaN in vacuum, and what they may be off by.
  void data(M lanes, const Ways& ways, CubicBernstein<F>& result, F& rounding) const noexcept {
    I cell[3], from[3];
    std::int32_t first[3][N];
    for (int a = 0; a < 3; ++a) {
      cell[a] = select(lanes, ways.cell[a], I(0)) - I(grid_.padding[a]);
      from[a] = min(max(cell[a], I(0)), I(grid_.values[a] - 2));
      from[a].store(first[a]);
    }
    std::ptrdiff_t at[N];
    for (int l = 0; l < N; ++l) {
      at[l] = first[0][l] + grid_.row * first[1][l] + grid_.slice * first[2][l];
    }
    CellCorners<F> corners;
    with_value_type(grid_.type, [&](auto value) noexcept {
      using Value = decltype(value);
      if constexpr (std::is_same_v<Value, float> || sizeof(Value) <= 2) load<Value>(at, corners);
    });
    if (grid_.padded()) repeat_border(cell, from, corners);
    F least = corners.value[0], most = least;
    CellCorners<F> differences;
    for (int n = 0; n < 8; ++n) {
      least = min(least, corners.value[n]);
      most = max(most, corners.value[n]);
      differences.value[n] = corners.value[n] - corners.value[0];
    }
    result = trilinear_cubic(differences, ways.entry, ways.exit);
    for (F& b : result.b) b += corners.value[0];
    // As SpanFinder: the range by 13 u, and 3 u in places; the value at the end, and in cuts.
    constexpr float u = rounding_unit<float>;
    rounding = F(8 * u) * max(abs(least), abs(most)) + F(24 * u) * (most - least);
  }

  /// Their gradient in the world, and its magnitude if there is a factor of it.
  void gradients(M lanes, const Ways& ways, CubicBernstein<F> (&gradient)[3],
                 CubicBernstein<F>& magnitude) const noexcept {
    CellPlaces<N> places;
    for (int a = 0; a < 3; ++a) {
      places.cell[a] = select(lanes, ways.cell[a], I(0));
      places.entry[a] = convert<double>(ways.entry[a]);
      places.exit[a] = convert<double>(ways.exit[a]);
    }
    gradients_(lanes, places, gradient, magnitude);
  }

 private:
  template <class Value>
  [[gnu::noinline]] void load(const std::ptrdiff_t (&at)[N],
                              CellCorners<F>& corners) const noexcept {
    static constexpr std::int32_t none_on[N] = {};
    const Value* of_lane[N];
    for (int l = 0; l < N; ++l) of_lane[l] = static_cast<const Value*>(grid_.data) + at[l];
    corners = load_corners<Value, N>(of_lane, none_on, grid_.row, grid_.slice);
  }

  const PacketGrid grid_;
  GradientLoads<N> gradients_;
};

}  // namespace pellucid
#endif
