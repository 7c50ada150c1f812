// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pellucid/scene/joint_histogram.h"

namespace pellucid {

/// Depth of something whose density in [0, 1] is known, along lines along the axes of the grid.
struct ColumnDepth {
  /// Length of full density along a line that meets it: the mean over the lines, each weighted by
  /// its own. World length.
  double length = 0;
  /// Share of the lines that meet it: (sum of the lengths)² / sum of their squares / lines.
  double share = 0;
};

/// Lines through data points in all three directions, and the bins of a joint histogram that they
/// meet: along an axis at most `most_lines` in each of the other two, of at
/// most 256 points each.
class Columns {
 public:
  /// Makes the columns. The axes are those of the channels `which`, whose bins have fewer than 2^31
  /// combinations.
  Columns(const Channels& channels, const std::vector<int>& which,
          const std::vector<HistogramAxis>& axes, int most_lines, const ParallelFor& parallel = {});

  /// Returns the bins that some line meets, as places of the histogram's counts, ascending.
  const std::vector<std::size_t>& bins() const noexcept { return bins_; }

  /// Returns what lines meet of each of `count` things. density[b · count + k] is that of thing k
  /// in bins()[b]; outside of the histogram and where a channel is NaN there is nothing. The result
  /// does not depend on the number of threads.
  std::vector<ColumnDepth> depths(const std::vector<float>& density, int count,
                                  const ParallelFor& parallel = {}) const;

 private:
  /// Lines in one plane of data points.
  struct Slab {
    std::array<std::size_t, 3> stride;  ///< in data: between points, between lines, to the first
    std::array<int, 2> size;            ///< data points along both
    std::array<int, 2> count;           ///< points of a line, lines
    std::size_t first = 0;              ///< in `bin_`
    double step = 0;                    ///< world length between points

    /// Returns the offsets of points along a line (0) or of lines (1).
    std::vector<std::size_t> places(std::size_t along) const;
    /// Returns where the bin of a point is. Points of a line follow each other, or lines of a
    /// point, as they do in the data.
    std::size_t index(int point, int line) const;
  };

  void add_slabs(const Volume& grid, std::size_t axis, int most_lines);
  void find_bins(const Channels& channels, const std::vector<int>& which,
                 const std::vector<HistogramAxis>& axes, const Slab& slab);
  void number_bins(std::size_t all, const ParallelFor& parallel);

  std::vector<Slab> slabs_;
  std::vector<std::int32_t> bin_;  ///< of each point: a position in bins_, or less than 0
  std::vector<std::size_t> bins_;
};

}  // namespace pellucid
