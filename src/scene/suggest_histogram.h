// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/scene/joint_histogram.h"

namespace pellucid {

/// An axis over the values of a channel without the outermost 0.05 % at either end, which would
/// take the range for themselves.
HistogramAxis core_axis(const Channels& channels, int channel, int bins,
                        const ParallelFor& parallel);

/// The coordinates, one per axis, of the bin at this place of a histogram's counts, in bins: its
/// middle is at a half.
std::vector<double> bin_coordinates(const JointHistogram& histogram, std::size_t place);
/// Coordinates in bins as values.
double value_at(const HistogramAxis& axis, double coordinate);

/// The least variance that is told from none, in bins: half a bin, less on axes of few of them,
/// whose neighbours are different things.
double least_variance(const HistogramAxis& axis);

/// What fills the most of the volume: what stands about the bin of the largest count, grown from
/// that bin until it holds what is within three standard deviations, but no further than a
/// twentieth of an axis to a standard deviation.
class BackgroundBin {
 public:
  explicit BackgroundBin(const JointHistogram& histogram);

  /// Whether coordinates in bins are within so many standard deviations.
  bool holds(const std::vector<double>& coordinates, double deviations = 3) const;
  /// In bins.
  const std::vector<double>& mean() const noexcept { return mean_; }

 private:
  std::vector<double> mean_, variance_;  ///< along each axis
};

}  // namespace pellucid
