// SPDX-License-Identifier: Apache-2.0
#include "polynomial.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace pellucid::reference {

Real value(const Polynomial& p, Real x) {
  Real result = 0;
  for (std::size_t i = p.size(); i > 0; --i) result = result * x + p[i - 1];
  return result;
}

Polynomial sum(const Polynomial& p, const Polynomial& q) {
  Polynomial result = p.size() < q.size() ? q : p;
  const Polynomial& other = p.size() < q.size() ? p : q;
  for (std::size_t i = 0; i < other.size(); ++i) result[i] += other[i];
  return result;
}

Polynomial product(const Polynomial& p, const Polynomial& q) {
  if (p.empty() || q.empty()) return {};
  Polynomial result(p.size() + q.size() - 1, 0);
  for (std::size_t i = 0; i < p.size(); ++i) {
    for (std::size_t j = 0; j < q.size(); ++j) result[i + j] += p[i] * q[j];
  }
  return result;
}

Polynomial derivative(const Polynomial& p) {
  Polynomial result;
  for (std::size_t i = 1; i < p.size(); ++i) result.push_back(static_cast<Real>(i) * p[i]);
  return result;
}

/// Returns the zeros in an interval. Between two zeros of the derivative a polynomial is monotone.
std::vector<Real> zeros(Polynomial p, Real lower, Real upper) {
  while (!p.empty() && p.back() == 0) p.pop_back();
  if (p.size() < 2) return {};
  std::vector<Real> ends = zeros(derivative(p), lower, upper);
  ends.insert(ends.begin(), lower);
  ends.push_back(upper);
  std::vector<Real> result;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Real here = value(p, ends[i]);
    if (here == 0) result.push_back(ends[i]);
    if (i + 1 == ends.size()) break;
    const Real next = value(p, ends[i + 1]);
    if (!((here < 0 && next > 0) || (here > 0 && next < 0))) continue;
    std::uintmax_t iterations = 200;
    const auto [left, right] = boost::math::tools::toms748_solve(
        [&](Real x) { return value(p, x); }, ends[i], ends[i + 1], here, next,
        boost::math::tools::eps_tolerance<Real>(62), iterations);
    result.push_back((left + right) / 2);
  }
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

}  // namespace pellucid::reference
