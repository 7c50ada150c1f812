// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/cell_march.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Positions of rays in cells, one in each lane.
template <int N>
struct CellPositions {
  Batch<std::int32_t, N> cell[3];      ///< in plane coordinates
  Vec3<Batch<double, N>> entry, exit;  ///< places in the cell, [0,1]³
  Batch<double, N> begin;              ///< world length from the ray's entry into the grid
  Batch<double, N> length;             ///< world length between them
};

/// Returns the positions at which CellMarch has the lanes' own rays cross a cell of a stretch.
/// `in_block`: the cell, in its block.
template <int N>
CellPositions<N> cell_places(const PacketGrid& grid, const BlockMarch<N>& rays,
                             const BlockIntervals<N>& stretches, Batch<std::int32_t, N> stretch,
                             const Batch<std::int32_t, N>* in_block) noexcept {
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  CellPositions<N> places;
  const D from = gather(stretches.begin, stretch);
  D begin(0), end = gather(stretches.end, stretch) - from;
  Vec3<D> place, direction;
  for (int a = 0; a < 3; ++a) {
    const I lower = gather(stretches.block[a], stretch) * I(block_width);
    places.cell[a] = lower + in_block[a];
    direction[a] = rays.rays().direction[a];
    place[a] = (rays.rays().origin[a] + from * direction[a]) - convert<double>(lower);
    const D inverse = rays.rays().inverse[a];
    const F last_cell = convert<float>(min(I(grid.cells[a]) - lower, I(block_width)) - I(1));
    const F here = convert<float>(in_block[a]);
    const BatchMask<N> forward = inverse > D(0);
    const F end_cell = end_of_cells(here, last_cell, inverse, forward);
    begin = max(cell_entry(here, place[a], inverse, forward), begin);
    end = min(cell_exit(here, end_cell, place[a], inverse, forward), end);
  }
  end = max(begin, end);
  for (int a = 0; a < 3; ++a) {
    const D from_corner = place[a] - convert<double>(in_block[a]);
    places.entry[a] = clamp(multiply_add(begin, direction[a], from_corner), D(0), D(1));
    places.exit[a] = clamp(multiply_add(end, direction[a], from_corner), D(0), D(1));
  }
  places.begin = from + begin;
  places.length = end - begin;
  return places;
}

}  // namespace pellucid
#endif
