// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// A Gaussian primitive in binary32: it matters where |K (v - c)|² < square, and everywhere if that
/// is NaN.
struct NearGaussian {
  Gaussian<float> gaussian;
  float square = 0;
  /// |K (v - c)| is at least this times the distance of v from c in a channel, whatever v is in the
  /// others.
  float least_scale[max_channels] = {};
  bool couples_channels = false;  ///< whether a row of K looks at several of them
};

/// A lower bound on |K (v - c)|², v anywhere in the box of these ranges of the channels, without
/// the descent of least_exponent(): of each row, how far its range is from 0; and where rows couple
/// channels, what a channel alone says. Exact where they do not; else it knows 19 of 20 boxes that
/// are far for that, which is asserted in tests/cpu. What is rounded, in binary32, is part of what
/// NearGaussian::square makes up for. T may be a batch.
template <class T>
T least_exponent_by_rows(const NearGaussian& near, const T* lower, const T* upper) noexcept {
  const Gaussian<float>& g = near.gaussian;
  T sum(0);
  for (int row = 0; row < g.rows; ++row) {
    T least(0), most(0);
    for (int c = 0; c < g.channels; ++c) {
      const float k = g.matrix[row][c];
      if (k == 0) continue;
      const T a = T(k) * (lower[c] - T(g.center[c])), b = T(k) * (upper[c] - T(g.center[c]));
      least += min(a, b);
      most += max(a, b);
    }
    const T gap = max(max(least, -most), T(0));
    sum += gap * gap;
  }
  if (!near.couples_channels) return sum;
  T away(0);
  for (int c = 0; c < g.channels; ++c) {
    const T gap = max(lower[c] - T(g.center[c]), T(g.center[c]) - upper[c]);
    away = max(away, T(near.least_scale[c]) * gap);
  }
  return max(sum, away * away);
}

/// A transfer function of several variables, as rays in lanes look at it before they integrate
/// anything. A view; owns nothing.
struct CulledMixture {
  MultivariateTransfer<double> transfer;
  const NearGaussian* primitive = nullptr;  ///< for each Gaussian of it
  /// The extinction that all may have together where none is near, for rays of the length
  /// `diagonal`, which none is beyond.
  double left_out = 0, diagonal = 1;
  double charged = 0;  ///< the same with what errors of the data may make of it
  /// True if what double rounds K (v - c) by is next to nothing in binary32, and there are no
  /// tables.
  bool suits_binary32 = false;
  /// Largest slope of the extinction of all Gaussians together, by channel.
  double steepness[max_channels] = {};
};

}  // namespace pellucid
