// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/blocks/rays_in_blocks.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes that take steps of one length: which step each stands at, and which of them lie
/// where nothing absorbs.
template <int N>
class SamplerSteps : public RaysInBlocks<N> {
  using Rays = RaysInBlocks<N>;

 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  M alive;  ///< whether a lane's ray is not yet through
  I index;  ///< of the step that each lane stands at
  using Rays::end;
  static constexpr int max_at_once = 8;
  int steps_at_once;

  /// Rays of lanes beyond `count` are not alive.
  SamplerSteps(const PacketGrid& grid, const PellucidRay* rays, int count, double step) noexcept
      : Rays(grid, rays, count), step_(step) {
    double largest = 0;
    for (int l = 0; l < count; ++l) {
      for (const double d : rays[l].direction) largest = max(largest, max(d, -d) * step);
    }
    steps_at_once = largest <= 4 ? max_at_once : 1;
    index = I(0);
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
      const M skip = Rays::find_skipped(lanes, middle_of(begin), leave);
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
      const M skip = Rays::find_skipped(lanes, look, leave);
      if (none(skip)) break;
      skipped = skipped | skip;
      // A little further, so that the next block is found there; it touches the last one.
      look = select(skip, max(leave, look) + D(1e-6) * step_, look);
      lanes = skip;
    }
    advance(skipped, floor(look / step_), I(0));
  }

  /// The middle of a step that begins there; the last one ends with the ray.
  D middle_of(D begin) const noexcept { return D(0.5) * (begin + min(begin + step_, end)); }

 private:
  M keep_inside(M lanes, D at) noexcept {
    const M inside = at < end;
    alive = alive & (inside | !lanes);
    return lanes & inside;
  }

  /// To that step where it is not before the present one plus `least`.
  void advance(M lanes, D to, I least) noexcept {
    const I bounded = convert<std::int32_t>(min(to, D(1 << 30)));
    index = select(lanes, max(bounded, index + least), index);
  }

  double step_;
};

}  // namespace pellucid
#endif
