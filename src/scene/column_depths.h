// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/joint_histogram.h"

namespace pellucid {

/// What lines along the axes of the grid meet of something whose density in [0, 1] is known.
struct ColumnDepth {
  /// Length of full density along a line that meets it: the mean over the lines, each weighted by
  /// its own. World length.
  double length = 0;
  /// Share of the lines that meet it: (sum of the lengths)² / sum of their squares / lines.
  double share = 0;
};

/// Of each of `count` things, along some thousand lines through data points in all three
/// directions. density[bin · count + k] is that of thing k in a bin of the histogram's (all its
/// axes, the first fastest); outside of it and where a channel is NaN there is nothing.
std::vector<ColumnDepth> column_depths(const Channels& channels, const std::vector<int>& which,
                                       const std::vector<HistogramAxis>& axes,
                                       const std::vector<float>& density, int count);

}  // namespace pellucid
