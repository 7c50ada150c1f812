// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/block_classes.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// The stretch of a ray inside of one block, or of a cube of blocks that are all to be skipped.
struct BlockStep {
  int block;              ///< index into BlockRecords; of a cube, the first that the ray enters
  double t_begin, t_end;  ///< t_begin < t_end
};

/// The blocks that a ray crosses, front to back: a StructuredWalk whose cells are the blocks, and
/// all that is said of it holds here; without the places in the blocks, and over cubes of blocks at
/// once.
///
/// A block's boundary is a plane of the grid and is met at the very t that a walk over the cells
/// computes. So the intervals tile the ray without a gap, and a StructuredWalk over the cells in
/// the range {t_begin, t_end} of a step visits exactly the cells of that block: one after the
/// other, such walks give the steps of the walk over the whole ray, each number to the bit.
class BlockWalk {
 public:
  /// Begins a walk. The blocks are referred to and must outlive it. The ray is in grid coordinates,
  /// range.begin finite.
  PELLUCID_HD BlockWalk(const BlockRecords& blocks, const Ray<double>& ray_grid,
                        Interval<double> range) noexcept
      : blocks_(blocks) {
    const Interval<double> t = grid_interval(blocks.axis, ray_grid, range);
    t_ = t.begin;
    end_ = t.end;
    if (!(t_ < end_)) return;
    for (int a = 0; a < 3; ++a) {
      origin_[a] = ray_grid.origin[a];
      direction_[a] = ray_grid.direction[a];
      const int count = blocks.axis[a].cells();
      const double lower = blocks.axis[a].plane(0), upper = blocks.axis[a].plane(count);
      lower_[a] = lower;
      per_length_[a] = count / (upper - lower);
      set(a, last_behind(a, 0, count));
    }
  }

  /// Finds the next block; false behind the last one. With classes, blocks to skip come as the part
  /// of their cube that the ray crosses.
  PELLUCID_HD bool next(const BlockClass* classes, BlockStep& step) noexcept {
    if (!(t_ < end_)) return false;
    // A plane at t_ was reached together with the last one. The last plane of an axis is not met
    // here, for end_ is not beyond it: the block stays in the grid.
    int a = nearest();
    for (; next_[a] <= t_; a = nearest()) set(a, along_[a] + 1);

    step.block = blocks_.index(block(0), block(1), block(2));
    step.t_begin = t_;
    const int level = classes != nullptr && classes[step.block].kind == BlockKind::skip
                          ? classes[step.block].level
                          : 0;
    t_ = step.t_end = level == 0 ? min(next_[a], end_) : cube_end(level);
    if (!(t_ < end_)) return true;
    if (level == 0) {
      set(a, along_[a] + 1);
      return true;
    }
    for (int b = 0; b < 3; ++b) {
      const int last = min(along_[b] + (1 << level) + 1, blocks_.axis[b].cells());
      if (next_[b] <= t_) set(b, last_behind(b, along_[b] + 1, last));
    }
    return true;
  }

 private:
  /// Planes and blocks are counted along the ray: block n of an axis lies between planes n and n+1.
  PELLUCID_HD bool reversed(int a) const noexcept { return direction_[a] < 0; }
  PELLUCID_HD int block(int a) const noexcept {
    return reversed(a) ? blocks_.axis[a].cells() - 1 - along_[a] : along_[a];
  }
  PELLUCID_HD double plane_t(int a, int n) const noexcept {
    const GridAxis<double>& axis = blocks_.axis[a];
    return (axis.plane(reversed(a) ? axis.cells() - n : n) - origin_[a]) / direction_[a];
  }
  PELLUCID_HD void set(int a, int n) noexcept {
    along_[a] = n;
    next_[a] = direction_[a] == 0 ? std::numeric_limits<double>::infinity() : plane_t(a, n + 1);
  }
  PELLUCID_HD int nearest() const noexcept {
    const int a = next_[1] < next_[0] ? 1 : 0;
    return next_[2] < next_[a] ? 2 : a;
  }

  /// Returns the last n >= first, < last, whose plane is not beyond t_ (where the ray does not
  /// move: above the origin); first where there is none.
  PELLUCID_HD int last_behind(int a, int first, int last) const noexcept {
    const auto behind = [&](int n) noexcept {
      return direction_[a] == 0 ? blocks_.axis[a].plane(n) <= origin_[a] : plane_t(a, n) <= t_;
    };
    int lo = first, hi = last;
    // Blocks are mostly of one width; then these two look-ups are all.
    const int count = blocks_.axis[a].cells();
    const double place = (origin_[a] + t_ * direction_[a] - lower_[a]) * per_length_[a];
    const int guess = static_cast<int>(clamp(place, 0.0, static_cast<double>(count - 1)));
    const int n = reversed(a) ? count - 1 - guess : guess;
    if (n > lo && n < hi) (behind(n) ? lo : hi) = n;
    if (n + 1 > lo && n + 1 < hi) (behind(n + 1) ? lo : hi) = n + 1;
    while (hi - lo > 1) {
      const int mid = lo + (hi - lo) / 2;
      (behind(mid) ? lo : hi) = mid;
    }
    return lo;
  }

  /// Returns the parameter at which the ray leaves the aligned cube of (2^level)³ blocks in which
  /// it stands, or ends.
  PELLUCID_HD double cube_end(int level) const noexcept {
    double t = end_;
    for (int a = 0; a < 3; ++a) {
      if (direction_[a] == 0) continue;
      const int side = 1 << level, count = blocks_.axis[a].cells();
      const int first = block(a) & ~(side - 1);
      const int plane = reversed(a) ? count - first : min(first + side, count);
      t = min(plane_t(a, plane), t);
    }
    return t;
  }

  const BlockRecords& blocks_;
  double origin_[3]{}, direction_[3]{};
  double lower_[3]{}, per_length_[3]{};  ///< of the axis: its first plane, blocks per length
  double t_, end_;
  int along_[3]{};    ///< the block that the ray stands in
  double next_[3]{};  ///< where the ray leaves it along each axis
};

/// Calls visit(BlockStep) for each block that the ray (in grid coordinates) crosses in `range`,
/// whose begin is finite, front to back, until it returns false.
template <class Visit>
PELLUCID_HD void for_each_block(const BlockRecords& blocks, const Ray<double>& ray_grid,
                                Interval<double> range, Visit&& visit) noexcept {
  BlockWalk walk(blocks, ray_grid, range);
  BlockStep step;
  while (walk.next(nullptr, step)) {
    if (!visit(step)) return;
  }
}
/// Visits the blocks likewise, but those to skip by the cube.
template <class Visit>
PELLUCID_HD void for_each_block(const ClassifiedBlocks& blocks, const Ray<double>& ray_grid,
                                Interval<double> range, Visit&& visit) noexcept {
  BlockWalk walk(blocks.records, ray_grid, range);
  BlockStep step;
  while (walk.next(blocks.classes.block, step)) {
    if (!visit(step)) return;
  }
}

}  // namespace pellucid
