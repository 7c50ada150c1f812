// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <type_traits>

#include "pellucid/packet/cells/exact_corners.h"
#include "pellucid/packet/cells/gradient_loads.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Loads cells of a grid with one or several variables, one in each lane. Its values are of types
/// that binary32 holds.
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

  /// `jobs`: of each variable; must outlive the object. `lit`: that whose gradient is needed.
  CellLoads(const PellucidPacketJob* jobs, int lit, const PacketLight& light) noexcept
      : jobs_(jobs), grid_(jobs[lit]), gradients_(grid_, light) {}
  // The gradients refer to the grid.
  CellLoads(const CellLoads&) = delete;
  CellLoads& operator=(const CellLoads&) = delete;

  /// The data of a variable along the lanes' ways.
  CellCubic<F> data(M lanes, const Ways& ways, int variable = 0) const noexcept {
    const auto [cell] = within(lanes, ways);
    const PacketGrid grid(jobs_[variable]);
    const ExactCorners<N> corners_of(grid, cell);
    CellCorners<F> corners;
    with_value_type(grid.type, [&](auto value) noexcept {
      using Value = decltype(value);
      if constexpr (std::is_same_v<Value, float> || sizeof(Value) <= 2) {
        corners = load<Value>(grid, corners_of);
      }
    });
    F least = corners.value[0], most = least;
    for (int n = 1; n < 8; ++n) {
      least = min(least, corners.value[n]);
      most = max(most, corners.value[n]);
    }
    return {corners, least, most, ways.entry, ways.exit};
  }

  /// Their gradient in the world, and its magnitude if there is a factor of it.
  void gradients(M lanes, const Ways& ways, CubicBernstein<F> (&gradient)[3],
                 CubicBernstein<F>& magnitude) const noexcept {
    CellPositions<N> places;
    const auto [cell] = within(lanes, ways);
    for (int a = 0; a < 3; ++a) {
      places.cell[a] = cell[a];
      places.entry[a] = convert<double>(ways.entry[a]);
      places.exit[a] = convert<double>(ways.exit[a]);
    }
    gradients_(lanes, places, gradient, magnitude);
  }

 private:
  struct Cells {
    I cell[3];
  };
  /// The cells of these lanes, and of the others one that is there.
  static Cells within(M lanes, const Ways& ways) noexcept {
    Cells result;
    for (int a = 0; a < 3; ++a) result.cell[a] = select(lanes, ways.cell[a], I(0));
    return result;
  }
  template <class Value>
  [[gnu::noinline]] static CellCorners<F> load(const PacketGrid& grid,
                                               const ExactCorners<N>& of) noexcept {
    return of.in_single(static_cast<const Value*>(grid.data));
  }

  const PellucidPacketJob* jobs_;
  const PacketGrid grid_;
  GradientLoads<N> gradients_;
};

}  // namespace pellucid
#endif
