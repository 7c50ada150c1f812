// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/packet_grid.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes that take steps of one length: which step each stands at, and which of them lie
/// where nothing absorbs.
template <class Value, int N>
class SamplerSteps {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  M alive;  ///< whether a lane's ray is not yet through
  I index;  ///< of the step that each lane stands at
  D end;    ///< world length inside of the grid
  static constexpr int most_at_once = 8;
  int steps_at_once;

  /// Rays of lanes beyond `count` are not alive.
  SamplerSteps(const PacketGrid<Value>& grid, const PellucidRay* rays, int count,
               double step) noexcept
      : grid_(grid), step_(step) {
    double o[3][N], d[3][N], e[N], largest = 0;
    for (int l = 0; l < N; ++l) {
      const PellucidRay& ray = rays[l < count ? l : 0];
      for (int a = 0; a < 3; ++a) {
        d[a][l] = ray.direction[a];
        o[a][l] = ray.origin[a] + ray.begin * ray.direction[a] + grid.padding[a];
        largest = max(largest, max(d[a][l], -d[a][l]) * step);
      }
      e[l] = l < count ? ray.end - ray.begin : 0;
    }
    steps_at_once = largest <= 4 ? most_at_once : 1;
    end = D::load(e);
    index = I(0);
    for (int a = 0; a < 3; ++a) {
      origin_[a] = D::load(o[a]);
      direction_[a] = D::load(d[a]);
      inverse_[a] = D(1) / direction_[a];
      forward_[a] = direction_[a] > D(0);
      still_[a] = direction_[a] == D(0);
    }
    alive = end > D(0);
  }

  D begin_of(I i) const noexcept { return convert<double>(i) * step_; }

  /// Takes lanes whose sample stands in a block to skip to the first step whose middle does not; or
  /// they are no longer alive.
  void skip_to_middle() noexcept {
    M lanes = alive;
    while (any(lanes)) {
      const D begin = begin_of(index);
      lanes = keep_inside(lanes, begin);
      D leave;
      const M skip = find_skipped(lanes, middle_of(begin), leave);
      if (none(skip)) return;
      const D middle_beyond = D(0) - floor(D(0.5) - leave / step_);
      advance(skip, middle_beyond, I(1));
      lanes = skip;
    }
  }

  /// Likewise for steps that lie in blocks to skip from end to end: data are continuous, so that
  /// one after the other such blocks cover a single range in which nothing absorbs, and so does
  /// whatever lies between the values at the step's ends.
  void skip_steps() noexcept {
    M lanes = alive;
    D look = begin_of(index);
    M skipped(false);
    while (any(lanes)) {
      lanes = keep_inside(lanes, look);
      D leave;
      const M skip = find_skipped(lanes, look, leave);
      if (none(skip)) break;
      skipped = skipped | skip;
      // A little further, so that the next block is found there; it touches the last one.
      look = select(skip, max(leave, look) + D(1e-6) * step_, look);
      lanes = skip;
    }
    advance(skipped, floor(look / step_), I(0));
  }

  /// Where the rays are at these world lengths, in plane coordinates.
  PELLUCID_ALWAYS_INLINE void place(D at, D* to) const noexcept {
    for (int a = 0; a < 3; ++a) to[a] = origin_[a] + at * direction_[a];
  }
  /// Plane coordinates by world length.
  const D* direction() const noexcept { return direction_; }

  /// The number of the block in which each lane stands at the given world length.
  PELLUCID_ALWAYS_INLINE I block_at(D at) const noexcept {
    I block[3];
    find_block(at, block);
    return grid_.index_of_block(block);
  }

  /// The middle of a step that begins there; the last one ends with the ray.
  D middle_of(D begin) const noexcept { return D(0.5) * (begin + min(begin + step_, end)); }

 private:
  M keep_inside(M lanes, D at) noexcept {
    const M inside = at < end;
    alive = alive & (inside | !lanes);
    return lanes & inside;
  }

  PELLUCID_ALWAYS_INLINE void find_block(D at, I* block) const noexcept {
    for (int a = 0; a < 3; ++a) {
      const D place = clamp(origin_[a] + at * direction_[a], D(0), D(grid_.cells[a] - 1));
      block[a] = convert<std::int32_t>(place) >> 3;
    }
  }

  /// Those of the lanes that are in a block to skip at the given world length, and where they leave
  /// the cube of such blocks.
  M find_skipped(M lanes, D at, D& leave) const noexcept {
    I block[3];
    find_block(at, block);
    const I found = gather(grid_.classes, select(lanes, grid_.index_of_block(block), I(0)));
    const M skip = lanes & (((found >> 16) & I(255)) == I(static_cast<int>(BlockKind::skip)));
    if (none(skip)) return skip;
    static constexpr std::int32_t sides[8] = {1, 2, 4, 8, 16, 32, 64, 128};
    const I side = gather(sides, select(skip, (found >> 24) & I(7), I(0)));
    leave = end;
    for (int a = 0; a < 3; ++a) {
      const I lower = block[a] & (I(0) - side);
      const D plane = convert<double>(I(block_width) * select(forward_[a], lower + side, lower));
      leave = select(still_[a], leave, min(leave, (plane - origin_[a]) * inverse_[a]));
    }
    return skip;
  }

  /// To that step where it is not before the present one plus `least`.
  void advance(M lanes, D to, I least) noexcept {
    const I bounded = convert<std::int32_t>(min(to, D(1 << 30)));
    index = select(lanes, max(bounded, index + least), index);
  }

  static_assert(block_width == 8);
  const PacketGrid<Value>& grid_;
  D step_;
  D origin_[3], direction_[3], inverse_[3];  ///< plane coordinates, by world length
  M forward_[3], still_[3];
};

}  // namespace pellucid
#endif
