// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/gaussian_kniss.h"
#include "pellucid/segment/gaussian_mixture.h"
#include "pellucid/segment/piecewise_linear.h"
#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// Computation of the depth of a Gaussian along linear data: as in the paper (gaussian_kniss.h), or
/// accurately (gaussian.h).
enum class GaussianRule { kniss, closed_form };

/// Returns the mean density of a primitive along data linear from v1 (front) to v2, by a rule.
template <class S, class T>
PELLUCID_HD T mean_density(GaussianRule rule, const Gaussian<S>& primitive, const T* v1,
                           const T* v2) noexcept {
  return rule == GaussianRule::kniss ? kniss_mean_density(primitive, v1, v2)
                                     : gaussian_mean_density(primitive, v1, v2);
}

/// Returns Kniss's segment: all terms along data linear from v1 (front) to v2 in a single color,
/// their mean weighted by optical depth (specification, 3.5 (i)). For comparison: the color's error
/// is not computed; gaussian_mixture_mean() bounds it.
///
/// With the rule closed_form the depth is exact up to rounding. The paper has Gaussians only; with
/// both rules a table has its exact depth (piecewise_linear.h) and the color of its own segment, so
/// that a single table is exact. v1 and v2 have `channels` numbers; length >= 0.
template <class T>
PELLUCID_HD SegmentResult<T> mean_color_segment(GaussianRule rule,
                                                const MultivariateTransfer<T>& transfer,
                                                const T* v1, const T* v2, T length) noexcept {
  DepthWeightedColor<T> sum;
  for (int i = 0; i < transfer.gaussians.count; ++i) {
    const Gaussian<T>& g = transfer.gaussians.primitive[i];
    sum.add((g.peak * length) * mean_density(rule, g, v1, v2), g.color);
  }
  for (int i = 0; i < transfer.tables; ++i) {
    const ChannelTable<T>& term = transfer.table[i];
    const SegmentResult<T> alone =
        piecewise_linear_segment(term.table, v1[term.channel], v2[term.channel], length);
    if (!(alone.opacity >= T(smallest_normal<T>))) continue;
    sum.add(alone.optical_depth, (T(1) / alone.opacity) * alone.radiance);
  }
  return segment_of_depth(sum.depth, sum.color);
}

}  // namespace pellucid
