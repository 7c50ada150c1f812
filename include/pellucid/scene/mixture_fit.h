// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace pellucid {

/// Points with weights >= 0, as the bins of a histogram.
struct WeightedPoints {
  int dimensions = 1;
  std::vector<double> coordinates;  ///< `dimensions` numbers per point, finite
  std::vector<double> weights;      ///< one per point

  std::size_t count() const noexcept { return weights.size(); }
};

/// One of the normal distributions of a mixture.
struct NormalComponent {
  double weight = 0;  ///< share of all, in [0, 1]
  std::vector<double> mean;
  std::vector<std::vector<double>> covariance;
};

struct MixtureFit {
  std::vector<NormalComponent> components;  ///< the heaviest first
  double log_likelihood = 0;                ///< of all points, each as often as its weight says
  /// Bayesian information criterion (Schwarz 1978): parameters · ln(sum of weights) - 2 ·
  /// log_likelihood; the smaller the better.
  double bic = 0;
};

/// The most components of a mixture.
inline constexpr int max_components = 16;

/// A mixture of normal distributions fitted by expectation and maximisation (Dempster, Laird and
/// Rubin 1977), with full covariances of which no axis has a variance below `floor` (one number per
/// dimension, > 0, as the square of a bin's width: what is narrower is not seen). The start is
/// spread over the points in eight fixed ways, of which the likeliest after a few steps is taken
/// on: the same points give the same fit. Components that no point is left to are dropped. Throws
/// Error where there is no point of positive weight, sizes do not agree, a number is not finite, or
/// `components` is not from 1 to max_components.
MixtureFit fit_mixture(const WeightedPoints& points, int components,
                       const std::vector<double>& floor);

/// The fit of the least information criterion with `least` … `most` components. Throws Error as
/// above.
MixtureFit fit_mixture(const WeightedPoints& points, int least, int most,
                       const std::vector<double>& floor);

}  // namespace pellucid
