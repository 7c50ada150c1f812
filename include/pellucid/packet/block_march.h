// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/packet_grid.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes, from block to block of a grid; what is to be skipped is crossed in one step
/// however large. In double: a place is known as well as from the eye.
template <class Value, int N>
class BlockMarch {
 public:
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  D origin[3], direction[3];  ///< plane coordinates, at the entry into the grid; by world length
  D end;                      ///< world length inside of the grid
  I block[3];                 ///< the block that each lane stands in
  D begin, next;              ///< of the block's stretch
  I kind;                     ///< BlockKind
  D in_cells_until;           ///< smooth and wavy blocks that begin before are taken as cells

  /// Rays of lanes beyond `count` are not alive.
  BlockMarch(const PacketGrid<Value>& grid, const PellucidRay* rays, int count) noexcept
      : in_cells_until(0), grid_(grid) {
    double o[3][N], d[3][N], e[N];
    for (int l = 0; l < N; ++l) {
      const PellucidRay& ray = rays[l < count ? l : 0];
      for (int a = 0; a < 3; ++a) {
        d[a][l] = ray.direction[a];
        o[a][l] = ray.origin[a] + ray.begin * ray.direction[a] + grid.padding[a];
      }
      e[l] = l < count ? ray.end - ray.begin : 0;
    }
    end = D::load(e);
    begin = next = D(0);
    for (int a = 0; a < 3; ++a) {
      origin[a] = D::load(o[a]);
      direction[a] = D::load(d[a]);
      forward_[a] = direction[a] > D(0);
      still_[a] = direction[a] == D(0);
      inverse_[a] = D(1) / direction[a];
      next_block_[a] = clamp_block(a, origin[a]);
      block[a] = next_block_[a];
    }
    alive = end > D(0);
  }

  M alive;  ///< whether a lane's ray is not yet through

  /// Takes the lanes to their next block that is not to be skipped; or they are no longer alive.
  /// Adds 1 to `skipped` for each step over what is.
  void to_next(M lanes, I& skipped) noexcept {
    lanes = lanes & alive;
    while (any(lanes)) {
      begin = select(lanes, next, begin);
      M inside = begin < end;
      for (int a = 0; a < 3; ++a) {
        block[a] = select(lanes, next_block_[a], block[a]);
        inside = inside & (block[a] >= I(0)) & (block[a] < I(grid_.blocks[a]));
      }
      alive = alive & (inside | !lanes);
      lanes = lanes & inside;
      if (!any(lanes)) return;
      const I index = select(lanes, index_of_block(), I(0));
      const I found = gather(grid_.classes, index);
      I its_kind = (found >> 16) & I(255), level = (found >> 24) & I(255);
      const M refused =
          (its_kind >= I(static_cast<int>(BlockKind::smooth))) & (begin < in_cells_until);
      its_kind = select(refused, I(static_cast<int>(BlockKind::cells)), its_kind);
      level = select(refused, I(0), level);
      kind = select(lanes, its_kind, kind);
      static constexpr std::int32_t sides[8] = {1, 2, 4, 8, 16, 32, 64, 128};
      cross(lanes, gather(sides, level));
      const M skip = lanes & ((its_kind == I(static_cast<int>(BlockKind::skip))) | !(next > begin));
      skipped += select(skip, I(1), I(0));
      lanes = skip;
    }
  }

  /// Has the lanes go on from here, on the way to `until`, by cells.
  void go_back(M lanes, D here, D until) noexcept {
    next = select(lanes, here, next);
    in_cells_until = select(lanes, until, in_cells_until);
    for (int a = 0; a < 3; ++a) {
      next_block_[a] =
          select(lanes, clamp_block(a, origin[a] + here * direction[a]), next_block_[a]);
    }
  }

 private:
  I index_of_block() const noexcept {
    return block[0] + I(grid_.blocks[0]) * (block[1] + I(grid_.blocks[1]) * block[2]);
  }

  I clamp_block(int a, D place) const noexcept {
    const D block_place = floor(place * D(1.0 / block_width));
    return convert<std::int32_t>(clamp(block_place, D(0), D(grid_.blocks[a] - 1)));
  }

  /// Where the lanes leave the cubes of so many blocks that they are in, and for which block.
  void cross(M lanes, I side) noexcept {
    I lower[3];
    D exit[3];
    const D infinity(std::numeric_limits<double>::infinity());
    for (int a = 0; a < 3; ++a) {
      lower[a] = block[a] & (I(0) - side);
      const I plane = I(block_width) * select(forward_[a], lower[a] + side, lower[a]);
      exit[a] = select(still_[a], infinity, (convert<double>(plane) - origin[a]) * inverse_[a]);
    }
    const D first = min(exit[0], min(exit[1], exit[2]));
    const D leave = max(min(first, end), begin);
    next = select(lanes, leave, next);
    const bool large = any(side > I(1));
    for (int a = 0; a < 3; ++a) {
      I to = block[a];
      if (large) {
        const I here =
            convert<std::int32_t>(floor((origin[a] + leave * direction[a]) * D(1.0 / block_width)));
        to = min(max(here, lower[a]), lower[a] + side - I(1));
      }
      to = select(exit[a] <= leave, select(forward_[a], lower[a] + side, lower[a] - I(1)), to);
      next_block_[a] = select(lanes, to, next_block_[a]);
    }
  }

  const PacketGrid<Value>& grid_;
  D inverse_[3];
  M forward_[3], still_[3];
  I next_block_[3];
};

}  // namespace pellucid
#endif
