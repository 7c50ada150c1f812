// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/sample/sample_light.h"
#include "pellucid/packet/sample/sampler_fold.h"
#include "pellucid/packet/sample/sampler_march.h"
#include "pellucid/packet/sample/sampler_transfer.h"
#include "pellucid/packet/sampler_interface.h"
#include "pellucid/segment/constant.h"
#include "pellucid/transfer/preintegrated.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Samples N rays at once at a fixed step, each in a lane of its own: the midpoint rule of
/// render/sample_ray.h, or render/sample_preintegrated.h, at the same places. What a ray becomes
/// depends on no other lane.
template <int N>
class PacketSampler {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// Prepares for rays first … first + count - 1 of the job, count <= N.
  PacketSampler(const PellucidSamplerJob& job, const PacketGrid& grid, int first,
                int count) noexcept
      : transfer_(*seen(job.transfer)),
        table_(*seen(job.preintegrated)),
        by_opacity_(job.rule == pellucid_preintegrated),
        step_(job.step),
        stop_(job.stop),
        first_(first),
        count_(count),
        march_(grid, job.grid_and_rays.rays + first, count, job.step),
        light_(grid, seen(job.light), march_) {}
  // The light refers to the rays.
  PacketSampler(const PacketSampler&) = delete;
  PacketSampler& operator=(const PacketSampler&) = delete;

  [[gnu::flatten]] void run_midpoint() noexcept {
    const F step(static_cast<float>(step_));
    for (;;) {
      march_.skip_to_middle();
      if (none(march_.alive)) return;
      const D begin = march_.begin_of(march_.index);
      march_.anchor(march_.middle_of(begin));
      const F left = convert<float>(march_.end - begin);
      const F first_half = F(0.5f) * min(step, left);
      // Each in a loop of its own: what one step waits for is done beside another's.
      F length[most], value[most], place[most];
      M found[most];
      const int steps = march_.steps_at_once;
      for (int i = 0; i < steps; ++i) {
        const F from = step * F(static_cast<float>(i));
        found[i] = march_.alive & (from < left);
        samples_ += select(found[i], I(1), I(0));
        length[i] = min(step, left - from);
        place[i] = from + F(0.5f) * length[i] - first_half;
      }
      march_.sample(place, value);
      for (int i = 0; i < steps; ++i) {
        found[i] = found[i] & (value[i] >= F(transfer_.support_min)) &
                   (value[i] <= F(transfer_.support_max));
      }
      F depth[most];
      Rgb<F> color[most];
      for (int i = 0; i < steps; ++i) {
        depth[i] = F(0);
        color[i] = {};
        if (none(found[i])) continue;
        const Material<F> material =
            material_at(transfer_, select(found[i], value[i], F(transfer_.support_min)));
        depth[i] = select(found[i], material.extinction * length[i], F(0));
        color[i] = material.color;
        if (!light_.is_lit()) continue;
        found[i] = depth[i] > F(0);
        if (none(found[i])) continue;
        const auto here = light_(found[i], begin + convert<double>(first_half + place[i]));
        depth[i] *= here.factor;
        const Rgb<F> lit = here.lit.apply(color[i]);
        color[i] = {select(found[i], lit.r, F(0)), select(found[i], lit.g, F(0)),
                    select(found[i], lit.b, F(0))};
      }
      for (int i = 0; i < steps; ++i) {
        if (none(found[i])) continue;
        const Attenuation<F> a = attenuation(depth[i]);
        compositor_.add(a.opacity, a.transparency, a.opacity * color[i]);
        compositor_.add_depth(depth[i]);
      }
      end_steps();
    }
  }

  [[gnu::flatten]] void run_preintegrated() noexcept {
    const F step(static_cast<float>(step_));
    F front;
    I front_of(-1);  // the step that it begins
    for (;;) {
      march_.skip_steps();
      if (none(march_.alive)) return;
      const D begin = march_.begin_of(march_.index);
      march_.anchor(begin);
      const F left = convert<float>(march_.end - begin);
      const M jumped = march_.alive & (march_.index != front_of);
      if (any(jumped)) front = select(jumped, march_.sample_anchor(), front);
      const int steps = march_.steps_at_once;
      F value[most + 1], length[most], place[most];
      value[0] = front;
      for (int i = 0; i < steps; ++i) {
        length[i] = min(step, left - step * F(static_cast<float>(i)));
        samples_ += select(march_.alive & (length[i] > F(0)), I(1), I(0));
        place[i] = min(step * F(static_cast<float>(i + 1)), left);
      }
      march_.sample(place, value + 1);
      for (int i = 0; i < steps; ++i) {
        const F &from = value[i], &to = value[i + 1];
        const M found = march_.alive & (length[i] > F(0)) &
                        (max(from, to) >= F(table_.support_min)) &
                        (min(from, to) <= F(table_.support_max));
        if (none(found)) continue;
        F opacity;
        Rgb<F> radiance;
        look_up(from, to, opacity, radiance);
        opacity = select(found, opacity, F(0));
        const M partial = found & (length[i] < F(0.999999f) * step) & (opacity > F(0));
        F share = select(found, F(1), F(0));
        if (any(partial)) {
          const F part = select(partial, length[i] / step, F(1));
          const F of_part = attenuation(F(0) - part * log1p(F(0) - opacity)).opacity;
          share = select(partial, of_part / opacity, share);
          opacity = select(partial, of_part, opacity);
        }
        radiance = share * radiance;
        if (light_.is_lit()) light_step(opacity, radiance, begin, place, length, i);
        compositor_.add(opacity, F(1) - opacity, radiance);
      }
      front = value[steps];
      end_steps();
      front_of = march_.index;
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
      r.optical_depth = by_opacity_ ? -log1p(-opacity[l]) : compositor_.optical_depth()[l];
      r.cells = samples_[l];
    }
  }

 private:
  static constexpr int most = SamplerMarch<N>::max_at_once;

  void end_steps() noexcept {
    compositor_.fold();
    march_.index += I(march_.steps_at_once);
    march_.alive = march_.alive & (compositor_.transparency() > D(stop_));
  }

  /// Multiplies a step by the light in its middle, and its depth by the factor there.
  void light_step(F& opacity, Rgb<F>& radiance, D begin, const F* place, const F* length,
                  int i) const noexcept {
    const M found = opacity > F(0);
    if (none(found)) return;
    const F middle = place[i] - F(0.5f) * length[i];
    const auto here = light_(found, begin + convert<double>(middle));
    // Beyond, nothing is seen, and logarithms are infinite.
    const F visible = clamp(opacity, F(smallest_normal<float>), F(1 - 0x1p-24f));
    const F weakened = attenuation(F(0) - here.factor * log1p(F(0) - visible)).opacity;
    const Rgb<F> lit = here.lit.apply((F(1) / visible) * radiance);
    const F seen = select(found, weakened, F(0));
    opacity = seen;
    radiance = {select(found, seen * lit.r, F(0)), select(found, seen * lit.g, F(0)),
                select(found, seen * lit.b, F(0))};
  }

  /// preintegrated_step(), of values that are no NaN.
  PELLUCID_ALWAYS_INLINE void look_up(F front, F back, F& opacity,
                                      Rgb<F>& radiance) const noexcept {
    const F last(static_cast<float>(table_.nodes - 1));
    const F origin(table_.origin), per_value(table_.nodes_per_value);
    const F f = clamp((front - origin) * per_value, F(0), last);
    const F b = clamp((back - origin) * per_value, F(0), last);
    const I before_last(table_.nodes - 2);
    const I i = min(convert<std::int32_t>(f), before_last);
    const I j = min(convert<std::int32_t>(b), before_last);
    const F s = f - convert<float>(i), t = b - convert<float>(j);
    const I first = i * I(table_.nodes) + j;
    F near[2][PreintegratedTable::fields];
    for (int m = 0; m < 2; ++m) {
      F near_back[PreintegratedTable::fields], far_back[PreintegratedTable::fields];
      const float* const row =
          table_.entry + std::ptrdiff_t{PreintegratedTable::fields} * m * table_.nodes;
      load_records<PreintegratedTable::fields>(row, first, near_back);
      load_records<PreintegratedTable::fields>(row + PreintegratedTable::fields, first, far_back);
      for (int k = 0; k < PreintegratedTable::fields; ++k) {
        near[m][k] = multiply_add(t, far_back[k] - near_back[k], near_back[k]);
      }
    }
    F of[PreintegratedTable::fields];
    for (int k = 0; k < PreintegratedTable::fields; ++k) {
      of[k] = multiply_add(s, near[1][k] - near[0][k], near[0][k]);
    }
    opacity = of[0];
    radiance = {of[1], of[2], of[3]};
  }

  const SamplerTransfer& transfer_;
  const PreintegratedTable& table_;
  bool by_opacity_;  ///< the depth: steps have none of their own
  double step_, stop_;
  int first_, count_;
  SamplerMarch<N> march_;
  SampleLight<N> light_;
  SamplerFold<N> compositor_;
  I samples_;
};

}  // namespace pellucid
#endif
