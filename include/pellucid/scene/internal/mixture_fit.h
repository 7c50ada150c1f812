// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Points with weights >= 0, such as the bins of a histogram.
struct WeightedPoints {
  int dimensions = 1;
  std::vector<double> coordinates;  ///< `dimensions` numbers per point, finite
  std::vector<double> weights;      ///< one per point

  std::size_t count() const noexcept { return weights.size(); }
};

/// One normal distribution of a mixture.
struct NormalComponent {
  double weight = 0;  ///< fraction of the total weight, in [0, 1]
  std::vector<double> mean;
  std::vector<std::vector<double>> covariance;
};

/// A mixture of normal distributions and the quality of its fit.
struct MixtureFit {
  std::vector<NormalComponent> components;  ///< the heaviest first
  double log_likelihood = 0;  ///< of all points, each counted as often as its weight says
  /// Bayesian information criterion (Schwarz 1978): parameters · ln(sum of weights) - 2 ·
  /// log_likelihood. Smaller is better.
  double bic = 0;
};

/// The largest number of components of a mixture.
inline constexpr int max_components = 16;

/// Fits a mixture of normal distributions with full covariances by expectation maximisation
/// (Dempster, Laird and Rubin 1977).
///
/// No axis of a covariance has a variance below `floor` (one number > 0 per dimension, for example
/// the square of a bin's width). The fit starts from eight fixed initialisations and continues with
/// the likeliest after a few steps, so that equal points give an equal fit, on any number of
/// threads. More than 4096 points are first merged into as many cells at most, to whose means and
/// covariances the mixture is fitted (Verbeek, Nunnink and Vlassis 2006); up to 20 steps with all
/// points follow. Components that lose all points are dropped.
///
/// Throws Error if no point has a positive weight, sizes do not agree, a number is not finite, or
/// `components` is not in [1, max_components].
MixtureFit fit_mixture(const WeightedPoints& points, int components,
                       const std::vector<double>& floor, const ParallelFor& parallel = {});

/// Returns the fit with the smallest information criterion among those with `least` … `most`
/// components. Throws Error as above.
MixtureFit fit_mixture(const WeightedPoints& points, int least, int most,
                       const std::vector<double>& floor, const ParallelFor& parallel = {});

}  // namespace pellucid
