// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/suggest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "pellucid/scene/error.h"
#include "pellucid/scene/mixture_fit.h"
#include "readable_numbers.h"
#include "suggest_histogram.h"
#include "suggest_look.h"
#include "value_peaks.h"

namespace pellucid {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error("suggest: " + what);
}

void check_channel(const Channels& channels, int c) {
  if (c >= 0 && c < channels.count()) return;
  fail("it looks at channel " + std::to_string(c) + ", but there are " +
       std::to_string(channels.count()) + ", counted from 0");
}

std::uint64_t counted(const JointHistogram& h) {
  std::uint64_t all = 0;
  for (const std::uint64_t count : h.count) all += count;
  return all;
}

JointHistogram core_histogram(const Channels& channels, const std::vector<int>& which, int bins,
                              const ParallelFor& parallel) {
  std::vector<HistogramAxis> axes;
  axes.reserve(which.size());
  for (const int c : which) axes.push_back(core_axis(channels, c, bins, parallel));
  JointHistogram h = joint_histogram(channels, which, axes, parallel);
  if (counted(h) == 0) {
    fail("no data point has a number in every channel; choose channels that have");
  }
  return h;
}

/// K of coordinates in bins as that of values. Bins may be too narrow for a number to hold.
std::vector<std::vector<double>> of_values(std::vector<std::vector<double>> matrix,
                                           const std::vector<HistogramAxis>& axes) {
  for (auto& row : matrix) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (row[i] != 0)
        row[i] = std::clamp(row[i] / axes[i].bin_width(), -largest_data_value, largest_data_value);
    }
  }
  return matrix;
}

/// Of the materials and boundaries of a channel and its gradient magnitude, in bins.
class Boundaries {
 public:
  explicit Boundaries(const JointHistogram& histogram)
      : h_(histogram),
        values_(static_cast<std::size_t>(h_.axes[0].bins)),
        gradients_(static_cast<std::size_t>(h_.axes[1].bins)),
        small_(std::max<std::size_t>(1, gradients_ / 8)),
        all_(static_cast<double>(counted(h_))) {}

  std::vector<ValuePeak> materials() const {
    std::vector<double> counts(values_, 0.0);
    for (std::size_t j = 0; j < small_; ++j) {
      for (std::size_t i = 0; i < values_; ++i) counts[i] += count(i, j);
    }
    constexpr double least_prominence = 0.3, least_share = 5e-4;
    return value_peaks(counts, 0.008 * h_.axes[0].bins, least_prominence, least_share);
  }

  /// The gradients between two materials where they are the most common; no count where hardly any
  /// value is there.
  ValuePeak ridge(const ValuePeak& lower, const ValuePeak& upper) const {
    const double middle = (lower.center + upper.center) / 2;
    const double reach = (upper.center - lower.center) / 8 + 0.5;
    std::vector<double> counts(gradients_, 0.0);
    double sum = 0;
    for (std::size_t i = 0; i < values_; ++i) {
      if (std::abs(static_cast<double>(i) + 0.5 - middle) > reach) continue;
      // Where gradients are the smallest there may be more of other materials than of boundaries.
      for (std::size_t j = small_ / 2; j < gradients_; ++j) sum += counts[j] += count(i, j);
    }
    constexpr double least_prominence = 0.1, least_share = 0.1, least_of_all = 2e-4;
    const auto ridges = value_peaks(counts, 0.012 * h_.axes[1].bins, least_prominence, least_share);
    if (ridges.empty() || sum < least_of_all * all_) return {};
    return *std::max_element(ridges.begin(), ridges.end(),
                             [](const auto& a, const auto& b) { return a.count < b.count; });
  }

  /// A primitive with its center and widths in bins.
  GaussianPrimitive primitive(const std::vector<int>& which, std::array<double, 2> center,
                              std::array<double, 2> widths) const {
    const HistogramAxis &v = h_.axes[0], &g = h_.axes[1];
    return {which,
            {value_at(v, center[0]), value_at(g, center[1])},
            of_values(matrix_from_widths({widths[0], widths[1]}), h_.axes),
            0,
            {}};
  }
  double small_gradients() const { return static_cast<double>(small_); }

 private:
  double count(std::size_t i, std::size_t j) const {
    return static_cast<double>(h_.count[j * values_ + i]);
  }

  const JointHistogram& h_;
  std::size_t values_, gradients_;
  std::size_t small_;  ///< gradients below this bin are those inside of materials
  double all_;
};

/// A normal distribution in bins as a primitive.
GaussianPrimitive primitive_of(const NormalComponent& component, const std::vector<int>& which,
                               const std::vector<HistogramAxis>& axes) {
  GaussianPrimitive primitive;
  primitive.channels = which;
  // Whole covariances overlap so much that the colors of neighbours mix everywhere.
  constexpr double kept = 0.5;
  std::vector<std::vector<double>> covariance = component.covariance;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    primitive.center.push_back(value_at(axes[i], component.mean[i]));
    for (double& x : covariance[i]) x *= kept;
  }
  primitive.matrix = of_values(matrix_from_covariance(covariance), axes);
  return primitive;
}

/// Of data without anything but background: seen through and through.
std::vector<GaussianPrimitive> haze(const Channels& channels, const std::vector<int>& which,
                                    const JointHistogram& h, const BackgroundBin& background) {
  NormalComponent all{1, background.mean(), {}};
  for (const HistogramAxis& axis : h.axes) {
    all.covariance.emplace_back(h.axes.size(), 0.0);
    all.covariance.back()[all.covariance.size() - 1] = axis.bins * axis.bins / 16.0;
  }
  return with_look({{primitive_of(all, which, h.axes), 1}}, channels, which, h, nullptr);
}

}  // namespace

std::vector<GaussianPrimitive> suggest_boundaries(const Channels& channels, int value,
                                                  int gradient_magnitude,
                                                  const ParallelFor& parallel) {
  check_channel(channels, value);
  check_channel(channels, gradient_magnitude);
  const std::vector<int> which{value, gradient_magnitude};
  constexpr int bins = 256;
  const JointHistogram h = core_histogram(channels, which, bins, parallel);
  const BackgroundBin background(h);
  const Boundaries boundaries(h);
  const std::vector<ValuePeak> materials = boundaries.materials();
  if (materials.size() < 2) return suggest_mixture(channels, which, 0, parallel);

  const auto air = std::min_element(materials.begin(), materials.end(),
                                    [&](const ValuePeak& a, const ValuePeak& b) {
                                      return std::abs(a.center - background.mean()[0]) <
                                             std::abs(b.center - background.mean()[0]);
                                    });
  std::vector<Shape> shapes;
  for (auto m = materials.begin(); m != materials.end(); ++m) {
    const auto next = m + 1;
    if (m != air) {
      double width = m->width;
      constexpr double apart = 0.35;  // of the way to the neighbours
      if (m != materials.begin()) width = std::min(width, apart * (m->center - (m - 1)->center));
      if (next != materials.end()) width = std::min(width, apart * (next->center - m->center));
      shapes.push_back(
          {boundaries.primitive(which, {m->center, 0}, {width, boundaries.small_gradients()}),
           0.35});
    }
    if (next == materials.end()) continue;
    const ValuePeak ridge = boundaries.ridge(*m, *next);
    if (!(ridge.count > 0)) continue;
    shapes.push_back(
        {boundaries.primitive(which, {(m->center + next->center) / 2, ridge.center},
                              {(next->center - m->center) / 3,
                               std::clamp(ridge.width, 0.25 * ridge.center, 0.45 * ridge.center)}),
         0.8});
  }
  return with_look(std::move(shapes), channels, which, h, &background);
}

std::vector<GaussianPrimitive> suggest_mixture(const Channels& channels,
                                               const std::vector<int>& which, int primitives,
                                               const ParallelFor& parallel) {
  const std::size_t n = which.size();
  if (n < 1 || n > static_cast<std::size_t>(max_suggested_channels)) {
    fail("it looks at " + std::to_string(n) + " channels, but can look at 1 to 3; choose those");
  }
  for (std::size_t i = 0; i < n; ++i) {
    check_channel(channels, which[i]);
    if (std::find(which.begin(), which.begin() + static_cast<std::ptrdiff_t>(i), which[i]) !=
        which.begin() + static_cast<std::ptrdiff_t>(i)) {
      fail("it looks at channel " + std::to_string(which[i]) + " twice; name each once");
    }
  }
  if (primitives < 0 || primitives > max_suggested_primitives) {
    fail("primitives is " + std::to_string(primitives) + ", but must be from 1 to " +
         std::to_string(max_suggested_primitives) + ", or 0 for as many as are found");
  }
  constexpr std::array<int, max_suggested_channels> bins{256, 96, 40};
  const JointHistogram h = core_histogram(channels, which, bins[n - 1], parallel);
  const BackgroundBin background(h);

  WeightedPoints points;
  points.dimensions = static_cast<int>(n);
  for (std::size_t b = 0; b < h.count.size(); ++b) {
    if (h.count[b] == 0) continue;
    const std::vector<double> x = bin_coordinates(h, b);
    // A few values further out than three deviations would make a component of their own.
    constexpr double far_out = 4.5;
    if (background.holds(x, far_out)) continue;
    points.coordinates.insert(points.coordinates.end(), x.begin(), x.end());
    points.weights.push_back(std::sqrt(static_cast<double>(h.count[b])));
  }
  // More than these are hard to tell apart, and the criterion would have as many as it may: no
  // tissue is normally distributed.
  constexpr int most_found = 5;
  if (points.weights.empty()) return haze(channels, which, h, background);
  std::vector<double> floor;
  for (const HistogramAxis& axis : h.axes) floor.push_back(least_variance(axis));
  const MixtureFit fit = primitives > 0 ? fit_mixture(points, primitives, floor)
                                        : fit_mixture(points, 1, most_found, floor);
  std::vector<Shape> shapes;
  for (const NormalComponent& component : fit.components) {
    shapes.push_back({primitive_of(component, which, h.axes), 0.7});
  }
  return with_look(std::move(shapes), channels, which, h, &background);
}

}  // namespace pellucid
