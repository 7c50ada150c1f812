// SPDX-License-Identifier: Apache-2.0
#include "mixture_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace pellucid {
namespace {

using Matrix = std::vector<std::vector<double>>;

/// log(weight · normal density) as constant - |L⁻¹ (x - mean)|² / 2, where the covariance is L Lᵀ.
struct LogDensity {
  double constant = 0;
  std::vector<double> mean;
  std::vector<double> inverse_root;  ///< L⁻¹, a lower triangle row by row
  /// Σ⁻¹ as a lower triangle with its off-diagonals doubled: its product with a cell's covariance
  /// is the trace.
  std::vector<double> precision;
};

Matrix cholesky(const Matrix& a) {
  const std::size_t n = a.size();
  Matrix l(n, std::vector<double>(n, 0.0));
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = j; i < n; ++i) {
      double s = a[i][j];
      for (std::size_t k = 0; k < j; ++k) s -= l[i][k] * l[j][k];
      // Rounding must not make a narrow matrix indefinite.
      l[i][j] = i == j ? std::sqrt(std::max(s, 1e-14 * a[i][i])) : s / l[j][j];
    }
  }
  return l;
}

Matrix inverse_of_lower(const Matrix& l) {
  const std::size_t n = l.size();
  Matrix inverse(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double s = i == j ? 1.0 : 0.0;
      for (std::size_t k = j; k < i; ++k) s -= l[i][k] * inverse[k][j];
      inverse[i][j] = s / l[i][i];
    }
  }
  return inverse;
}

LogDensity log_density(const NormalComponent& c) {
  const std::size_t n = c.mean.size();
  const Matrix root = cholesky(c.covariance), inverse = inverse_of_lower(root);
  LogDensity density;
  density.mean = c.mean;
  double log_determinant = 0;
  for (std::size_t i = 0; i < n; ++i) {
    log_determinant += 2 * std::log(root[i][i]);
    for (std::size_t j = 0; j <= i; ++j) {
      density.inverse_root.push_back(inverse[i][j]);
      double s = 0;
      for (std::size_t k = i; k < n; ++k) s += inverse[k][i] * inverse[k][j];
      density.precision.push_back(i == j ? s : 2 * s);
    }
  }
  density.constant =
      std::log(c.weight) -
      0.5 * (log_determinant + static_cast<double>(n) * std::log(2 * std::numbers::pi));
  return density;
}

/// Sums over the points of a component: their weights, their distances from its mean, and the
/// products of these (a lower triangle).
struct Moments {
  double weight = 0;
  std::vector<double> first, second;
};

/// Expectation. N: the number of dimensions; 0: known at run time only.
template <std::size_t N>
class Expectation {
 public:
  Expectation(const MixtureCells& cells, const std::vector<LogDensity>& densities)
      : cells_(cells), densities_(densities), distance_(densities.size() * n()) {
    for (std::size_t c = 0; c < densities.size(); ++c) {
      moments_.push_back({0, std::vector<double>(n()), std::vector<double>(triangle_size(n()))});
    }
  }

  /// Adds all cells to the moments. Returns the log-likelihood.
  double run() {
    double log_likelihood = 0;
    for (std::size_t i = 0; i < cells_.count(); ++i) log_likelihood += add(i);
    return log_likelihood;
  }
  const std::vector<Moments>& moments() const noexcept { return moments_; }

 private:
  std::size_t n() const { return N > 0 ? N : cells_.dimensions; }
  const double* covariance(std::size_t cell) const {
    return cells_.covariance.empty() ? nullptr : &cells_.covariance[cell * triangle_size(n())];
  }

  double add(std::size_t cell) {
    const std::size_t m = densities_.size();
    const double* const spread = covariance(cell);
    double largest = -std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < m; ++c) {
      share_[c] = at(c, &cells_.mean[cell * n()], spread);
      largest = std::max(largest, share_[c]);
    }
    // Smaller shares are lost in the rounding of the sums.
    constexpr double least = -37;
    double sum = 0;
    for (std::size_t c = 0; c < m; ++c) {
      const double log_share = share_[c] - largest;
      sum += share_[c] = log_share > least ? std::exp(log_share) : 0;
    }
    const double weight = cells_.weight[cell];
    for (std::size_t c = 0; c < m; ++c) {
      if (share_[c] > 0) add_moments(c, weight * share_[c] / sum, spread);
    }
    return weight * (largest + std::log(sum));
  }

  /// Returns the log-density of component c, the mean over a cell whose covariance is `spread`
  /// (null: none).
  double at(std::size_t c, const double* x, const double* spread) {
    const LogDensity& density = densities_[c];
    double* const d = &distance_[c * n()];
    for (std::size_t k = 0; k < n(); ++k) d[k] = x[k] - density.mean[k];
    const double* entry = density.inverse_root.data();
    double square = 0;
    for (std::size_t i = 0; i < n(); ++i) {
      double p = 0;
      for (std::size_t j = 0; j <= i; ++j) p += *entry++ * d[j];
      square += p * p;
    }
    if (spread != nullptr) {
      for (std::size_t k = 0; k < triangle_size(n()); ++k)
        square += density.precision[k] * spread[k];
    }
    return density.constant - 0.5 * square;
  }

  void add_moments(std::size_t c, double weight, const double* spread) {
    Moments& moments = moments_[c];
    const double* const d = &distance_[c * n()];
    moments.weight += weight;
    double* second = moments.second.data();
    for (std::size_t j = 0; j < n(); ++j) {
      moments.first[j] += weight * d[j];
      for (std::size_t k = 0; k <= j; ++k) *second++ += weight * d[j] * d[k];
    }
    if (spread == nullptr) return;
    for (std::size_t k = 0; k < triangle_size(n()); ++k) moments.second[k] += weight * spread[k];
  }

  const MixtureCells& cells_;
  const std::vector<LogDensity>& densities_;
  std::vector<Moments> moments_;
  std::vector<double> distance_;                ///< of a cell from each mean
  std::array<double, max_components> share_{};  ///< of a cell in each component
};

/// Returns the component that the sums describe: the step of maximisation.
NormalComponent moved(const NormalComponent& before, const Moments& sums, double total,
                      const std::vector<double>& floor) {
  const std::size_t n = floor.size();
  NormalComponent after{sums.weight / total, before.mean, Matrix(n, std::vector<double>(n))};
  std::vector<double> shift(n);
  for (std::size_t k = 0; k < n; ++k) {
    shift[k] = sums.first[k] / sums.weight;
    after.mean[k] += shift[k];
  }
  const double* second = sums.second.data();
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k <= j; ++k) {
      after.covariance[j][k] = after.covariance[k][j] =
          *second++ / sums.weight - shift[j] * shift[k];
    }
    // The spread inside a bin; it also keeps the matrix positive definite.
    after.covariance[j][j] = std::max(after.covariance[j][j], 0.0) + floor[j];
  }
  return after;
}

template <std::size_t N>
void take_step(const MixtureCells& cells, const std::vector<double>& floor, MixtureFit& fit) {
  std::vector<LogDensity> densities;
  for (const NormalComponent& c : fit.components) densities.push_back(log_density(c));
  Expectation<N> expectation(cells, densities);
  fit.log_likelihood = expectation.run();
  double total = 0;
  for (const Moments& m : expectation.moments()) total += m.weight;
  std::vector<NormalComponent> next;
  for (std::size_t c = 0; c < fit.components.size(); ++c) {
    const Moments& sums = expectation.moments()[c];
    if (sums.weight > 1e-9 * total) next.push_back(moved(fit.components[c], sums, total, floor));
  }
  fit.components = std::move(next);
}

}  // namespace

void take_mixture_step(const MixtureCells& cells, const std::vector<double>& floor,
                       MixtureFit& fit) {
  switch (cells.dimensions) {
    case 1:
      return take_step<1>(cells, floor, fit);
    case 2:
      return take_step<2>(cells, floor, fit);
    case 3:
      return take_step<3>(cells, floor, fit);
    default:
      return take_step<0>(cells, floor, fit);
  }
}

}  // namespace pellucid
