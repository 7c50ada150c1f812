// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/multivariate_sampler_interface.h"
#include "pellucid/packet/sample/sampled_multivariate.h"
#include "pellucid/packet/sample/sampler_fold.h"
#include "pellucid/packet/sample/sampler_steps.h"
#include "pellucid/packet/steps/multichannel_samples.h"
#include "pellucid/segment/constant.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Samples N rays at once through several fields at a fixed step, each in a lane of its own: the
/// midpoint rule of render/sample_ray.h at the same places. What a ray becomes depends on no other
/// lane, but for primitives that do not matter.
template <int N>
class MultivariateSampler {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// Prepares for rays first … first + count - 1 of the job, count <= N.
  MultivariateSampler(const PellucidMultivariateSamplerJob& job, const PacketGrid& grid, int first,
                      int count) noexcept
      : fields_(*seen(job.grid)),
        primitives_(seen(job.primitives)),
        transfer_(*seen(job.transfer)),
        step_(job.step),
        stop_(job.stop),
        first_(first),
        count_(count),
        steps_(grid, job.grid_and_rays.rays + first, count, job.step),
        samples_(fields_, grid) {
    samples_.set_direction(steps_.direction());
  }

  [[gnu::flatten]] void run() noexcept {
    if (steps_.steps_at_once == most) {
      run_by<most>();
    } else {
      run_by<1>();
    }
  }

  void store(PellucidRayResult* results) const noexcept {
    const D opacity = compositor_.opacity();
    for (int l = 0; l < count_; ++l) {
      PellucidRayResult& r = results[first_ + l];
      r = {};
      r.radiance[0] = compositor_.radiance().r[l];
      r.radiance[1] = compositor_.radiance().g[l];
      r.radiance[2] = compositor_.radiance().b[l];
      r.opacity = opacity[l];
      r.optical_depth = compositor_.optical_depth()[l];
      r.cells = taken_[l];
    }
  }

 private:
  using Steps = SamplerSteps<N>;
  static constexpr int most = Steps::max_at_once;

  template <int K>
  PELLUCID_ALWAYS_INLINE void run_by() noexcept {
    const F step(static_cast<float>(step_));
    for (;;) {
      steps_.skip_to_middle();
      if (none(steps_.alive)) return;
      const D begin = steps_.begin_of(steps_.index), middle = steps_.middle_of(begin);
      D at[3];
      steps_.place(middle, at);
      samples_.anchor(at);
      const F left = convert<float>(steps_.end - begin);
      const F first_half = F(0.5f) * min(step, left);
      F length[K], place[K];
      M found[K];
      for (int k = 0; k < K; ++k) {
        const F from = step * F(static_cast<float>(k));
        found[k] = steps_.alive & (from < left);
        taken_ += select(found[k], I(1), I(0));
        length[k] = min(step, left - from);
        place[k] = from + F(0.5f) * length[k] - first_half;
      }
      PrimitiveSet set[K];
      find_primitives<K>(middle, set);
      F value[K][max_channels];
      samples_.template sample<K>(place, value);
      for (int k = 0; k < K; ++k) {
        F sum = value[k][0];
        for (int c = 1; c < fields_.channels; ++c) sum += value[k][c];
        found[k] = found[k] & !is_nan(sum);
        if (none(found[k])) continue;
        const auto here = extinction_and_emission(transfer_, set[k], found[k], value[k]);
        const F depth = select(found[k], here.extinction * length[k], F(0));
        if (none(depth > F(0))) continue;
        const Attenuation<F> a = attenuation(depth);
        const F share = a.opacity / max(here.extinction, F(smallest_normal<float>));
        const Rgb<F> radiance = share * here.emission;
        compositor_.add(a.opacity, a.transparency,
                        {select(found[k], radiance.r, F(0)), select(found[k], radiance.g, F(0)),
                         select(found[k], radiance.b, F(0))});
        compositor_.add_depth(depth);
      }
      compositor_.fold();
      steps_.index += I(K);
      steps_.alive = steps_.alive & (compositor_.transparency() > D(stop_));
    }
  }

  /// Finds the primitives of the blocks in which the next steps' middles lie, the first of which is
  /// at `middle`.
  template <int K>
  PELLUCID_ALWAYS_INLINE void find_primitives(D middle, PrimitiveSet* set) const noexcept {
    const I from = steps_.block_at(middle);
    set[0] = primitives_of(from);
    for (int k = 1; k < K; ++k) set[k] = set[0];
    if (transfer_.gaussians.count < 2 || K == 1) return;
    const auto step_on = [&](int k) noexcept { return min(middle + D(k * step_), steps_.end); };
    const I to = steps_.block_at(step_on(K - 1));
    // Straight ways between two places in a block stay in it.
    if (none(steps_.alive & (from != to))) return;
    for (int k = 1; k < K; ++k) set[k] = primitives_of(steps_.block_at(step_on(k)));
  }

  PrimitiveSet primitives_of(I block) const noexcept {
    if (transfer_.gaussians.count < 2) return {};
    std::int32_t of_lane[N];
    block.store(of_lane);
    PrimitiveSet set{0};
    for (unsigned lanes = bits(steps_.alive); lanes != 0; lanes &= lanes - 1) {
      set.bits |= primitives_[of_lane[__builtin_ctz(lanes)]].bits;
    }
    return set;
  }

  const MultichannelGrid& fields_;
  const PrimitiveSet* primitives_;
  const SampledMultivariate& transfer_;
  double step_, stop_;
  int first_, count_;
  Steps steps_;
  MultichannelSamples<N> samples_;
  SamplerFold<N> compositor_;
  I taken_;
};

}  // namespace pellucid
#endif
