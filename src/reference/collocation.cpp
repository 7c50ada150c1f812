// SPDX-License-Identifier: Apache-2.0
#include "collocation.h"

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <numeric>

namespace pellucid::reference {
namespace {

constexpr std::size_t nodes = Collocation::nodes;

/// Returns P_0 … P_nodes at x, by their recurrence.
std::array<double, nodes + 1> legendre(double x) {
  std::array<double, nodes + 1> p{1, x};
  for (std::size_t k = 1; k < nodes; ++k) {
    const double order = static_cast<double>(k);
    p[k + 1] = ((2 * order + 1) * x * p[k] - order * p[k - 1]) / (order + 1);
  }
  return p;
}

/// Returns ∫ P_k from -1 to x, k < nodes: (P_{k+1} - P_{k-1}) / (2k + 1), and 1 + x for k = 0.
Collocation::Values legendre_integrals(double x) {
  const std::array<double, nodes + 1> p = legendre(x);
  Collocation::Values result{1 + x};
  for (std::size_t k = 1; k < nodes; ++k) {
    result[k] = (p[k + 1] - p[k - 1]) / (2 * static_cast<double>(k) + 1);
  }
  return result;
}

double product(const Collocation::Values& x, const Collocation::Values& y) {
  return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
}

}  // namespace

const Collocation& Collocation::rule() {
  static const Collocation result;
  return result;
}

Collocation::Collocation() {
  using Rule = boost::math::quadrature::gauss<double, nodes>;
  const std::size_t half = nodes / 2;
  for (std::size_t i = 0; i < half; ++i) {
    node_[half - 1 - i] = -Rule::abscissa()[i];
    node_[half + i] = Rule::abscissa()[i];
    weight_[half - 1 - i] = weight_[half + i] = Rule::weights()[i];
  }
  for (std::size_t j = 0; j < nodes; ++j) {
    const std::array<double, nodes + 1> p = legendre(node_[j]);
    for (std::size_t k = 0; k < nodes; ++k) {
      transform_[k][j] = (static_cast<double>(k) + 0.5) * weight_[j] * p[k];
    }
  }
  for (std::size_t i = 0; i < nodes; ++i) {
    const Values integrals = legendre_integrals(node_[i]);
    for (std::size_t j = 0; j < nodes; ++j) {
      for (std::size_t k = 0; k < nodes; ++k) running_[i][j] += integrals[k] * transform_[k][j];
    }
  }
}

double Collocation::integral(const Values& f) const {
  return product(weight_, f);
}

Collocation::Values Collocation::running_integral(const Values& f) const {
  Values result;
  for (std::size_t i = 0; i < nodes; ++i) result[i] = product(running_[i], f);
  return result;
}

double Collocation::running_integral(const Values& f, double x) const {
  const Values integrals = legendre_integrals(x);
  double sum = 0;
  for (std::size_t k = 0; k < nodes; ++k) sum += product(transform_[k], f) * integrals[k];
  return sum;
}

double Collocation::tail(const Values& f) const {
  double sum = 0;
  for (std::size_t k = nodes - 3; k < nodes; ++k) sum += std::abs(product(transform_[k], f));
  return sum;
}

}  // namespace pellucid::reference
