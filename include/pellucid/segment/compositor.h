// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/result.h"

namespace pellucid {

/// Composites the segments of a ray front to back into a pixel (specification, 2.2) in the number
/// type A:
///
///   L += T · L_i,  α += T · α_i,  T *= 1 - α_i (thin) or T_i (dense),  depth += depth_i
///
/// A is double in practice, whatever the segments' type: compositing N segments in binary32 costs 3
/// N u, and products of 1 - opacity stagnate there (2.3). The opacity is summed separately, so that
/// it keeps its relative precision in nearly transparent rays, where 1 - transparency has none.
///
/// Error: that of the segments, by the theorem of section 2.3, Σ T_{<i} (e_i + C_max d_i) with the
/// errors e_i and d_i of their radiance and opacity, plus 4 N u(A) of its own. Terminating at
/// done() omits at most stop · C_max of radiance and `stop` of opacity, with an upper bound C_max
/// on the colors of the remainder. Asserted in tests/segment.
template <class A>
class FrontToBackCompositor {
 public:
  /// Begins a ray. `stop` >= 0 is the transparency at which the ray may end. Zero: only an opaque
  /// ray ends.
  PELLUCID_HD explicit FrontToBackCompositor(A stop = A(0)) noexcept : stop_(stop) {}

  /// Composites the next segment.
  template <class T>
  PELLUCID_HD void add(const SegmentResult<T>& segment) noexcept {
    const A opacity = static_cast<A>(segment.opacity);
    const A weighted = transparency_ * opacity;
    radiance_.r += transparency_ * static_cast<A>(segment.radiance.r);
    radiance_.g += transparency_ * static_cast<A>(segment.radiance.g);
    radiance_.b += transparency_ * static_cast<A>(segment.radiance.b);
    opacity_ += weighted;
    optical_depth_ += static_cast<A>(segment.optical_depth);
    // The opacity is precise in thin segments, the transparency in dense ones.
    transparency_ = select(opacity < A(0.5), transparency_ - weighted,
                           transparency_ * static_cast<A>(segment.transparency));
  }

  /// Selects lane by lane.
  friend FrontToBackCompositor select(mask_t<A> mask, const FrontToBackCompositor& a,
                                      const FrontToBackCompositor& b) noexcept {
    const auto each = [&](const A& x, const A& y) noexcept { return select(mask, x, y); };
    FrontToBackCompositor r(each(a.stop_, b.stop_));
    r.transparency_ = each(a.transparency_, b.transparency_);
    r.opacity_ = each(a.opacity_, b.opacity_);
    r.optical_depth_ = each(a.optical_depth_, b.optical_depth_);
    r.radiance_ = {each(a.radiance_.r, b.radiance_.r), each(a.radiance_.g, b.radiance_.g),
                   each(a.radiance_.b, b.radiance_.b)};
    return r;
  }

  /// Returns whether the remainder of the ray cannot matter.
  PELLUCID_HD bool done() const noexcept { return transparency_ <= stop_; }

  PELLUCID_HD Rgb<A> radiance() const noexcept { return radiance_; }
  PELLUCID_HD A optical_depth() const noexcept { return optical_depth_; }
  PELLUCID_HD A transparency() const noexcept { return transparency_; }
  PELLUCID_HD A opacity() const noexcept { return min(opacity_, A(1)); }
  PELLUCID_HD SegmentResult<A> result() const noexcept {
    return {optical_depth_, opacity(), transparency_, radiance_};
  }

 private:
  A transparency_ = A(1);
  A opacity_ = A(0);
  A optical_depth_ = A(0);
  A stop_;
  Rgb<A> radiance_{};
};

}  // namespace pellucid
