// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "pellucid/scene/channels.h"

namespace pellucid {

/// Limits of a histogram: number of axes, and number of bins of all axes together.
inline constexpr int max_histogram_axes = 3;
inline constexpr int max_histogram_bins = 1 << 24;

/// Equal bins between two values. The last bin includes the upper end.
struct HistogramAxis {
  double lower = 0, upper = 1;
  int bins = 1;

  /// Returns the lower edge of bin i, which is the upper edge of bin i - 1; 0 <= i <= bins.
  double edge(int i) const noexcept;
  /// Returns the center of bin i.
  double center(int i) const noexcept;
  double bin_width() const noexcept { return (upper - lower) / bins; }
  /// Returns the bin of a value; -1 outside of the axis and for NaN.
  int bin(double value) const noexcept {
    if (!(value >= lower && value <= upper)) return -1;
    const double place = (value - lower) / (upper - lower) * bins;
    return std::min(static_cast<int>(place), bins - 1);
  }
};

/// Tells whether the values are of an integer type.
bool has_whole_numbers(const Volume& volume) noexcept;

/// Returns an axis over all finite values of the volume.
///
/// For integer types the edges lie half-way between integers and all bins are the same whole number
/// of integers wide; there are as many bins as needed, at most `bins`. Other types get exactly
/// `bins`. If the data have a single value, the axis extends half of its magnitude to both sides,
/// 1/2 if it is 0; if there is no finite value the axis is [0, 1]. Throws Error if `bins` is not in
/// [1, max_histogram_bins].
HistogramAxis histogram_axis(const Volume& volume, int bins);

/// Counts how often combinations of values occur at the data points of several channels.
struct JointHistogram {
  std::vector<HistogramAxis> axes;   ///< one per selected channel
  std::vector<std::uint64_t> count;  ///< per combination of bins, the first axis fastest
  std::uint64_t nan = 0;             ///< data points with NaN in a selected channel
  std::uint64_t outside = 0;         ///< other data points with a value outside of its axis
};

/// Counts exactly the values of the channels `which` (indices, which may repeat) at all data
/// points, in parallel if `parallel` is given. The result does not depend on the number of threads.
///
/// Throws Error if there are not from 1 to max_histogram_axes channels with one axis each, an index
/// is out of range, an axis is empty (it needs lower < upper and bins >= 1), or all axes together
/// have more than max_histogram_bins bins.
JointHistogram joint_histogram(const Channels& channels, const std::vector<int>& which,
                               const std::vector<HistogramAxis>& axes,
                               const ParallelFor& parallel = {});

}  // namespace pellucid
