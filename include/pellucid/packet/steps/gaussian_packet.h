// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/packet/gaussian_packet_interface.h"
#include "pellucid/packet/lane_compositor.h"
#include "pellucid/packet/opacity_trace.h"
#include "pellucid/packet/steps/gaussian_march.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays through several fields behind Gaussians, N at a time, each in a lane of its own and within
/// its own tolerance, in the grade `estimated`: four steps at a time, whose error is the difference
/// of two rules (segment/sampled.h), as a random one. A lane that is through with its ray takes the
/// next one. Rays that binary32 is not good enough for, or that come near vacuum, are given up.
template <int N>
class GaussianPacket {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  GaussianPacket(const PellucidGaussianPacketJob& job, const PacketGrid& grid) noexcept
      : job_(job),
        rays_(job.grid_and_rays),
        march_(grid, *seen(job.grid), *seen(job.stepped), seen(job.primitives), seen(job.variation),
               job.waves),
        trace_(rays_.depth != 0),
        largest_color_(static_cast<float>(rays_.largest_color)) {
    for (int l = 0; l < N; ++l) {
      ray_of_lane_[l] = -1;
      lane_ray_[l] = {};
    }
  }

  void run() noexcept {
    for (;;) {
      const M idle = !march_.alive;
      if (any(idle) && (next_ < rays_.count ? count(idle) >= N / 4 : none(march_.alive))) {
        store(idle);
        if (!begin_rays(idle)) return;
      }
      march_.skip(skipped_);
      if (any(march_.alive)) step();
    }
  }

 private:
  using March = GaussianMarch<N>;

  /// Fraction of the difference of two rules that counts as the standard deviation of the better
  /// one: more than in smooth stretches, for all of a narrow primitive may lie in a few steps.
  static constexpr float share_of_difference = 0.8f;
  /// Rays that need more are given up: LaneCompositor keeps back what so many cost.
  static constexpr int max_looks = 1 << 14;

  /// Gives these lanes the next rays; false: there are none, and no lane has any.
  bool begin_rays(M lanes) noexcept {
    M given(false);
    for (unsigned left = bits(lanes); left != 0 && next_ < rays_.count; left &= left - 1) {
      const int l = __builtin_ctz(left);
      lane_ray_[l] = rays_.rays[next_];
      ray_of_lane_[l] = next_++;
      given = given | M::from_bits(1u << l);
    }
    if (none(given)) return any(march_.alive);
    march_.begin(given, lane_ray_);
    const LaneCompositor<N> nothing(rays_.tolerance, rays_.largest_extinction, rays_.largest_color,
                                    convert<float>(march_.end()));
    compositor_ = select(given, nothing, compositor_);
    trace_.begin(given);
    sampled_ = select(given, SampledErrors<F>(), sampled_);
    given_up_ = given_up_ & !given;
    for (I* counter : {&skipped_, &segments_, &looks_}) *counter = select(given, I(0), *counter);
    return true;
  }

  /// Stores the results of the rays of these lanes.
  void store(M lanes) noexcept {
    const SegmentResult<D> all = compositor_.result();
    const D error = compositor_.error(convert<double>(segments_)) +
                    D(rays_.largest_color) * min(D(job_.left_out) * march_.end(), D(1));
    const F neighbor_deviation = largest_color_ * march_.neighbor_deviation(),
            longest_step = march_.longest_step_between();
    double field[6][N];
    std::int32_t looks[N], skipped[N], taken[N];
    all.radiance.r.store(field[0]);
    all.radiance.g.store(field[1]);
    all.radiance.b.store(field[2]);
    all.opacity.store(field[3]);
    all.optical_depth.store(field[4]);
    error.store(field[5]);
    looks_.store(looks);
    skipped_.store(skipped);
    segments_.store(taken);
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      if (ray_of_lane_[l] < 0) continue;
      PellucidRayResult& r = rays_.results[ray_of_lane_[l]];
      r = {};
      for (int c = 0; c < 3; ++c) r.radiance[c] = field[c][l];
      r.opacity = field[3][l];
      r.optical_depth = field[4][l];
      r.error = field[5][l];
      if ((bits(given_up_) >> l & 1) != 0) r.status = pellucid_left;
      r.cells = r.evaluations = 4 * looks[l];
      r.skipped = skipped[l];
      r.strides = taken[l];
      r.proved = taken[l] == 0 ? 1 : 0;
      r.neighbor_deviation = neighbor_deviation[l];
      r.longest_step = longest_step[l];
      trace_.find_half(l, lane_ray_[l].begin, lane_ray_[l].end, r);
      ray_of_lane_[l] = -1;
    }
  }

  void step() noexcept {
    const M on = march_.alive;
    const F left = convert<float>(march_.end() - march_.at);
    march_.look(look_);
    looks_ += select(on, I(1), I(0));
    const M empty = on & look_.empty;
    F change(2);  // of the step's length, as its error would have it
    if (any(empty)) {
      march_.note(empty, look_, compositor_.transparency());
      march_.take(empty, look_, change);
    }
    M rest = on & !empty;
    if (any(rest & look_.resolved)) rest = rest & !integrate(rest & look_.resolved, left, change);
    if (any(rest)) give_up(march_.retry(rest, look_, change));
    give_up(on & (looks_ >= I(max_looks)));
  }

  /// Adds the steps to their rays where the budget can pay for their error: those that are
  /// returned. `change`: of the step's length, what would have suited it.
  M integrate(M lanes, F left, F& change) noexcept {
    const SegmentResult<F>& s = look_.found.segment;
    const F transparency = compositor_.transparency();
    const F deviation = F(share_of_difference) * look_.found.difference;
    const F variance =
        transparency * transparency *
        (deviation * deviation + largest_color_ * largest_color_ * look_.least_variance);
    const F rounding =
        transparency * largest_color_ *
        (F(32 * rounding_unit<float>) * s.opacity + look_.ends.rounding * look_.length);
    const F largest =
        sampled_.largest_variance(compositor_.budget, rounding, s.opacity, look_.length, left);
    const M take = lanes & (variance <= largest) & (rounding <= compositor_.budget.remaining());
    // The variance of short steps grows with the step's fifth to tenth power, what it may be with
    // the first.
    const F ease = F(0.4f) * largest / max(variance, F(1e-30f));
    const M known = (ease >= F(1e-6f)) & (take | !(variance <= largest));
    const F suits = exp(F(1.0f / 6) * log(min(select(known, ease, F(1)), F(64))));
    // Else rounding alone is too much, or neither is anything.
    change = select(lanes, select(known, suits, select(take, F(1), F(0.5f))), change);
    if (none(take)) return take;
    compositor_.add(take, s);
    sampled_.charge(take, compositor_.budget, variance, rounding, s.opacity, look_.length, left,
                    transparency);
    segments_ += select(take, I(1), I(0));
    march_.note(take, look_, transparency);
    march_.take(take, look_, change);
    trace_.note(take, compositor_);
    march_.alive = march_.alive & !compositor_.cut_off(take);
    return take;
  }

  void give_up(M lanes) noexcept {
    given_up_ = given_up_ | lanes;
    march_.alive = march_.alive & !lanes;
  }

  const PellucidGaussianPacketJob& job_;
  const PellucidPacketJob& rays_;
  int next_ = 0;  ///< of the job's rays
  int ray_of_lane_[N];
  PellucidRay lane_ray_[N];
  March march_;
  typename March::Look look_;
  SampledErrors<F> sampled_;
  LaneCompositor<N> compositor_;
  OpacityTrace<N> trace_;
  F largest_color_;
  M given_up_{false};
  I skipped_, segments_, looks_;
};

}  // namespace pellucid
#endif
