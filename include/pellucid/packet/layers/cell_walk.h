// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/cell_march.h"
#include "pellucid/packet/layered_interface.h"
#include "pellucid/packet/layers/cell_loads.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Walks N rays through the cells of a grid, each ray in a lane of its own. Places are in
/// double, so that planes are where all other walks see them; they are those of the ray's own
/// parameter, the world arc length.
template <int N>
class CellWalk {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// Takes the lanes' rays. `cells`: of the grid, along each axis.
  void take(const PellucidGridRays& rays, const std::int32_t (&cells)[3]) noexcept {
    for (int a = 0; a < 3; ++a) {
      origin_[a] = D::load(rays.origin[a]);
      direction_[a] = D::load(rays.direction[a]);
      inverse_[a] = D(1) / direction_[a];
      forward_[a] = inverse_[a] > D(0);
      plane_[a] = rays.plane[a];
      last_[a] = static_cast<float>(cells[a] - 1);
    }
  }

  /// Begins anew at t, in these lanes.
  void begin(M lanes, D t) noexcept {
    for (int a = 0; a < 3; ++a) {
      const F last(last_[a]);
      const F cell = cell_at(a, place(a, t), last);
      cell_[a] = select(lanes, cell, cell_[a]);
      end_cell_[a] =
          select(lanes, end_of_cells(cell, last, inverse_[a], forward_[a]), end_cell_[a]);
    }
  }

  /// Returns where the rays leave their cells; infinite in the last one on the way.
  D exit() noexcept {
    for (int a = 0; a < 3; ++a) {
      const D plane = plane_at(a, cell_[a] + select(forward_[a], F(1), F(0)));
      exit_[a] = plane_exit(plane, cell_[a] == end_cell_[a], origin_[a], inverse_[a]);
    }
    return min(min(exit_[0], exit_[1]), exit_[2]);
  }

  /// Finds the ways of the lanes from `begin` to `end` through their cells, and goes on to the next
  /// ones where `end` is their exit().
  void pass(M lanes, D begin, D end, typename CellLoads<N>::Ways& ways) noexcept {
    for (int a = 0; a < 3; ++a) {
      const D lower = plane_at(a, cell_[a]);
      const D per_length =
          plane_[a] == nullptr ? D(1) : D(1) / (plane_at(a, cell_[a] + F(1)) - lower);
      const auto local = [&](D t) noexcept {
        return clamp(convert<float>((place(a, t) - lower) * per_length), F(0), F(1));
      };
      ways.cell[a] = convert<std::int32_t>(cell_[a]);
      ways.entry[a] = local(begin);
      ways.exit[a] = local(end);
      const F next = cell_[a] + select(forward_[a], F(1), F(-1));
      cell_[a] = select(lanes & (exit_[a] <= end), next, cell_[a]);
    }
  }

 private:
  D place(int a, D t) const noexcept { return multiply_add(t, direction_[a], origin_[a]); }
  D plane_at(int a, F number) const noexcept {
    return plane_[a] == nullptr ? convert<double>(number)
                                : gather(plane_[a], convert<std::int32_t>(number));
  }
  /// The cell that holds a place, from 0 to `last`.
  F cell_at(int a, D place, F last) const noexcept {
    if (plane_[a] == nullptr) return clamp(convert<float>(floor(place)), F(0), last);
    F lower(0), upper = last + F(1);
    for (int cells = static_cast<int>(last_[a]) + 1; cells > 1; cells = (cells + 1) / 2) {
      const F middle = floor(F(0.5f) * (lower + upper));
      const M behind = gather(plane_[a], convert<std::int32_t>(middle)) <= place;
      lower = select(behind, middle, lower);
      upper = select(behind, upper, middle);
    }
    return min(lower, last);
  }

  D origin_[3], direction_[3], inverse_[3];
  M forward_[3];
  const double* plane_[3];       ///< null: at whole numbers
  float last_[3];                ///< the last cell of the grid
  F cell_[3]{}, end_cell_[3]{};  ///< the last one on the way
  D exit_[3];
};

}  // namespace pellucid
#endif
