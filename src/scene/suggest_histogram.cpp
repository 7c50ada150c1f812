// SPDX-License-Identifier: Apache-2.0
#include "suggest_histogram.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pellucid {

HistogramAxis core_axis(const Channels& channels, int channel, int bins,
                        const ParallelFor& parallel) {
  const HistogramAxis fine = histogram_axis(*channels[channel].volume, 1 << 16);
  const JointHistogram h = joint_histogram(channels, {channel}, {fine}, parallel);
  std::uint64_t all = 0;
  for (const std::uint64_t c : h.count) all += c;
  const std::uint64_t tail = all / 2000;
  std::uint64_t below = 0, above = 0;
  int first = 0, last = fine.bins - 1;
  while (first < last && (below += h.count[static_cast<std::size_t>(first)]) <= tail) ++first;
  while (last > first && (above += h.count[static_cast<std::size_t>(last)]) <= tail) --last;
  // What is left of rarer data than that is kept: a thin vessel in a large box.
  if (first == last) return histogram_axis(*channels[channel].volume, bins);
  return {fine.edge(first), fine.edge(last + 1), std::min(bins, last + 1 - first)};
}

std::vector<double> bin_coordinates(const JointHistogram& histogram, std::size_t place) {
  std::vector<double> coordinates;
  for (const HistogramAxis& axis : histogram.axes) {
    const auto bins = static_cast<std::size_t>(axis.bins);
    coordinates.push_back(static_cast<double>(place % bins) + 0.5);
    place /= bins;
  }
  return coordinates;
}

double value_at(const HistogramAxis& axis, double coordinate) {
  return axis.lower + coordinate / axis.bins * (axis.upper - axis.lower);
}

double least_variance(const HistogramAxis& axis) {
  return std::min(0.5, 0.0025 * axis.bins * axis.bins);
}

BackgroundBin::BackgroundBin(const JointHistogram& histogram) {
  const auto mode = std::max_element(histogram.count.begin(), histogram.count.end());
  mean_ = bin_coordinates(histogram, static_cast<std::size_t>(mode - histogram.count.begin()));
  const std::size_t n = mean_.size();
  for (const HistogramAxis& axis : histogram.axes) variance_.push_back(least_variance(axis));
  constexpr double widest = 0.05;
  constexpr int steps = 30;
  for (int step = 0; step < steps; ++step) {
    double sum = 0;
    std::vector<double> first(n, 0.0), second(n, 0.0);
    for (std::size_t b = 0; b < histogram.count.size(); ++b) {
      if (histogram.count[b] == 0) continue;
      const std::vector<double> x = bin_coordinates(histogram, b);
      if (!holds(x)) continue;
      const auto count = static_cast<double>(histogram.count[b]);
      sum += count;
      for (std::size_t k = 0; k < n; ++k) {
        first[k] += count * (x[k] - mean_[k]);
        second[k] += count * (x[k] - mean_[k]) * (x[k] - mean_[k]);
      }
    }
    for (std::size_t k = 0; k < n; ++k) {
      const double shift = first[k] / sum, most = widest * histogram.axes[k].bins;
      const double least = least_variance(histogram.axes[k]);
      mean_[k] += shift;
      variance_[k] =
          std::clamp(second[k] / sum - shift * shift, least, std::max(least, most * most));
    }
  }
}

bool BackgroundBin::holds(const std::vector<double>& coordinates, double deviations) const {
  double square = 0;
  for (std::size_t k = 0; k < mean_.size(); ++k) {
    square += (coordinates[k] - mean_[k]) * (coordinates[k] - mean_[k]) / variance_[k];
  }
  return square <= deviations * deviations;
}

}  // namespace pellucid
