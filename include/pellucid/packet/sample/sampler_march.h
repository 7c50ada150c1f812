// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/sample/sampler_steps.h"
#include "pellucid/packet/steps/packet_samples.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes that take steps of one length, and the data around them. Places are found in
/// double at the beginning of every few steps, and in float from there (step_positions.h).
template <int N>
class SamplerMarch : public SamplerSteps<N> {
 public:
  using Steps = SamplerSteps<N>;
  using typename Steps::D;
  using typename Steps::F;

  /// Rays of lanes beyond `count` are not alive.
  SamplerMarch(const PacketGrid& grid, const PellucidRay* rays, int count, double step) noexcept
      : Steps(grid, rays, count, step), samples_(grid) {
    samples_.set_direction(Steps::direction());
  }

  /// Makes sample() of the steps from `index` on ready.
  void anchor(D at) noexcept {
    D place[3];
    Steps::place(at, place);
    samples_.anchor(place);
  }

  /// The data at as many world lengths from the anchor as steps are gone at once; NaN in vacuum.
  PELLUCID_ALWAYS_INLINE void sample(const F* offset, F* value) const noexcept {
    if (Steps::steps_at_once == Steps::max_at_once) {
      samples_.template sample<Steps::max_at_once>(offset, value);
    } else {
      samples_.template sample<1>(offset, value);
    }
  }
  PELLUCID_ALWAYS_INLINE F sample_anchor() const noexcept {
    const F here(0);
    F value;
    samples_.template sample<1>(&here, &value);
    return value;
  }

 private:
  PacketSamples<N> samples_;
};

}  // namespace pellucid
#endif
