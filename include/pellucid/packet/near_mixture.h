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
  float least_scale[most_channels] = {};
};

/// A transfer function of several variables, as rays in lanes look at it before they integrate
/// anything. A view; owns nothing.
struct NearMixture {
  Multivariate<double> transfer;
  const NearGaussian* primitive = nullptr;  ///< for each Gaussian of it
  /// The extinction that all may have together where none is near, for rays of the length
  /// `diagonal`, which none is beyond.
  double left_out = 0, diagonal = 1;
  double charged = 0;  ///< the same with what errors of the data may make of it
  /// Whether what double rounds K (v - c) by is next to nothing in binary32, and there are no
  /// tables.
  bool suits_binary32 = false;
  /// How fast the extinction of all Gaussians together may change with a channel, at most.
  double steepness[most_channels] = {};
};

}  // namespace pellucid
