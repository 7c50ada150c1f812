// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/mixture_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

using Matrix = std::vector<std::vector<double>>;

[[noreturn]] void fail(const std::string& what) {
  throw Error("mixture: " + what);
}

void check(const WeightedPoints& points, int components, const std::vector<double>& floor) {
  if (points.dimensions < 1 || floor.size() != static_cast<std::size_t>(points.dimensions) ||
      points.coordinates.size() != points.count() * floor.size()) {
    fail("sizes do not agree; give `dimensions` coordinates per weight and as many floors");
  }
  if (components < 1 || components > max_components) {
    fail("it has " + std::to_string(components) + " components, but must have from 1 to " +
         std::to_string(max_components));
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  const auto at_least_zero = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!std::all_of(points.coordinates.begin(), points.coordinates.end(), finite) ||
      !std::all_of(points.weights.begin(), points.weights.end(), at_least_zero)) {
    fail("a coordinate is not finite, or a weight not a number >= 0; leave such points out");
  }
  if (!std::all_of(floor.begin(), floor.end(),
                   [](double x) { return x > 0 && std::isfinite(x); })) {
    fail("a floor is not a positive number");
  }
  if (!std::any_of(points.weights.begin(), points.weights.end(), [](double w) { return w > 0; })) {
    fail("no point has a weight; give some data");
  }
}

/// The log of a normal density times its weight, ready to be evaluated at many points.
class LogDensity {
 public:
  explicit LogDensity(const NormalComponent& c) : mean_(c.mean), inverse_(c.mean.size()) {
    const std::size_t n = mean_.size();
    // Σ = L L^T; row i of `inverse_` is that of L^-1, up to its diagonal.
    Matrix l(n, std::vector<double>(n, 0.0));
    double log_determinant = 0;
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = j; i < n; ++i) {
        double s = c.covariance[i][j];
        for (std::size_t k = 0; k < j; ++k) s -= l[i][k] * l[j][k];
        l[i][j] = i == j ? std::sqrt(s) : s / l[j][j];
      }
      log_determinant += 2 * std::log(l[j][j]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      inverse_[i].assign(i + 1, 0.0);
      for (std::size_t j = 0; j <= i; ++j) {
        double s = i == j ? 1.0 : 0.0;
        for (std::size_t k = j; k < i; ++k) s -= l[i][k] * inverse_[k][j];
        inverse_[i][j] = s / l[i][i];
      }
    }
    constant_ = std::log(c.weight) -
                0.5 * (log_determinant + static_cast<double>(n) * std::log(2 * std::numbers::pi));
  }

  double at(const double* x) const {
    double square = 0;
    for (std::size_t i = 0; i < inverse_.size(); ++i) {
      double p = 0;
      for (std::size_t j = 0; j <= i; ++j) p += inverse_[i][j] * (x[j] - mean_[j]);
      square += p * p;
    }
    return constant_ - 0.5 * square;
  }

 private:
  const std::vector<double>& mean_;
  Matrix inverse_;
  double constant_ = 0;
};

class Fitter {
 public:
  Fitter(const WeightedPoints& points, const std::vector<double>& floor)
      : points_(points), floor_(floor), n_(floor.size()) {
    for (const double w : points.weights) total_ += w;
  }

  MixtureFit best(int components) const {
    std::optional<MixtureFit> likeliest;
    for (int way = 0; way < ways; ++way) {
      MixtureFit fit = start(components, way);
      for (int i = 0; i < first_steps; ++i) step(fit);
      if (!likeliest || fit.log_likelihood > likeliest->log_likelihood) likeliest = std::move(fit);
    }
    for (int i = 0; i < most_steps; ++i) {
      const double before = likeliest->log_likelihood;
      step(*likeliest);
      if (std::abs(likeliest->log_likelihood - before) <= 1e-7 * total_) break;
    }
    finish(*likeliest);
    return *likeliest;
  }

 private:
  static constexpr int ways = 8, first_steps = 12, most_steps = 400;

  const double* point(std::size_t i) const { return &points_.coordinates[i * n_]; }

  /// In units of the floors, so that no dimension counts more by its unit alone.
  double square_distance(const double* x, const double* y) const {
    double square = 0;
    for (std::size_t k = 0; k < n_; ++k) square += (x[k] - y[k]) * (x[k] - y[k]) / floor_[k];
    return square;
  }

  /// Centers as k-means++ draws them (Arthur and Vassilvitskii 2007), by a sequence that is even
  /// instead of random; covariances of a share of all points.
  MixtureFit start(int components, int way) const {
    std::vector<double> share = points_.weights;
    double even = way * 0.7548776662466927;  // of the plastic number: apart from the golden one
    MixtureFit fit;
    Matrix spread = spread_of_all();
    const double shrink = std::pow(static_cast<double>(components), -2.0 / static_cast<double>(n_));
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) spread[i][j] *= i == j ? shrink : 0;
      spread[i][i] = std::max(spread[i][i], floor_[i]);
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
      fit.components.push_back({1.0 / components, {point(chosen), point(chosen) + n_}, spread});
      for (std::size_t i = 0; i < share.size(); ++i) {
        const double apart = points_.weights[i] * square_distance(point(i), point(chosen));
        share[i] = c == 0 ? apart : std::min(share[i], apart);
      }
    }
    return fit;
  }

  Matrix spread_of_all() const {
    std::vector<double> mean(n_, 0.0);
    for (std::size_t i = 0; i < points_.count(); ++i) {
      for (std::size_t k = 0; k < n_; ++k) mean[k] += points_.weights[i] / total_ * point(i)[k];
    }
    Matrix spread(n_, std::vector<double>(n_, 0.0));
    for (std::size_t i = 0; i < points_.count(); ++i) {
      add_square(point(i), mean, points_.weights[i] / total_, spread);
    }
    return spread;
  }

  void add_square(const double* x, const std::vector<double>& mean, double weight,
                  Matrix& covariance) const {
    for (std::size_t j = 0; j < n_; ++j) {
      for (std::size_t k = 0; k <= j; ++k) {
        const double product = weight * (x[j] - mean[j]) * (x[k] - mean[k]);
        covariance[j][k] += product;
        if (k < j) covariance[k][j] += product;
      }
    }
  }

  /// One step of expectation and maximisation; the likelihood is that of the mixture before it.
  void step(MixtureFit& fit) const {
    const std::size_t m = fit.components.size();
    std::vector<LogDensity> density;
    density.reserve(m);
    for (const NormalComponent& c : fit.components) density.emplace_back(c);
    std::vector<double> part(points_.count() * m);
    fit.log_likelihood = 0;
    for (std::size_t i = 0; i < points_.count(); ++i) {
      double* p = &part[i * m];
      double largest = -std::numeric_limits<double>::infinity();
      for (std::size_t c = 0; c < m; ++c) {
        p[c] = density[c].at(point(i));
        largest = std::max(largest, p[c]);
      }
      double sum = 0;
      for (std::size_t c = 0; c < m; ++c) sum += p[c] = std::exp(p[c] - largest);
      for (std::size_t c = 0; c < m; ++c) p[c] *= points_.weights[i] / sum;
      fit.log_likelihood += points_.weights[i] * (largest + std::log(sum));
    }
    maximise(part, fit.components);
  }

  void maximise(const std::vector<double>& part, std::vector<NormalComponent>& components) const {
    const std::size_t m = components.size();
    std::vector<NormalComponent> next;
    for (std::size_t c = 0; c < m; ++c) {
      double sum = 0;
      for (std::size_t i = 0; i < points_.count(); ++i) sum += part[i * m + c];
      if (!(sum > 1e-9 * total_)) continue;  // no point is left to it
      NormalComponent fresh{sum / total_, std::vector<double>(n_, 0.0),
                            Matrix(n_, std::vector<double>(n_, 0.0))};
      for (std::size_t i = 0; i < points_.count(); ++i) {
        for (std::size_t k = 0; k < n_; ++k) fresh.mean[k] += part[i * m + c] / sum * point(i)[k];
      }
      for (std::size_t i = 0; i < points_.count(); ++i) {
        add_square(point(i), fresh.mean, part[i * m + c] / sum, fresh.covariance);
      }
      // The spread inside a bin; it also keeps the matrix positive definite.
      for (std::size_t k = 0; k < n_; ++k) fresh.covariance[k][k] += floor_[k];
      next.push_back(std::move(fresh));
    }
    components = std::move(next);
  }

  void finish(MixtureFit& fit) const {
    std::stable_sort(fit.components.begin(), fit.components.end(),
                     [](const auto& a, const auto& b) { return a.weight > b.weight; });
    const double n = static_cast<double>(n_), m = static_cast<double>(fit.components.size());
    const double parameters = m * (n + n * (n + 1) / 2) + m - 1;
    fit.bic = parameters * std::log(total_) - 2 * fit.log_likelihood;
  }

  const WeightedPoints& points_;
  const std::vector<double>& floor_;
  std::size_t n_;
  double total_ = 0;
};

}  // namespace

MixtureFit fit_mixture(const WeightedPoints& points, int components,
                       const std::vector<double>& floor) {
  check(points, components, floor);
  return Fitter(points, floor).best(components);
}

MixtureFit fit_mixture(const WeightedPoints& points, int least, int most,
                       const std::vector<double>& floor) {
  check(points, least, floor);
  check(points, most, floor);
  std::optional<MixtureFit> best;
  for (int components = least; components <= most; ++components) {
    MixtureFit fit = Fitter(points, floor).best(components);
    if (!best || fit.bic < best->bic) best = std::move(fit);
  }
  if (!best) fail("there is no number from least to most; give least <= most");
  return *best;
}

}  // namespace pellucid
