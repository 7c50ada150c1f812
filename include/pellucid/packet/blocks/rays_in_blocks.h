// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/blocks/lane_rays.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes, and the blocks of a grid that they are in at a world length from where they enter
/// it.
template <int N>
class RaysInBlocks {
 public:
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  D end;  ///< world length inside of the grid

  /// Rays of lanes beyond `count` end where they begin.
  RaysInBlocks(const PacketGrid& grid, const PellucidRay* rays, int count) noexcept
      : grid_(&grid), rays_(grid, rays, count) {
    end = rays_.end;
  }

  /// Computes the positions of the rays at these world lengths, in plane coordinates.
  PELLUCID_ALWAYS_INLINE void place(D at, D* to) const noexcept {
    for (int a = 0; a < 3; ++a) to[a] = rays_.origin[a] + at * rays_.direction[a];
  }
  /// Plane coordinates by world length.
  const D* direction() const noexcept { return rays_.direction; }

  /// The block that holds a place in plane coordinates, clamped into the grid; and its number.
  template <class T>
  PELLUCID_ALWAYS_INLINE void find_block(const Batch<T, N>* place, I* block) const noexcept {
    using B = Batch<T, N>;
    for (int a = 0; a < 3; ++a) {
      const B inside = clamp(place[a], B(0), B(static_cast<T>(grid_->cells[a] - 1)));
      block[a] = convert<std::int32_t>(inside) >> 3;
    }
  }
  template <class T>
  PELLUCID_ALWAYS_INLINE I block_of(const Batch<T, N>* place) const noexcept {
    I block[3];
    find_block(place, block);
    return grid_->index_of_block(block);
  }
  /// The same of where each lane stands at the given world length.
  PELLUCID_ALWAYS_INLINE I block_at(D at) const noexcept {
    D to[3];
    place(at, to);
    return block_of(to);
  }

  /// Returns the lanes that are in a block to skip at the given world length, and the lengths at
  /// which they leave the cube of such blocks.
  M find_skipped(M lanes, D at, D& leave) const noexcept {
    D to[3];
    place(at, to);
    I block[3];
    find_block(to, block);
    const I found = gather(grid_->classes, select(lanes, grid_->index_of_block(block), I(0)));
    const M skip = lanes & (((found >> 16) & I(255)) == I(static_cast<int>(BlockKind::skip)));
    if (none(skip)) return skip;
    const I side = side_of_cube<N>(select(skip, (found >> 24) & I(7), I(0)));
    leave = end;
    for (int a = 0; a < 3; ++a) {
      const I lower = block[a] & (I(0) - side);
      const D plane =
          convert<double>(I(block_width) * select(rays_.forward[a], lower + side, lower));
      leave =
          select(rays_.still[a], leave, min(leave, (plane - rays_.origin[a]) * rays_.inverse[a]));
    }
    return skip;
  }

 private:
  static_assert(block_width == 8);
  const PacketGrid* grid_;
  LaneRays<N> rays_;
};

}  // namespace pellucid
#endif
