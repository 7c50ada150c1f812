// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/internal/mixture_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "mixture_cells.h"
#include "mixture_step.h"
#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

using Matrix = std::vector<std::vector<double>>;

[[noreturn]] void refuse_mixture(const std::string& what) {
  throw Error("mixture: " + what);
}

void check(const WeightedPoints& points, int components, const std::vector<double>& floor) {
  if (points.dimensions < 1 || floor.size() != static_cast<std::size_t>(points.dimensions) ||
      points.coordinates.size() != points.count() * floor.size()) {
    refuse_mixture(
        "sizes do not agree; give `dimensions` coordinates per weight and as many floors");
  }
  if (components < 1 || components > max_components) {
    refuse_mixture("it has " + std::to_string(components) +
                   " components, but must have from 1 to " + std::to_string(max_components));
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  const auto at_least_zero = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!std::all_of(points.coordinates.begin(), points.coordinates.end(), finite) ||
      !std::all_of(points.weights.begin(), points.weights.end(), at_least_zero)) {
    refuse_mixture(
        "a coordinate is not finite, or a weight not a number >= 0; leave such points out");
  }
  if (!std::all_of(floor.begin(), floor.end(),
                   [](double x) { return x > 0 && std::isfinite(x); })) {
    refuse_mixture("a floor is not a positive number");
  }
  if (!std::any_of(points.weights.begin(), points.weights.end(), [](double w) { return w > 0; })) {
    refuse_mixture("no point has a weight; give some data");
  }
}

/// Runs body(i) for 0 <= i < count, each at most once at a time on a thread.
void for_each_task(const ParallelFor& parallel, int count, const std::function<void(int)>& body) {
  // Less work than this is not split.
  constexpr int grain = 64;
  parallel_or_serial(parallel)(count * grain, [&](int first, int last) {
    for (int i = (first + grain - 1) / grain; i * grain < last; ++i) body(i);
  });
}

/// Fits mixtures of several numbers of components to the same points.
class Fitter {
 public:
  Fitter(const WeightedPoints& points, const std::vector<double>& floor)
      : points_(cells_of(points)),
        cells_(merged_cells(points_, max_cells)),
        floor_(floor),
        n_(floor.size()),
        variance_(variance_of_all()) {
    for (const double w : points_.weight) total_ += w;
  }

  /// Returns the best fit of least, least + 1, …, most components each.
  std::vector<MixtureFit> fits(int least, int most, const ParallelFor& parallel) const {
    const int numbers = most - least + 1;
    // The largest first, as it takes longest.
    const auto components = [&](int i) { return most - i; };
    std::vector<std::array<MixtureFit, ways>> started(static_cast<std::size_t>(numbers));
    for_each_task(parallel, numbers * ways, [&](int task) {
      const int number = task / ways, way = task % ways;
      MixtureFit& fit = started[static_cast<std::size_t>(number)][static_cast<std::size_t>(way)];
      fit = start(components(number), way);
      for (int i = 0; i < first_steps; ++i) take_mixture_step(cells_, floor_, fit);
    });
    std::vector<MixtureFit> fits(static_cast<std::size_t>(numbers));
    for_each_task(parallel, numbers, [&](int number) {
      const auto& candidates = started[static_cast<std::size_t>(number)];
      MixtureFit fit = *std::ranges::max_element(candidates, {}, &MixtureFit::log_likelihood);
      converge(cells_, most_steps, fit);
      // From cells to points there is not far to go.
      if (!cells_.covariance.empty()) converge(points_, most_last_steps, fit);
      finish(fit);
      fits[static_cast<std::size_t>(components(number) - least)] = std::move(fit);
    });
    return fits;
  }

 private:
  static constexpr std::size_t max_cells = 4096;
  static constexpr int ways = 8, first_steps = 24, most_steps = 400, most_last_steps = 20;

  const double* cell(std::size_t i) const { return &cells_.mean[i * n_]; }

  /// Returns the squared distance in units of the floors, so that no dimension counts more by its
  /// unit alone.
  double square_distance(const double* x, const double* y) const {
    double square = 0;
    for (std::size_t k = 0; k < n_; ++k) square += (x[k] - y[k]) * (x[k] - y[k]) / floor_[k];
    return square;
  }

  /// Centers as k-means++ draws them (Arthur and Vassilvitskii 2007), by a sequence that is even
  /// instead of random; covariances of a share of all points.
  MixtureFit start(int components, int way) const {
    std::vector<double> share = cells_.weight;
    double even = way * 0.7548776662466927;  // of the plastic number: apart from the golden one
    MixtureFit fit;
    Matrix spread(n_, std::vector<double>(n_, 0.0));
    const double shrink = std::pow(static_cast<double>(components), -2.0 / static_cast<double>(n_));
    for (std::size_t i = 0; i < n_; ++i) {
      spread[i][i] = std::max(shrink * variance_[i], floor_[i]);
    }
    for (int c = 0; c < components; ++c) {
      double sum = 0;
      for (const double s : share) sum += s;
      if (!(sum > 0)) break;  // all points are centers
      even += 1 / std::numbers::phi;
      even -= std::floor(even);
      double left = even * sum;
      std::size_t chosen = 0;
      for (std::size_t i = 0; i < share.size(); ++i) {
        if (share[i] > 0) chosen = i;
        left -= share[i];
        if (left < 0) break;
      }
      fit.components.push_back({1.0 / components, {cell(chosen), cell(chosen) + n_}, spread});
      for (std::size_t i = 0; i < share.size(); ++i) {
        const double apart = cells_.weight[i] * square_distance(cell(i), cell(chosen));
        share[i] = c == 0 ? apart : std::min(share[i], apart);
      }
    }
    return fit;
  }

  /// Returns the variance of all points along each axis.
  std::vector<double> variance_of_all() const {
    double total = 0;
    for (const double w : points_.weight) total += w;
    std::vector<double> mean(n_, 0.0), variance(n_, 0.0);
    for (std::size_t i = 0; i < points_.count(); ++i) {
      for (std::size_t k = 0; k < n_; ++k) {
        mean[k] += points_.weight[i] / total * points_.mean[i * n_ + k];
      }
    }
    for (std::size_t i = 0; i < points_.count(); ++i) {
      for (std::size_t k = 0; k < n_; ++k) {
        const double apart = points_.mean[i * n_ + k] - mean[k];
        variance[k] += points_.weight[i] / total * apart * apart;
      }
    }
    return variance;
  }

  void converge(const MixtureCells& cells, int most, MixtureFit& fit) const {
    fit.log_likelihood = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < most; ++i) {
      const double before = fit.log_likelihood;
      take_mixture_step(cells, floor_, fit);
      if (std::abs(fit.log_likelihood - before) <= 1e-7 * total_) break;
    }
  }

  void finish(MixtureFit& fit) const {
    std::stable_sort(fit.components.begin(), fit.components.end(),
                     [](const auto& a, const auto& b) { return a.weight > b.weight; });
    const double n = static_cast<double>(n_), m = static_cast<double>(fit.components.size());
    const double parameters = m * (n + n * (n + 1) / 2) + m - 1;
    fit.bic = parameters * std::log(total_) - 2 * fit.log_likelihood;
  }

  MixtureCells points_;
  MixtureCells cells_;  ///< few enough to try many beginnings
  const std::vector<double>& floor_;
  std::size_t n_;
  std::vector<double> variance_;
  double total_ = 0;
};

}  // namespace

MixtureFit fit_mixture(const WeightedPoints& points, int components,
                       const std::vector<double>& floor, const ParallelFor& parallel) {
  check(points, components, floor);
  return Fitter(points, floor).fits(components, components, parallel).front();
}

MixtureFit fit_mixture(const WeightedPoints& points, int least, int most,
                       const std::vector<double>& floor, const ParallelFor& parallel) {
  check(points, least, floor);
  check(points, most, floor);
  if (least > most) refuse_mixture("there is no number from least to most; give least <= most");
  const std::vector<MixtureFit> fits = Fitter(points, floor).fits(least, most, parallel);
  return *std::ranges::min_element(fits, {}, &MixtureFit::bic);
}

}  // namespace pellucid
