// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "benchmarks/frames/report.h"

namespace pellucid::bench {

/// A scene of a series at the number that grows or shrinks along it.
struct SeriesPoint {
  double at = 0;
  SceneResult result;
};

/// Scenes that differ in one number.
struct Series {
  std::string name;
  std::vector<SeriesPoint> points;
};

/// Time of the best sampler over that of exact at an equal largest error.
struct TimeRatio {
  bool known = false;     ///< exact reaches the error and a sampler was measured
  bool at_least = false;  ///< no sampler reaches it: the ratio of the longest that was tried
  double value = 0;
};
TimeRatio sampler_over_exact(const SceneResult& result, double error);

/// A sentence for each of the compared errors: where along the series, from wide to narrow,
/// sampling stops being the faster one.
std::string crossings(const Series& widths);
/// That ratio over the width.
Plot ratio_plot(const Series& widths);

/// Time of exact and of the best sampler to an error, by number; a pair of columns for each series.
/// All have the same numbers.
std::string counts_table(const std::string& number, const std::vector<Series>& list, double error);
Plot counts_plot(const std::string& number, const std::vector<Series>& list, double error);

}  // namespace pellucid::bench
