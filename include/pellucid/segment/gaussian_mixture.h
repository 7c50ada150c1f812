// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/bounds.h"
#include "pellucid/segment/bounded.h"
#include "pellucid/segment/gaussian.h"

namespace pellucid {

/// The range of a set of colors.
template <class T>
struct ColorRange {
  Rgb<T> lower{T(largest<T>), T(largest<T>), T(largest<T>)};
  Rgb<T> upper{T(-largest<T>), T(-largest<T>), T(-largest<T>)};

  /// Adds `color` in the lanes of `mask`.
  template <class Mask>
  PELLUCID_HD void add(Mask mask, const Rgb<T>& color) noexcept {
    lower = {select(mask, min(lower.r, color.r), lower.r),
             select(mask, min(lower.g, color.g), lower.g),
             select(mask, min(lower.b, color.b), lower.b)};
    upper = {select(mask, max(upper.r, color.r), upper.r),
             select(mask, max(upper.g, color.g), upper.g),
             select(mask, max(upper.b, color.b), upper.b)};
  }
  /// Returns the largest difference in any channel; 0 without colors.
  PELLUCID_HD T oscillation() const noexcept {
    return max(T(0), max(upper.r - lower.r, max(upper.g - lower.g, upper.b - lower.b)));
  }
  PELLUCID_HD Rgb<T> clamped(const Rgb<T>& c) const noexcept {
    return {clamp(c.r, lower.r, upper.r), clamp(c.g, lower.g, upper.g),
            clamp(c.b, lower.b, upper.b)};
  }
};

/// The optical depth of a sum of primitives and their mean color weighted by depth, added one by
/// one. A running mean neither divides by a depth of 0 nor overflows.
template <class T>
struct DepthWeightedColor {
  T depth{};
  Rgb<T> color{};
  ColorRange<T> range;

  PELLUCID_HD void add(T mass, const Rgb<T>& of) noexcept {
    depth += mass;
    const auto counts = mass > T(0);
    const T share = select(counts, mass, T(0)) / select(counts, depth, T(1));
    color += share * (of - color);
    range.add(counts, of);
  }
};

/// Returns the optical depth of a sum of primitives along data linear from v1 to v2: exact, Σ of
/// gaussian_segment().
template <class S, class T>
PELLUCID_HD T gaussian_mixture_depth(const GaussianMixture<S>& mixture, const T* v1, const T* v2,
                                     T length) noexcept {
  T depth = T(0);
  for (int i = 0; i < mixture.count; ++i) {
    const Gaussian<S>& g = mixture.primitive[i];
    depth += (T(g.peak) * length) * gaussian_mean_density(g, v1, v2);
  }
  return depth;
}

/// Returns a sum of primitives in a single color, their mean weighted by optical depth: Kniss's
/// segment, generalised (specification, 3.5 (i)). Depth, opacity and transparency are exact up to
/// rounding. The color's error is proved: at most κ(depth) times the range of the colors of
/// positive depth (equation 5); 0 for one primitive or one color.
template <class S, class T>
PELLUCID_HD BoundedSegment<T> gaussian_mixture_mean(const GaussianMixture<S>& mixture, const T* v1,
                                                    const T* v2, T length) noexcept {
  DepthWeightedColor<T> sum;
  for (int i = 0; i < mixture.count; ++i) {
    const Gaussian<S>& g = mixture.primitive[i];
    sum.add((T(g.peak) * length) * gaussian_mean_density(g, v1, v2),
            Rgb<T>{T(g.color.r), T(g.color.g), T(g.color.b)});
  }
  BoundedSegment<T> result{segment_of_depth(sum.depth, sum.color)};
  result.color_error =
      result.segment.opacity * (sum.range.oscillation() * mean_color_bound(sum.depth));
  return result;
}

}  // namespace pellucid
