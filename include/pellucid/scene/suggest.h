// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/channels.h"
#include "pellucid/scene/multivariate_transfer_function.h"

namespace pellucid {

/// First transfer functions for data that nobody has looked at yet, to be saved and edited. What
/// they have in common:
///
/// What fills the most of the volume is taken for its background, and is transparent: the bin of
/// the joint histogram with the largest count, and what stands about it within three standard
/// deviations. Extinctions come from some thousand lines through the data along the axes of the
/// grid: what the most of them meet lets through about half of the light, and what fewer meet is
/// the denser the fewer, to be seen inside of it; that has the more vivid color too. Hues are
/// spread evenly, in the order of the first channel. Numbers are rounded to readable ones.
///
/// The same data gives the same suggestion, for any number of threads. Both throw Error where a
/// channel is not there, and where no data point has a number in each of the channels.

/// Boundaries between materials and the materials themselves, in the manner of Kindlmann and Durkin
/// 1998 and Kniss et al. 2003, from a channel and its gradient magnitude. Materials are the peaks
/// of the histogram of values whose gradient is small: a primitive at (the peak, no gradient),
/// none for the background. Between two that follow each other boundaries have an arch in the joint
/// histogram: a primitive half-way between the two values, at the gradient that is the most common
/// there. Where there are not two materials it is suggest_mixture() of the two channels.
std::vector<GaussianPrimitive> suggest_boundaries(const Channels& channels, int value,
                                                  int gradient_magnitude,
                                                  const ParallelFor& parallel = {});

/// The most channels that suggest_mixture() looks at, and primitives that it makes.
inline constexpr int max_suggested_channels = 3;
inline constexpr int max_suggested_primitives = 8;

/// A mixture of normal distributions fitted to the joint histogram of one to three channels without
/// the background (fit_mixture), its counts taken by their square roots, so that rare materials
/// count beside common ones: each becomes a primitive of half of its covariance. With `primitives`
/// of 0 the number is that of the least information criterion up to 5. Where nothing but background
/// is there it is one haze. Throws Error also where there are not one to three channels, one stands
/// twice, or `primitives` is not from 0 to max_suggested_primitives.
std::vector<GaussianPrimitive> suggest_mixture(const Channels& channels,
                                               const std::vector<int>& which, int primitives = 0,
                                               const ParallelFor& parallel = {});

}  // namespace pellucid
