// SPDX-License-Identifier: Apache-2.0
#include "suggest_histogram.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pellucid {

HistogramAxis core_axis(const Volume& whole, const ChannelSample& sample, int channel, int bins,
                        const ParallelFor& parallel) {
  const HistogramAxis fine = histogram_axis(whole, 1 << 16);
  const JointHistogram h = joint_histogram(sample.channels, {channel}, {fine}, parallel);
  std::uint64_t all = 0;
  for (const std::uint64_t c : h.count) all += c;
  const std::uint64_t tail = all / 2000;
  std::uint64_t below = 0, above = 0;
  int first = 0, last = fine.bins - 1;
  while (first < last && (below += h.count[static_cast<std::size_t>(first)]) <= tail) ++first;
  while (last > first && (above += h.count[static_cast<std::size_t>(last)]) <= tail) --last;
  // What is left of rarer data than that is kept: a thin vessel in a large box.
  if (first == last) return histogram_axis(whole, bins);
  return {fine.edge(first), fine.edge(last + 1), std::min(bins, last + 1 - first)};
}

OccupiedBins occupied_bins(const JointHistogram& histogram) {
  OccupiedBins bins;
  bins.axes = histogram.axes.size();
  std::vector<double> x(bins.axes);
  for (std::size_t b = 0; b < histogram.count.size(); ++b) {
    if (histogram.count[b] == 0) continue;
    bin_coordinates(histogram.axes, b, x.data());
    bins.coordinates.insert(bins.coordinates.end(), x.begin(), x.end());
    bins.counts.push_back(static_cast<double>(histogram.count[b]));
  }
  return bins;
}

void bin_coordinates(const std::vector<HistogramAxis>& axes, std::size_t place,
                     double* coordinates) {
  for (const HistogramAxis& axis : axes) {
    const auto bins = static_cast<std::size_t>(axis.bins);
    *coordinates++ = static_cast<double>(place % bins) + 0.5;
    place /= bins;
  }
}

double value_at(const HistogramAxis& axis, double coordinate) {
  return axis.lower + coordinate / axis.bins * (axis.upper - axis.lower);
}

double least_variance(const HistogramAxis& axis) {
  return std::min(0.5, 0.0025 * axis.bins * axis.bins);
}

BackgroundBin::BackgroundBin(const OccupiedBins& bins, const std::vector<HistogramAxis>& axes) {
  const auto mode = std::max_element(bins.counts.begin(), bins.counts.end());
  const double* const middle = bins[static_cast<std::size_t>(mode - bins.counts.begin())];
  const std::size_t n = bins.axes;
  mean_.assign(middle, middle + n);
  for (const HistogramAxis& axis : axes) variance_.push_back(least_variance(axis));
  constexpr double widest = 0.05;
  constexpr int steps = 30;
  for (int step = 0; step < steps; ++step) {
    double sum = 0;
    std::vector<double> first(n, 0.0), second(n, 0.0);
    for (std::size_t b = 0; b < bins.size(); ++b) {
      const double* const x = bins[b];
      if (!holds(x)) continue;
      sum += bins.counts[b];
      for (std::size_t k = 0; k < n; ++k) {
        first[k] += bins.counts[b] * (x[k] - mean_[k]);
        second[k] += bins.counts[b] * (x[k] - mean_[k]) * (x[k] - mean_[k]);
      }
    }
    const std::vector<double> mean_before = mean_, variance_before = variance_;
    for (std::size_t k = 0; k < n; ++k) {
      const double shift = first[k] / sum, most = widest * axes[k].bins;
      const double least = least_variance(axes[k]);
      mean_[k] += shift;
      variance_[k] =
          std::clamp(second[k] / sum - shift * shift, least, std::max(least, most * most));
    }
    if (mean_ == mean_before && variance_ == variance_before) break;
  }
}

bool BackgroundBin::holds(const double* coordinates, double deviations) const {
  double square = 0;
  for (std::size_t k = 0; k < mean_.size(); ++k) {
    square += (coordinates[k] - mean_[k]) * (coordinates[k] - mean_[k]) / variance_[k];
  }
  return square <= deviations * deviations;
}

}  // namespace pellucid
