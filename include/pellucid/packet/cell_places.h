// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cell_march.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Where rays are in cells, one in each lane.
template <int N>
struct CellPlaces {
  Batch<std::int32_t, N> cell[3];  ///< in plane coordinates
  Batch<double, N> begin, end;     ///< world lengths from the entries into the grid
};

/// Where CellMarch has the lanes' own rays go through a cell of a stretch: in float, from where the
/// stretch begins. What other means make of a cell has to lie between the same two places, or what
/// is beside one is seen twice, or not at all: by as much as 16 u of a cell over the direction's
/// component, which is a hundredth of a cell for rays that hardly rise over a plane. The end is
/// that of CellMarch::step() to the bit, and the begin, which may be that of a skip, as far in
/// front of it as the span is long. `in_block`: the cell, in its block; `last`: where it is the
/// stretch's last one.
template <class Value, int N>
CellPlaces<N> cell_places(const PacketGrid<Value>& grid, const BlockMarch<Value, N>& rays,
                          const Stretches<Value, N>& stretches, Batch<std::int32_t, N> stretch,
                          const Batch<std::int32_t, N>* in_block, Batch<float, N> span_length,
                          BatchMask<N> last) noexcept {
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  CellPlaces<N> places;
  const D from = gather(stretches.begin, stretch), to = gather(stretches.end, stretch);
  F end = convert<float>(to - from);
  for (int a = 0; a < 3; ++a) {
    const I lower = gather(stretches.block[a], stretch) * I(block_width);
    places.cell[a] = lower + in_block[a];
    const D direction = D::load(rays.direction[a]);
    const F place =
        convert<float>(D::load(rays.origin[a]) + from * direction - convert<double>(lower));
    const F inverse = F(1) / convert<float>(direction);
    const F last_cell = convert<float>(min(I(grid.cells[a]) - lower, I(block_width)) - I(1));
    const F here = convert<float>(in_block[a]);
    const BatchMask<N> forward = inverse > F(0);
    const F end_cell = end_of_cells(here, last_cell, inverse, forward);
    end = min(end, cell_exit(here, end_cell, place, inverse, forward));
  }
  const D in_float = from + convert<double>(end);
  places.begin = max(in_float - convert<double>(span_length), from);
  places.end = max(select(last, to, in_float), places.begin);
  return places;
}

}  // namespace pellucid
#endif
