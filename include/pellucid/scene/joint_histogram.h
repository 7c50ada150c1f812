// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "pellucid/scene/channels.h"

namespace pellucid {

/// Limits of what is counted: axes of a histogram, and bins of all of them together.
inline constexpr int max_histogram_axes = 3;
inline constexpr int max_histogram_bins = 1 << 24;

/// Equal bins between two values; the last one holds the upper end.
struct HistogramAxis {
  double lower = 0, upper = 1;
  int bins = 1;

  /// Where bin i begins, and bin i - 1 ends; 0 <= i <= bins.
  double edge(int i) const noexcept;
  double center(int i) const noexcept;
  double bin_width() const noexcept { return (upper - lower) / bins; }
  /// The bin of a value; -1 outside and for NaN.
  int bin(double value) const noexcept;
};

/// An axis over all finite values of the volume. Data of an integer type has its edges half-way
/// between integers and bins of a whole number of them, all of one size, as many as are needed but
/// at most `bins`; the other types have `bins`. Around a single value the axis reaches half of its
/// magnitude to both sides, 1/2 around 0; without any it is [0, 1]. Throws Error where bins is not
/// from 1 to max_histogram_bins.
HistogramAxis histogram_axis(const Volume& volume, int bins);

/// How often values occur together at the data points of channels.
struct JointHistogram {
  std::vector<HistogramAxis> axes;   ///< one for each channel looked at
  std::vector<std::uint64_t> count;  ///< of all combinations of bins, the first axis fastest
  std::uint64_t nan = 0;             ///< places where one of the channels is NaN
  std::uint64_t outside = 0;         ///< other places where a value is beyond its axis
};

/// Counts, exactly, the values of the channels `which` (indices, which may repeat) at all data
/// points, in parallel where it is told how; the result is the same for any number of threads.
/// Throws Error where there are not from 1 to max_histogram_axes of them with an axis each, an
/// index is out of range, an axis is empty (lower < upper, bins >= 1), or there are more than
/// max_histogram_bins in all.
JointHistogram joint_histogram(const Channels& channels, const std::vector<int>& which,
                               const std::vector<HistogramAxis>& axes,
                               const ParallelFor& parallel = {});

}  // namespace pellucid
