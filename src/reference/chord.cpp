// SPDX-License-Identifier: Apache-2.0
#include "chord.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>

namespace pellucid::reference {
namespace {

/// Returns whether corner k stands at the upper end of an axis: where its bit is set.
bool is_upper(std::size_t k, std::size_t axis) {
  return ((k >> axis) & 1) != 0;
}

}  // namespace

Chord::Chord(const std::array<Real, 8>& corner, const Real3& entry, const Real3& exit)
    : corner_(corner),
      entry_(entry),
      exit_(exit),
      lower_(std::numeric_limits<Real>::infinity()),
      upper_(-std::numeric_limits<Real>::infinity()) {
  for (std::size_t k = 0; k < 8; ++k) {
    // The weight of a corner along the chord: a product of three linear functions.
    std::array<Real, 4> weight{1, 0, 0, 0};
    bool ever = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const Real at_entry = is_upper(k, a) ? entry[a] : 1 - entry[a];
      const Real at_exit = is_upper(k, a) ? exit[a] : 1 - exit[a];
      ever = ever && (at_entry != 0 || at_exit != 0);
      for (std::size_t p = 3; p > 0; --p) {
        weight[p] = weight[p] * at_entry + weight[p - 1] * (at_exit - at_entry);
      }
      weight[0] *= at_entry;
    }
    if (!ever) continue;
    for (std::size_t p = 0; p < 4; ++p) monomial_[p] += corner[k] * weight[p];
    lower_ = std::min(lower_, corner[k]);
    upper_ = std::max(upper_, corner[k]);
  }
  // Weights that add up to 1 only to rounding must not move constant data off a control value.
  if (lower_ == upper_) monomial_ = {lower_, 0, 0, 0};
}

Chord Chord::linear(Real at_entry, Real at_exit) {
  std::array<Real, 8> corner;
  for (std::size_t k = 0; k < 8; ++k) corner[k] = is_upper(k, 0) ? at_exit : at_entry;
  return {corner, {0, 0, 0}, {1, 0, 0}};
}

Chord Chord::part(Real u_begin, Real u_end) const {
  const auto at = [&](Real u) {
    Real3 place;
    for (std::size_t a = 0; a < 3; ++a) place[a] = entry_[a] + u * (exit_[a] - entry_[a]);
    return place;
  };
  return {corner_, at(u_begin), at(u_end)};
}

Real Chord::operator()(Real u) const {
  Real sum = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    Real weight = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const Real at = entry_[a] + u * (exit_[a] - entry_[a]);
      weight *= is_upper(k, a) ? at : 1 - at;
    }
    sum += weight * corner_[k];
  }
  return std::clamp(sum, lower_, upper_);
}

/// Expands after Taylor about u_begin, scaled to the part; in extended precision, so that a narrow
/// stretch of data far from 0 keeps its digits.
std::array<Real, 4> Chord::monomial(Real u_begin, Real u_end) const {
  const std::array<Real, 4>& c = monomial_;
  const Real h = u_end - u_begin, u = u_begin;
  return {((c[3] * u + c[2]) * u + c[1]) * u + c[0], h * ((3 * c[3] * u + 2 * c[2]) * u + c[1]),
          h * h * (3 * c[3] * u + c[2]), h * h * h * c[3]};
}

std::vector<Real> Chord::stationary_points() const {
  const Real a = 3 * monomial_[3], b = 2 * monomial_[2], c = monomial_[1];
  std::vector<Real> found;
  const auto keep = [&](Real numerator, Real denominator) {
    if (denominator == 0) return;
    const Real u = numerator / denominator;
    if (u > 0 && u < 1) found.push_back(u);
  };
  const Real discriminant = b * b - 4 * a * c;
  if (discriminant < 0) return found;
  const Real q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  keep(q, a);
  keep(c, q);
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Real> Chord::cuts(const std::vector<Real>& values) const {
  std::vector<Real> ends = stationary_points();
  std::vector<Real> result = ends;
  ends.insert(ends.begin(), 0);
  ends.push_back(1);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    // Monotone between the ends: one crossing of each value strictly between theirs.
    const Real f_begin = (*this)(ends[i]), f_end = (*this)(ends[i + 1]);
    const auto [low, high] = std::minmax({f_begin, f_end});
    for (auto value = std::upper_bound(values.begin(), values.end(), low);
         value != values.end() && *value < high; ++value) {
      std::uintmax_t iterations = 200;
      const auto [left, right] = boost::math::tools::toms748_solve(
          [&](Real u) { return (*this)(u) - *value; }, ends[i], ends[i + 1], f_begin - *value,
          f_end - *value, boost::math::tools::eps_tolerance<Real>(62), iterations);
      result.push_back((left + right) / 2);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace pellucid::reference
