// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/error/budget.h"
#include "pellucid/packet/gaussian_march.h"
#include "pellucid/packet/gaussian_packet_interface.h"
#include "pellucid/segment/fold.h"

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

  GaussianPacket(const PellucidGaussianPacketJob& job, const PacketGrid<void>& grid) noexcept
      : job_(job),
        rays_(job.grid_and_rays),
        march_(grid, *static_cast<const MultichannelGrid*>(job.grid),
               *static_cast<const SteppedMixture*>(job.mixture),
               static_cast<const PrimitiveSet*>(job.primitives),
               static_cast<const BlockVariation*>(job.variation)),
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

  /// The share of the tolerance that pays for adding up costs in float: of 16000 segments.
  static constexpr double kept_back = 0x1p-9;
  /// Of the difference of two rules what counts as the standard deviation of the better one: more
  /// than in smooth stretches, for all of a narrow primitive may lie in a few steps.
  static constexpr float share_of_difference = 0.8f;
  /// Rays that need more are given up: `kept_back` pays for so many.
  static constexpr int most_looks = 1 << 14;

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
    const RayBudget<F> budget(F(static_cast<float>(rays_.tolerance * (1 - kept_back))),
                              convert<float>(march_.end()));
    budget_ = select(given, budget, budget_);
    sampled_ = select(given, SampledErrors<F>(), sampled_);
    fold_ = select(given, FrontToBack<D>(), fold_);
    cut_off_ = cut_off_ & !given;
    given_up_ = given_up_ & !given;
    for (I* counter : {&skipped_, &segments_, &looks_}) *counter = select(given, I(0), *counter);
    return true;
  }

  /// What the rays of these lanes have gathered.
  void store(M lanes) noexcept {
    const SegmentResult<D> all = fold_.result();
    // Folding in double costs 4 u a segment, and adding up costs in float 2 u of them.
    constexpr double folding = 8 * rounding_unit<double>;
    constexpr double account = 2 * static_cast<double>(rounding_unit<float>);
    const D segments = convert<double>(segments_) + D(1);
    const D error = convert<double>(budget_.spent() + select(cut_off_, rest_behind(), F(0))) *
                        (D(1) + D(account) * segments) +
                    D(folding * rays_.largest_color) * segments +
                    D(rays_.largest_color) * min(D(job_.left_out) * march_.end(), D(1));
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
      r.error =
          (bits(given_up_) >> l & 1) != 0 ? std::numeric_limits<double>::infinity() : field[5][l];
      r.cells = r.evaluations = 4 * looks[l];
      r.skipped = skipped[l];
      r.strides = taken[l];
      r.proved = taken[l] == 0 ? 1 : 0;
      ray_of_lane_[l] = -1;
    }
  }

  void step() noexcept {
    const M on = march_.alive;
    const F left = convert<float>(march_.end() - march_.at);
    march_.look(look_);
    looks_ += select(on, I(1), I(0));
    const M empty = on & look_.empty;
    if (any(empty)) march_.take(empty, look_, empty);
    M rest = on & !empty;
    if (any(rest & look_.resolved)) rest = rest & !integrate(rest & look_.resolved, left);
    if (any(rest)) give_up(march_.retry(rest, look_));
    give_up(on & (looks_ >= I(most_looks)));
  }

  /// Adds the steps to their rays where the budget can pay for their error: those that are
  /// returned.
  M integrate(M lanes, F left) noexcept {
    const SegmentResult<F>& s = look_.found.segment;
    const F transparency = convert<float>(fold_.transparency());
    const F deviation = F(share_of_difference) * look_.found.difference;
    const F variance =
        transparency * transparency *
        (deviation * deviation + largest_color_ * largest_color_ * look_.least_variance);
    const F rounding =
        transparency * largest_color_ *
        (F(32 * rounding_unit<float>) * s.opacity + look_.ends.rounding * look_.length);
    const F largest = sampled_.largest_variance(budget_, rounding, s.opacity, look_.length, left);
    const M take = lanes & (variance <= largest) & (rounding <= budget_.left());
    if (none(take)) return take;
    const auto masked = [&](F value) noexcept {
      return select(take, convert<double>(value), D(0));
    };
    fold_.add(SegmentResult<D>{masked(s.optical_depth),
                               masked(s.opacity),
                               select(take, convert<double>(s.transparency), D(1)),
                               {masked(s.radiance.r), masked(s.radiance.g), masked(s.radiance.b)}});
    sampled_.pay(take, budget_, variance, rounding, s.opacity, look_.length, left, transparency);
    segments_ += select(take, I(1), I(0));
    march_.take(take, look_, variance <= F(0.05f) * largest);
    const M done = take & (rest_behind() <= budget_.left());
    march_.alive = march_.alive & !done;
    cut_off_ = cut_off_ | done;
    return take;
  }

  void give_up(M lanes) noexcept {
    given_up_ = given_up_ | lanes;
    march_.alive = march_.alive & !lanes;
  }

  /// A bound on what lies behind the last step, as little as light can come from there.
  F rest_behind() const noexcept {
    const F opacity =
        min(F(static_cast<float>(rays_.largest_extinction)) * budget_.length_left(), F(1));
    return convert<float>(fold_.transparency()) * opacity * largest_color_;
  }

  const PellucidGaussianPacketJob& job_;
  const PellucidPacketJob& rays_;
  int next_ = 0;  ///< of the job's rays
  int ray_of_lane_[N];
  PellucidRay lane_ray_[N];
  March march_;
  typename March::Look look_;
  SampledErrors<F> sampled_;
  RayBudget<F> budget_;
  FrontToBack<D> fold_;
  F largest_color_;
  M cut_off_{false}, given_up_{false};
  I skipped_, segments_, looks_;
};

}  // namespace pellucid
#endif
