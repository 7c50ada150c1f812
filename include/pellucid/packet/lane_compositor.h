// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/budget.h"
#include "pellucid/packet/interface.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Results of lanes that fell back to another integrator; zero in other lanes.
template <int N>
struct ScalarFallback {
  double optical_depth[N] = {}, opacity[N] = {}, transparency[N], radiance[3][N] = {};
  double error[N] = {}, opacity_bound[N] = {};

  ScalarFallback() noexcept {
    for (double& t : transparency) t = 1;
  }
  void set(int lane, const PellucidCellResult& found) noexcept {
    optical_depth[lane] = found.optical_depth;
    opacity[lane] = found.opacity;
    transparency[lane] = found.transparency;
    for (int c = 0; c < 3; ++c) radiance[c][lane] = found.radiance[c];
    error[lane] = found.error;
    opacity_bound[lane] = found.opacity_bound;
  }
};

/// The light of a lane's ray; of the rest nothing.
template <int N>
PellucidRayResult light_of_lane(const SegmentResult<Batch<double, N>>& all, int lane) noexcept {
  PellucidRayResult r{};
  r.radiance[0] = all.radiance.r[lane];
  r.radiance[1] = all.radiance.g[lane];
  r.radiance[2] = all.radiance.b[lane];
  r.opacity = all.opacity[lane];
  r.optical_depth = all.optical_depth[lane];
  return r;
}

/// Results of rays in lanes, composited in double, and their remaining tolerances, in float.
template <int N>
class LaneCompositor {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using M = BatchMask<N>;

  LaneCompositor() = default;
  /// `lengths` of the rays, in world units.
  LaneCompositor(double tolerance, double largest_extinction, double largest_color,
                 F lengths) noexcept
      : LaneCompositor(F(static_cast<float>(tolerance)), largest_extinction, largest_color,
                       lengths) {}
  LaneCompositor(F tolerance, double largest_extinction, double largest_color, F lengths) noexcept
      : budget(without_kept_back(tolerance), lengths),
        tolerance_(without_kept_back(tolerance)),
        largest_extinction_(static_cast<float>(largest_extinction)),
        largest_color_(largest_color) {}

  RayBudget<F> budget;

  F transparency() const noexcept { return convert<float>(compositor_.transparency()); }
  D opacity() const noexcept { return compositor_.opacity(); }

  /// Adds the lanes' segments to their rays, not what they cost.
  template <class T>
  void add(M lanes, const SegmentResult<T>& s) noexcept {
    const auto masked = [&](const T& value) noexcept {
      return select(lanes, convert<double>(value), D(0));
    };
    compositor_.add(
        SegmentResult<D>{masked(s.optical_depth),
                         masked(s.opacity),
                         select(lanes, convert<double>(s.transparency), D(1)),
                         {masked(s.radiance.r), masked(s.radiance.g), masked(s.radiance.b)}});
  }
  /// Adds results that were handed back, of these world lengths, and charges their errors.
  void add(const ScalarFallback<N>& s, F lengths) noexcept {
    const F before = transparency();
    compositor_.add(
        SegmentResult<D>{D::load(s.optical_depth),
                         D::load(s.opacity),
                         D::load(s.transparency),
                         {D::load(s.radiance[0]), D::load(s.radiance[1]), D::load(s.radiance[2])}});
    budget.spend(lengths, convert<float>(D::load(s.opacity_bound)), before,
                 convert<float>(D::load(s.error)) * F(1 + 4 * rounding_unit<float>));
  }

  /// Returns the lanes that terminate early now, and charges the neglected remainder to them.
  M cut_off(M lanes) noexcept {
    const M done = lanes & (!cut_off_) & budget.allows_termination(remainder_bound(), tolerance_);
    cut_off_ = cut_off_ | done;
    return done;
  }

  SegmentResult<D> result() const noexcept { return compositor_.result(); }
  /// Returns the errors of rays of so many segments. Folding in double costs 4 u a segment, adding
  /// up costs in float 2 u of them.
  D error(D segments) const noexcept {
    constexpr double folding = 8 * rounding_unit<double>;
    constexpr double account = 2 * static_cast<double>(rounding_unit<float>);
    const D all = segments + D(1);
    return convert<double>(budget.spent() + select(cut_off_, remainder_bound(), F(0))) *
               (D(1) + D(account) * all) +
           D(folding * largest_color_) * all;
  }

  friend LaneCompositor select(M mask, const LaneCompositor& a, const LaneCompositor& b) noexcept {
    LaneCompositor r = a;
    r.budget = select(mask, a.budget, b.budget);
    r.compositor_ = select(mask, a.compositor_, b.compositor_);
    r.cut_off_ = (mask & a.cut_off_) | ((!mask) & b.cut_off_);
    return r;
  }

 private:
  /// The share of the tolerance that pays for adding up costs in float: of 16000 segments.
  static constexpr double kept_back = 0x1p-9;
  static F without_kept_back(F tolerance) noexcept {
    return tolerance * F(static_cast<float>(1 - kept_back));
  }

  /// A bound on what lies behind the last segment, as little as light can come from there.
  F remainder_bound() const noexcept {
    return budget.remainder_bound(transparency(), F(largest_extinction_),
                                  F(static_cast<float>(largest_color_)));
  }

  FrontToBackCompositor<D> compositor_;
  F tolerance_{0};  ///< that the budget began with
  float largest_extinction_ = 0;
  double largest_color_ = 0;
  M cut_off_{false};
};

}  // namespace pellucid
#endif
