// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/blocks/block_intervals.h"
#include "pellucid/packet/blocks/lane_rays.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes, from block to block of a grid; what is to be skipped is crossed in one step
/// however large. In double: a place is known as well as from the eye.
template <int N>
class BlockMarch {
 public:
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  double origin[3][N], direction[3][N];  ///< plane coordinates, at the entry into the grid; by
                                         ///< world length
  double end[N];                         ///< world length inside of the grid

  /// Rays of lanes beyond `count` are not alive.
  BlockMarch(const PacketGrid& grid, const PellucidRay* rays, int count) noexcept
      : grid_(grid), rays_(grid, rays, count) {
    for (int a = 0; a < 3; ++a) {
      rays_.origin[a].store(origin[a]);
      rays_.direction[a].store(direction[a]);
    }
    rays_.end.store(end);
    in_cells_until = smooth_begin = smooth_end = D(0);
    smooth = M(false);
    next_ = D(0);
    refused_ = I(-1);
    for (int a = 0; a < 3; ++a) next_block_[a] = clamp_block(a, rays_.origin[a]);
    alive = rays_.end > D(0);
  }

  /// The rays as they were given.
  const LaneRays<N>& rays() const noexcept { return rays_; }

  M alive;                     ///< whether a lane's ray is not yet through
  D in_cells_until;            ///< smooth blocks that begin before are taken as cells
  M smooth;                    ///< whether a smooth stretch is behind those found
  D smooth_begin, smooth_end;  ///< of it

  /// Finds the next stretches of the rays, until they are through, or come to a smooth one, or each
  /// has `most`, which is not more than may be. Adds 1 to `skipped` for each step over what is to
  /// be skipped.
  [[gnu::flatten]] void find(BlockIntervals<N>& stretches, I& skipped,
                             int most = BlockIntervals<N>::of_a_ray) noexcept {
    stretches.count = 0;
    smooth = M(false);
    I found(0);
    std::int32_t lane[N];
    for (int l = 0; l < N; ++l) lane[l] = l;
    const I rays = I::load(lane);
    M lanes = alive;
    while (any(lanes)) {
      M inside = next_ < rays_.end;
      for (int a = 0; a < 3; ++a) {
        inside = inside & (next_block_[a] >= I(0)) & (next_block_[a] < I(grid_.blocks[a]));
      }
      alive = alive & (inside | !lanes);
      lanes = lanes & inside;
      if (none(lanes)) return;
      I block[3];
      for (int a = 0; a < 3; ++a) block[a] = next_block_[a];
      const D begin = next_;
      const I index = select(lanes, grid_.index_of_block(block), I(0));
      const I its_class = gather(grid_.classes, index);
      I kind = (its_class >> 16) & I(255), level = (its_class >> 24) & I(255);
      M sampled = lanes & (kind >= I(static_cast<int>(BlockKind::smooth)));
      if (any(sampled)) {
        const M refused = sampled & (begin < in_cells_until);
        level = select(refused, I(0), level);
        sampled = sampled & !refused;
      }
      cross(lanes, block, level);
      const M skip = lanes & ((kind == I(static_cast<int>(BlockKind::skip))) | !(next_ > begin));
      skipped += select(skip, I(1), I(0));
      sampled = sampled & !skip;
      if (any(sampled)) {
        smooth = smooth | sampled;
        smooth_begin = select(sampled, begin, smooth_begin);
        smooth_end = select(sampled, next_, smooth_end);
        lanes = lanes & !sampled;
      }
      const M stretch = lanes & !skip;
      if (none(stretch)) continue;
      const M constant = (kind == I(static_cast<int>(BlockKind::constant))) & (index != refused_);
      const int at = stretches.count;
      store_packed(stretch, rays, stretches.ray + at);
      for (int a = 0; a < 3; ++a) store_packed(stretch, block[a], stretches.block[a] + at);
      store_packed(stretch, select(constant, I(1), I(0)), stretches.constant + at);
      store_packed(stretch, begin, stretches.begin + at);
      store_packed(stretch, next_, stretches.end + at);
      stretches.count += count(stretch);
      found += select(stretch, I(1), I(0));
      lanes = lanes & (found < I(most));
    }
  }

  /// Takes a lane back to a stretch that was taken for one of a single material, to be gone through
  /// cell by cell.
  void go_back(int lane, const BlockIntervals<N>& stretches, int stretch) noexcept {
    const M only = M::from_bits(1u << lane);
    I block[3];
    for (int a = 0; a < 3; ++a) block[a] = I(stretches.block[a][stretch]);
    for (int a = 0; a < 3; ++a) next_block_[a] = select(only, block[a], next_block_[a]);
    next_ = select(only, D(stretches.begin[stretch]), next_);
    refused_ = select(only, grid_.index_of_block(block), refused_);
    alive = alive | only;
    smooth = smooth & !only;
  }

  /// Has the lanes go on from here, on the way to `until`, by cells.
  void go_in_cells(M lanes, D here, D until) noexcept {
    next_ = select(lanes, here, next_);
    in_cells_until = select(lanes, until, in_cells_until);
    for (int a = 0; a < 3; ++a) {
      next_block_[a] = select(lanes, clamp_block(a, rays_.origin[a] + here * rays_.direction[a]),
                              next_block_[a]);
    }
  }

 private:
  I clamp_block(int a, D place) const noexcept {
    const D block_place = floor(place * D(1.0 / block_width));
    return convert<std::int32_t>(clamp(block_place, D(0), D(grid_.blocks[a] - 1)));
  }

  /// Finds the lengths at which the lanes leave their cubes of 2^level blocks, and the blocks that
  /// follow.
  void cross(M lanes, const I* block, I level) noexcept {
    const bool large = any(lanes & (level > I(0)));
    const I side = large ? side_of_cube<N>(level) : I(1);
    I lower[3];
    D exit[3];
    const D infinity(std::numeric_limits<double>::infinity());
    for (int a = 0; a < 3; ++a) {
      lower[a] = block[a] & (I(0) - side);
      const I plane = I(block_width) * select(rays_.forward[a], lower[a] + side, lower[a]);
      exit[a] = select(rays_.still[a], infinity,
                       (convert<double>(plane) - rays_.origin[a]) * rays_.inverse[a]);
    }
    const D first = min(exit[0], min(exit[1], exit[2]));
    const D leave = max(min(first, rays_.end), next_);
    for (int a = 0; a < 3; ++a) {
      I to = block[a];
      if (large) {
        const I here = convert<std::int32_t>(
            floor((rays_.origin[a] + leave * rays_.direction[a]) * D(1.0 / block_width)));
        // Cubes reach beyond the grid, and rays in its upper faces are there, too.
        const I beyond = min(lower[a] + side, I(grid_.blocks[a]));
        to = min(max(here, lower[a]), beyond - I(1));
      }
      to = select(exit[a] <= leave, select(rays_.forward[a], lower[a] + side, lower[a] - I(1)), to);
      next_block_[a] = select(lanes, to, next_block_[a]);
    }
    next_ = select(lanes, leave, next_);
  }

  const PacketGrid& grid_;
  LaneRays<N> rays_;
  D next_;           ///< where the block begins that each lane comes to next
  I next_block_[3];  ///< and which it is
  I refused_;        ///< the block that each lane was taken back to, or -1
};

}  // namespace pellucid
#endif
