// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace pellucid::bench {

/// Segments of linear extinction and color, one after another in each list.
struct SegmentList {
  std::vector<double> extinction_f, extinction_b, length;
  std::vector<std::array<double, 3>> color_f, color_b;

  std::size_t size() const noexcept { return length.size(); }
};

/// Premultiplied color and opacity of each.
using SegmentColors = std::vector<std::array<double, 4>>;

/// A list made ready in a kernel's own numbers.
struct PreparedSegments {
  std::function<void()> run;              ///< all segments once
  std::function<SegmentColors()> result;  ///< of the last run
};

/// A way of computing segments.
struct SegmentIntegrator {
  std::string name;
  std::function<PreparedSegments(const SegmentList&)> prepare;
  /// Segments whose extinction · length is above it at an end are not for it.
  double largest_depth = std::numeric_limits<double>::infinity();
};

}  // namespace pellucid::bench
