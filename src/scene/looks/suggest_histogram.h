// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "channel_sample.h"
#include "pellucid/scene/joint_histogram.h"

namespace pellucid {

/// Returns an axis over the values of a channel of a sample without the outermost 0.05 % at either
/// end, which would take the range for themselves. `whole`: the data of that channel.
HistogramAxis core_axis(const Volume& whole, const ChannelSample& sample, int channel, int bins,
                        const ParallelFor& parallel);

/// Bins of a histogram that hold something, in the order of their places.
struct OccupiedBins {
  std::size_t axes = 1;
  /// `axes` numbers per bin, in bins: the middle of a bin is at a half.
  std::vector<double> coordinates;
  std::vector<double> counts;

  std::size_t size() const noexcept { return counts.size(); }
  const double* operator[](std::size_t i) const noexcept { return &coordinates[i * axes]; }
};

OccupiedBins occupied_bins(const JointHistogram& histogram);

/// Writes the coordinates, one per axis, of the bin at this place of a histogram's counts, in bins.
void bin_coordinates(const std::vector<HistogramAxis>& axes, std::size_t place,
                     double* coordinates);
/// Coordinates in bins as values.
double value_at(const HistogramAxis& axis, double coordinate);

/// Returns the least variance that is told from none, in bins: half a bin, less on axes of few of
/// them, whose neighbours are different things.
double least_variance(const HistogramAxis& axis);

/// Background, which fills the most of the volume: the bins about that of the largest count, grown
/// from that bin until it holds what is within three standard deviations, but no further than a
/// twentieth of an axis to a standard deviation.
class BackgroundBin {
 public:
  BackgroundBin(const OccupiedBins& bins, const std::vector<HistogramAxis>& axes);

  /// Returns whether coordinates in bins, one per axis, are within so many standard deviations.
  bool holds(const double* coordinates, double deviations = 3) const;
  /// Returns the mean, in bins.
  const std::vector<double>& mean() const noexcept { return mean_; }

 private:
  std::vector<double> mean_, variance_;  ///< along each axis
};

}  // namespace pellucid
