// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/transfer/multivariate.h"

namespace pellucid {

/// A Gaussian primitive in binary32: it matters where |K (v - c)|² < square, and everywhere if that
/// is NaN.
struct NearGaussian {
  Gaussian<float> gaussian;
  float square = 0;
};

/// A transfer function of a mesh's variables, as rays in lanes look at it before they integrate
/// anything. A view; owns nothing.
struct MeshMixture {
  Multivariate<double> transfer;
  const NearGaussian* primitive = nullptr;  ///< for each Gaussian of it
  /// The extinction that all may have together where none is near; as much again may be what errors
  /// of the data make of it. For rays of the length `diagonal`, which none is beyond.
  double left_out = 0, diagonal = 1;
  /// How fast the extinction of all Gaussians together may change with a channel, at most.
  double steepness[most_channels] = {};
};

}  // namespace pellucid
