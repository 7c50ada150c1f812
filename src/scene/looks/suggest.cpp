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
#include "pellucid/scene/internal/mixture_fit.h"
#include "readable_numbers.h"
#include "suggest_histogram.h"
#include "suggest_look.h"
#include "value_peaks.h"

namespace pellucid {
namespace {

[[noreturn]] void refuse_suggestion(const std::string& what) {
  throw Error("suggest: " + what);
}

void check_channel(const Channels& channels, int c) {
  if (c >= 0 && c < channels.count()) return;
  refuse_suggestion("it looks at channel " + std::to_string(c) + ", but there are " +
                    std::to_string(channels.count()) + ", counted from 0");
}

/// A tenth of the work is in the survey, half is in a fit.
constexpr double after_survey = 0.15, after_fit = 0.75;

void tell(const SuggestControl& control, double fraction) {
  if (control.progress) control.progress(fraction);
}

/// Returns the largest number of points of a sample. Square roots of counts make the rarest bins
/// matter: a fourth of a brain's points gave other materials than all of them.
std::size_t most_sampled(const SuggestControl& control) {
  return std::size_t{1} << (control.quick ? 16 : 24);
}

int most_lines(const SuggestControl& control) {
  return control.quick ? 24 : 96;
}

/// The joint histogram of some channels, of a sample if there are many data points.
struct Survey {
  JointHistogram histogram;
  OccupiedBins bins;
  double points = 0;  ///< number of data points in the histogram
};

Survey survey(const Channels& channels, const std::vector<int>& which, int bins,
              const ParallelFor& parallel, const SuggestControl& control) {
  tell(control, 0);
  const ChannelSample sample = sample_channels(channels, which, most_sampled(control), parallel);
  std::vector<HistogramAxis> axes;
  std::vector<int> all;
  for (std::size_t i = 0; i < which.size(); ++i) {
    all.push_back(static_cast<int>(i));
    axes.push_back(core_axis(*channels[which[i]].volume, sample, all.back(), bins, parallel));
  }
  Survey survey{joint_histogram(sample.channels, all, axes, parallel), {}};
  for (std::uint64_t& count : survey.histogram.count) count *= sample.period;
  survey.bins = occupied_bins(survey.histogram);
  for (const double count : survey.bins.counts) survey.points += count;
  if (survey.bins.size() == 0) {
    refuse_suggestion("no data point has a number in every channel; choose channels that have");
  }
  tell(control, after_survey);
  return survey;
}

/// Turns K of coordinates in bins into that of values. Bins may be too narrow for a number to hold.
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

/// Search for the materials and boundaries of a channel and its gradient magnitude, in bins.
class Boundaries {
 public:
  explicit Boundaries(const Survey& survey)
      : h_(survey.histogram),
        values_(static_cast<std::size_t>(h_.axes[0].bins)),
        gradients_(static_cast<std::size_t>(h_.axes[1].bins)),
        small_(std::max<std::size_t>(1, gradients_ / 8)),
        all_(survey.points) {}

  std::vector<ValuePeak> materials() const {
    std::vector<double> counts(values_, 0.0);
    for (std::size_t j = 0; j < small_; ++j) {
      for (std::size_t i = 0; i < values_; ++i) counts[i] += count(i, j);
    }
    constexpr double min_prominence = 0.3, min_share = 5e-4;
    return value_peaks(counts, 0.008 * h_.axes[0].bins, min_prominence, min_share);
  }

  /// Returns the gradients between two materials where they are the most common; no count where
  /// hardly any value is there.
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
    constexpr double min_prominence = 0.1, min_share = 0.1, least_of_all = 2e-4;
    const auto ridges = value_peaks(counts, 0.012 * h_.axes[1].bins, min_prominence, min_share);
    if (ridges.empty() || sum < least_of_all * all_) return {};
    return *std::max_element(ridges.begin(), ridges.end(),
                             [](const auto& a, const auto& b) { return a.count < b.count; });
  }

  /// Returns a primitive with its center and widths in bins.
  GaussianPrimitive primitive(const std::vector<int>& which, std::array<double, 2> center,
                              std::array<double, 2> widths) const {
    const HistogramAxis &v = h_.axes[0], &g = h_.axes[1];
    return {{which.begin(), which.end()},
            {value_at(v, center[0]), value_at(g, center[1])},
            of_values(matrix_from_widths({widths[0], widths[1]}), h_.axes),
            0,
            {},
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

/// Returns a normal distribution in bins as a primitive.
GaussianPrimitive primitive_of(const NormalComponent& component, const std::vector<int>& which,
                               const std::vector<HistogramAxis>& axes) {
  GaussianPrimitive primitive;
  primitive.channels.assign(which.begin(), which.end());
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

/// Distance of the background's last values from it, in deviations. A few further out than three
/// would make a component of their own.
constexpr double far_out = 4.5;

/// Returns the bins that are not background, by the square roots of their counts.
WeightedPoints points_besides(const BackgroundBin& background, const OccupiedBins& bins) {
  WeightedPoints points;
  points.dimensions = static_cast<int>(bins.axes);
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (background.holds(bins[b], far_out)) continue;
    points.coordinates.insert(points.coordinates.end(), bins[b], bins[b] + bins.axes);
    points.weights.push_back(std::sqrt(bins.counts[b]));
  }
  return points;
}

std::vector<GaussianPrimitive> looked_at(std::vector<Shape> shapes, const Stage& stage,
                                         const ParallelFor& parallel,
                                         const SuggestControl& control) {
  tell(control, after_fit);
  std::vector<GaussianPrimitive> primitives = with_look(std::move(shapes), stage, parallel);
  tell(control, 1);
  return primitives;
}

/// Returns Gaussians for data with nothing but background, which let all of it be seen.
std::vector<GaussianPrimitive> haze(Stage stage, const ParallelFor& parallel,
                                    const SuggestControl& control) {
  NormalComponent all{1, stage.background->mean(), {}};
  for (const HistogramAxis& axis : stage.axes) {
    all.covariance.emplace_back(stage.axes.size(), 0.0);
    all.covariance.back()[all.covariance.size() - 1] = axis.bins * axis.bins / 16.0;
  }
  stage.background = nullptr;
  return looked_at({{primitive_of(all, stage.which, stage.axes), 1}}, stage, parallel, control);
}

}  // namespace

std::vector<GaussianPrimitive> suggest_boundaries(const Channels& channels, int value,
                                                  int gradient_magnitude,
                                                  const ParallelFor& parallel,
                                                  const SuggestControl& control) {
  check_channel(channels, value);
  check_channel(channels, gradient_magnitude);
  const std::vector<int> which{value, gradient_magnitude};
  constexpr int bins = 256;
  const Survey data = survey(channels, which, bins, parallel, control);
  const BackgroundBin background(data.bins, data.histogram.axes);
  const Boundaries boundaries(data);
  const std::vector<ValuePeak> materials = boundaries.materials();
  if (materials.size() < 2) return suggest_mixture(channels, which, 0, parallel, control);

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
  return looked_at(
      std::move(shapes),
      {channels, which, data.histogram.axes, data.bins, &background, most_lines(control)}, parallel,
      control);
}

std::vector<GaussianPrimitive> suggest_mixture(const Channels& channels,
                                               const std::vector<int>& which, int primitives,
                                               const ParallelFor& parallel,
                                               const SuggestControl& control) {
  const std::size_t n = which.size();
  if (n < 1 || n > static_cast<std::size_t>(max_suggested_channels)) {
    refuse_suggestion("it looks at " + std::to_string(n) +
                      " channels, but can look at 1 to 3; choose those");
  }
  for (std::size_t i = 0; i < n; ++i) {
    check_channel(channels, which[i]);
    if (std::find(which.begin(), which.begin() + static_cast<std::ptrdiff_t>(i), which[i]) !=
        which.begin() + static_cast<std::ptrdiff_t>(i)) {
      refuse_suggestion("it looks at channel " + std::to_string(which[i]) +
                        " twice; name each once");
    }
  }
  if (primitives < 0 || primitives > max_suggested_primitives) {
    refuse_suggestion("primitives is " + std::to_string(primitives) + ", but must be from 1 to " +
                      std::to_string(max_suggested_primitives) + ", or 0 for as many as are found");
  }
  constexpr std::array<int, max_suggested_channels> bins{256, 96, 40};
  const Survey data = survey(channels, which, bins[n - 1], parallel, control);
  const std::vector<HistogramAxis>& axes = data.histogram.axes;
  const BackgroundBin background(data.bins, axes);
  const Stage stage{channels, which, axes, data.bins, &background, most_lines(control)};
  const WeightedPoints points = points_besides(background, data.bins);
  if (points.weights.empty()) return haze(stage, parallel, control);
  std::vector<double> floor;
  floor.reserve(axes.size());
  for (const HistogramAxis& axis : axes) floor.push_back(least_variance(axis));
  // More than these are hard to tell apart, and the criterion would have as many as it may: no
  // tissue is normally distributed.
  const int most_found = control.quick ? 3 : 5;
  const MixtureFit fit = primitives > 0 ? fit_mixture(points, primitives, floor, parallel)
                                        : fit_mixture(points, 1, most_found, floor, parallel);
  std::vector<Shape> shapes;
  for (const NormalComponent& component : fit.components) {
    // A background that is wide, or not normally distributed, leaves a rim.
    constexpr double rim = far_out + 1;
    if (primitives == 0 && background.holds(component.mean.data(), rim)) continue;
    shapes.push_back({primitive_of(component, which, axes), 0.7});
  }
  if (shapes.empty()) shapes.push_back({primitive_of(fit.components.front(), which, axes), 0.7});
  return looked_at(std::move(shapes), stage, parallel, control);
}

}  // namespace pellucid
