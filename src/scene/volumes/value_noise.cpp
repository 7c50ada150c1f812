// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/internal/value_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <span>
#include <variant>

#include "blocks/voxel_edges.h"
#include "looks/value_sample.h"
#include "pellucid/scene/volume.h"

namespace pellucid {
namespace {

constexpr std::size_t value_bins = 256;
/// Bins of differences: none, then steps of a quarter of a factor of 2 below twice the range.
constexpr int per_octave = 4, octaves = 42;
constexpr std::size_t difference_bins = 1 + per_octave * octaves;
/// Counts are those of mixed differences, then of gradients, then the sums of the values.
constexpr std::size_t gradients = value_bins * difference_bins, sums = 2 * gradients;

std::size_t difference_bin(double share) {
  if (!(share > 0)) return 0;
  const double above = per_octave * (std::log2(share) + octaves - 2);
  return 1 +
         static_cast<std::size_t>(std::clamp(above, 0.0, static_cast<double>(difference_bins - 2)));
}

/// The differences at one place; none where a neighbor is missing.
class Place {
 public:
  template <class Value>
  Place(std::span<const Value> data, std::size_t index, const std::array<int, 3>& dimensions)
      : value_(static_cast<double>(data[index])) {
    std::array<std::size_t, 3> step{};  // 0: a single value
    std::size_t next = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto n = static_cast<std::size_t>(dimensions[a]);
      const std::size_t at = index / next % n;
      if (n > 1) {
        if (at == 0 || at + 1 == n) return;
        step[a] = next;
      }
      next *= n;
    }
    const auto at = [&](std::size_t i) { return static_cast<double>(data[i]); };
    const auto second = [&](std::size_t i, std::size_t s) {
      return at(i - s) - 2 * at(i) + at(i + s);
    };
    for (std::size_t a = 0; a < 3; ++a) {
      if (step[a] == 0) continue;
      slope_[a] = (at(index + step[a]) - at(index - step[a])) / 2;
      const std::size_t b = (a + 1) % 3;
      if (step[b] == 0) continue;
      mixed_[a] = std::abs(second(index - step[b], step[a]) - 2 * second(index, step[a]) +
                           second(index + step[b], step[a]));
    }
    is_whole_ = !std::isnan(value_ + slope_[0] + slope_[1] + slope_[2]) &&
                std::ranges::none_of(mixed_, [](const auto& m) { return m && std::isnan(*m); });
  }

  bool is_whole() const { return is_whole_; }
  double value() const { return value_; }
  /// Returns the magnitudes of the second differences along one axis of those along another.
  const std::array<std::optional<double>, 3>& mixed() const { return mixed_; }
  double gradient(const std::array<double, 3>& scale) const {
    double square = 0;
    for (std::size_t a = 0; a < 3; ++a) square += std::pow(scale[a] * slope_[a], 2);
    return std::sqrt(square);
  }

 private:
  double value_;
  bool is_whole_ = false;
  std::array<std::optional<double>, 3> mixed_{};
  std::array<double, 3> slope_{};
};

/// Returns the mean voxel over the mean step of each axis.
std::array<double, 3> scales(const Volume& volume) {
  std::array<double, 3> step = voxel_edges(volume);
  const double mean = (step[0] + step[1] + step[2]) / 3;
  for (double& s : step) s = s > 0 ? mean / s : 0;
  return step;
}

using Differences = std::array<double, difference_bins>;

double sum_of(std::span<const double> weights) {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

/// Returns the share of the range at a place among the bins of differences.
double share_at(double place) {
  return std::exp2(place / per_octave - octaves + 2);
}

/// Returns a quantile of weighted bins, as a share of the range.
double quantile(const Differences& weights, double share) {
  double left = share * sum_of(weights);
  for (std::size_t i = 0; i < difference_bins; ++i) {
    if (left > weights[i]) {
      left -= weights[i];
    } else {
      return i > 0 && weights[i] > 0 ? share_at(static_cast<double>(i - 1) + left / weights[i]) : 0;
    }
  }
  return 0;
}

}  // namespace

ValueNoise::ValueNoise(const Volume& volume)
    : lower_(volume.statistics().minimum),
      upper_(volume.statistics().maximum),
      counts_(sums + value_bins, 0.0) {
  const double range = upper_ - lower_;
  if (!(range > 0)) return;
  const std::array<double, 3> scale = scales(volume);
  const auto add = [&](const Place& place) {
    if (!place.is_whole()) return;
    const auto bin = static_cast<std::size_t>(std::clamp(
        (place.value() - lower_) / range * value_bins, 0.0, static_cast<double>(value_bins - 1)));
    double* const mixed = counts_.data() + bin * difference_bins;
    for (const auto& difference : place.mixed()) {
      if (difference) mixed[difference_bin(*difference / range)] += 1;
    }
    mixed[gradients + difference_bin(place.gradient(scale) / range)] += 1;
    counts_[sums + bin] += (place.value() - lower_) / range;
  };
  std::visit(
      [&](const auto& values) {
        const std::span data(values.data(), values.size());
        visit_even_places(data.size(), [&](std::size_t index) {
          add(Place(data, index, volume.description().dimensions));
        });
      },
      volume.data());
}

TypicalNoise ValueNoise::where_absorbs(const TransferFunction* function) const {
  const double range = upper_ - lower_;
  if (!(range > 0)) return {};
  Differences mixed{}, gradient{};
  const auto add = [&](std::size_t bin, double weight) {
    const double* const from = counts_.data() + bin * difference_bins;
    for (std::size_t d = 0; d < difference_bins && weight > 0; ++d) {
      mixed[d] += weight * from[d];
      gradient[d] += weight * from[gradients + d];
    }
  };
  const auto add_all = [&](const auto& weight) {
    for (std::size_t bin = 0; bin < value_bins; ++bin) {
      const double count =
          sum_of(std::span(counts_).subspan(gradients + bin * difference_bins, difference_bins));
      if (count > 0) add(bin, weight(lower_ + range * (counts_[sums + bin] / count)));
    }
  };
  if (function != nullptr) {
    add_all([&](double mean) { return function->view<double>().evaluate(mean).extinction; });
  }
  if (!(sum_of(mixed) > 0)) add_all([](double) { return 1.0; });
  const auto least = std::find_if(mixed.begin() + 1, mixed.end(), [](double w) { return w > 0; });
  const double step =
      least == mixed.end() ? 0 : share_at(static_cast<double>(least - mixed.begin() - 1));
  // Of rounding to multiples of one step: 1/√12.
  constexpr double of_rounding = 0.29;
  return {range * std::max(quantile(mixed, 0.5) / 4, of_rounding * step),
          range * quantile(gradient, 0.98), range * quantile(gradient, 0.5)};
}

}  // namespace pellucid
