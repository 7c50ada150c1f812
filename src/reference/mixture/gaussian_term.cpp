// SPDX-License-Identifier: Apache-2.0
#include "gaussian_term.h"

#include <algorithm>
#include <cmath>

namespace pellucid::reference {
namespace {

Cubic to_bernstein(const Cubic& c) {
  return {c[0], c[0] + c[1] / 3, c[0] + (2 * c[1] + c[2]) / 3, c[0] + c[1] + c[2] + c[3]};
}

Real middle(Real x, Real y) {
  return (x + y) / 2;
}

/// Splits by De Casteljau's algorithm at 1/2.
std::pair<Cubic, Cubic> halves_of(const Cubic& b) {
  const Real m01 = middle(b[0], b[1]), m12 = middle(b[1], b[2]), m23 = middle(b[2], b[3]);
  const Real left = middle(m01, m12), right = middle(m12, m23), centre = middle(left, right);
  return {{b[0], m01, left, centre}, {centre, right, m23, b[3]}};
}

}  // namespace

GaussianTerm::GaussianTerm(const GaussianPrimitive& primitive, const std::vector<Cubic>& data)
    : primitive_(&primitive), log_peak_(std::log(Real(primitive.extinction))) {
  for (const std::vector<double>& row : primitive.matrix) {
    Cubic sum{};
    for (std::size_t k = 0; k < row.size(); ++k) {
      Cubic offset = data[static_cast<std::size_t>(primitive.channels[k])];
      offset[0] -= primitive.center[k];
      for (std::size_t p = 0; p < 4; ++p) sum[p] += row[k] * offset[p];
    }
    rows_.push_back(to_bernstein(sum));
  }
  exponent_ = range();
}

GaussianTerm::GaussianTerm(const GaussianTerm& whole, std::vector<Cubic> rows)
    : primitive_(whole.primitive_), log_peak_(whole.log_peak_), rows_(std::move(rows)) {
  exponent_ = range();
}

GaussianTerm::Range GaussianTerm::range() const {
  Range sum{0, 0};
  for (const Cubic& b : rows_) {
    const auto [low, high] = std::minmax_element(b.begin(), b.end());
    const Real nearest = std::clamp(Real(0), *low, *high);
    const Real farthest = std::max(-*low, *high);
    sum.lower += nearest * nearest;
    sum.upper += farthest * farthest;
  }
  return sum;
}

std::pair<GaussianTerm, GaussianTerm> GaussianTerm::halves() const {
  std::vector<Cubic> left, right;
  left.reserve(rows_.size());
  right.reserve(rows_.size());
  for (const Cubic& b : rows_) {
    const auto [first, second] = halves_of(b);
    left.push_back(first);
    right.push_back(second);
  }
  return {GaussianTerm(*this, std::move(left)), GaussianTerm(*this, std::move(right))};
}

GaussianTerm::Density::Density(const GaussianTerm& term) {
  for (const Cubic& b : term.rows_) {
    rows_.push_back({static_cast<double>(b[0]), static_cast<double>(3 * (b[1] - b[0])),
                     static_cast<double>(3 * ((b[2] - b[1]) - (b[1] - b[0]))),
                     static_cast<double>(b[3] - b[0] - 3 * (b[2] - b[1]))});
  }
}

double GaussianTerm::Density::operator()(double w) const {
  double exponent = 0;
  for (const std::array<double, 4>& c : rows_) {
    const double p = ((c[3] * w + c[2]) * w + c[1]) * w + c[0];
    exponent += p * p;
  }
  return std::exp(-exponent);
}

}  // namespace pellucid::reference
