// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "pellucid/scene/channels.h"
#include "pellucid/scene/multivariate_transfer_function.h"

namespace pellucid {

/// Suggests first transfer functions for unknown data, to be saved and edited. Both functions work
/// alike:
///
/// - Of more than 2^24 data points a fixed sample is looked at: one of each few consecutive
///   ones.
/// - The background is the bin of the joint histogram with the largest count, and everything within
///   three standard deviations around it. It is transparent.
/// - Extinctions come from some thousand lines through the data along the grid's axes. A material
///   that most lines meet transmits about half of the light. A material that fewer lines meet is
///   denser, so that it is visible inside, and has a more vivid color.
/// - Hues are evenly spaced in the order of the first channel. Numbers are rounded to readable
///   ones.
///
/// The result does not depend on the number of threads. Both throw Error if a channel does not
/// exist, or no data point has a number in each of the channels.

/// Limit on the work of a suggestion, and the receiver of its progress.
struct SuggestControl {
  /// Looks at 65 536 data points and a sixteenth of the lines, and fits three components at most
  /// where their number is open: five to ten times as fast, for a picture that is replaced soon.
  bool quick = false;
  /// Receives the fraction of the work that is done, from 0 to 1, a few times, on the calling
  /// thread; may be empty. What it throws ends the suggestion.
  std::function<void(double fraction)> progress{};
};

/// Suggests primitives for materials and for the boundaries between them from a channel and its
/// gradient magnitude, in the manner of Kindlmann and Durkin 1998 and Kniss et al. 2003.
///
/// Materials are the peaks of the histogram of values with a small gradient: each gets a primitive
/// at (peak, gradient 0), except the background. The boundary of two consecutive materials is an
/// arch in the joint histogram: it gets a primitive half-way between the two values, at the most
/// common gradient there. If there are fewer than two materials, returns suggest_mixture() of the
/// two channels.
std::vector<GaussianPrimitive> suggest_boundaries(const Channels& channels, int value,
                                                  int gradient_magnitude,
                                                  const ParallelFor& parallel = {},
                                                  const SuggestControl& control = {});

/// Limits of suggest_mixture(): number of channels, and number of primitives.
inline constexpr int max_suggested_channels = 3;
inline constexpr int max_suggested_primitives = 8;

/// Suggests primitives from a mixture of normal distributions, fitted to the joint histogram of one
/// to three channels without the background (fit_mixture()). The counts are replaced by their
/// square roots, so that rare materials count beside common ones. Each component becomes a
/// primitive with half of its covariance.
///
/// If `primitives` is 0, the number with the smallest information criterion up to 5 is taken, and
/// components whose mean is within 5.5 standard deviations of the background are left out. If there
/// is only background, returns a single haze. Also throws Error if there are not one to three
/// channels, one is a duplicate, or `primitives` is not in [0, max_suggested_primitives].
std::vector<GaussianPrimitive> suggest_mixture(const Channels& channels,
                                               const std::vector<int>& which, int primitives = 0,
                                               const ParallelFor& parallel = {},
                                               const SuggestControl& control = {});

}  // namespace pellucid
