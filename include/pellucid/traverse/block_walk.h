// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/block_ranges.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// The stretch of a ray inside of one block.
struct BlockStep {
  int block;              ///< index into BlockRanges
  double t_begin, t_end;  ///< t_begin < t_end
};

/// Calls visit(BlockStep) for each block that the ray (in grid coordinates) crosses in `range`,
/// whose begin is finite, front to back, until it returns false.
///
/// This is a StructuredWalk whose cells are the blocks; all that is said of it holds here. A
/// block's boundary is a plane of the grid and is met at the very t that a walk over the cells
/// computes. So the intervals tile the ray without a gap, and a StructuredWalk over the cells in
/// the range {t_begin, t_end} of a step visits exactly the cells of that block: one after the
/// other, such walks give the steps of the walk over the whole ray, each number to the bit.
template <class Visit>
PELLUCID_HD void for_each_block(const BlockRanges& blocks, const Ray<double>& ray_grid,
                                Interval<double> range, Visit&& visit) noexcept {
  StructuredWalk<double> walk(blocks.axis, ray_grid, range);
  StructuredWalk<double>::Step step;
  while (walk.next(step)) {
    const int block = blocks.index(step.cell[0], step.cell[1], step.cell[2]);
    if (!visit(BlockStep{block, step.t_begin, step.t_end})) return;
  }
}

}  // namespace pellucid
