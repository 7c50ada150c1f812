// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pellucid/scene/opacity_table.h"

namespace pellucid {

/// -ln(1 - α) where what counts as opaque begins.
inline constexpr double largest_depth = 100 * std::numbers::ln2;

/// Returns -ln(1 - α), of opacity and transparency 1 - α: what is small of the two has all of its
/// digits.
inline double depth_of(double opacity, double transparency) {
  return opacity < 0.5 ? -std::log1p(-opacity) : -std::log(transparency);
}

/// Two neighbouring entries of an opacity table, a.value < b.value, between which opacity and color
/// are linear. Depth stands for -ln(1 - opacity).
class OpacityStretch {
 public:
  OpacityStretch(const OpacityPoint& a, const OpacityPoint& b)
      : a_(a), b_(b), width_(b.value - a.value) {}

  /// Returns the depth at v, where the opacity is below 1.
  double depth(double v) const {
    return depth_of(mix(v, a_.opacity, b_.opacity), mix(v, 1 - a_.opacity, 1 - b_.opacity));
  }

  /// Returns a value at which the depth is about that, within the stretch.
  double value(double depth) const {
    const bool thin = depth < std::numbers::ln2;
    const double at = thin ? -std::expm1(-depth) : std::exp(-depth);
    const double at_a = thin ? a_.opacity : 1 - a_.opacity;
    const double at_b = thin ? b_.opacity : 1 - b_.opacity;
    const double from_a = (at - at_a) / (at_b - at_a), from_b = (at_b - at) / (at_b - at_a);
    const double v = from_a < from_b ? a_.value + from_a * width_ : b_.value - from_b * width_;
    return std::clamp(v, a_.value, b_.value);
  }

  Rgb<double> color(double v) const {
    return {mix(v, a_.color.r, b_.color.r), mix(v, a_.color.g, b_.color.g),
            mix(v, a_.color.b, b_.color.b)};
  }

  /// Returns the end of an opacity of 1 at a: the first double whose depth is at most
  /// largest_depth. That is mostly the next one, but beside 0 it is not a denormal one, by which
  /// nobody should have to divide.
  double opaque_to() const {
    double v = value(largest_depth);
    while (v > a_.value && depth(v) <= largest_depth) v = previous(v);
    while (depth(v) > largest_depth) v = next(v);
    return v;
  }
  /// Returns the beginning of one at b: the first double whose depth is larger, mostly b itself.
  double opaque_from() const {
    double v = value(largest_depth);
    while (depth(v) > largest_depth) v = previous(v);
    while (v < b_.value && depth(v) <= largest_depth) v = next(v);
    return v;
  }

  static double next(double v) {
    return std::nextafter(v, std::numeric_limits<double>::infinity());
  }
  static double previous(double v) {
    return std::nextafter(v, -std::numeric_limits<double>::infinity());
  }

 private:
  /// Mixes from the nearer end: what vanishes there keeps its digits.
  double mix(double v, double at_a, double at_b) const {
    const double from_a = v - a_.value, from_b = b_.value - v;
    return from_a <= from_b ? at_a + from_a / width_ * (at_b - at_a)
                            : at_b + from_b / width_ * (at_a - at_b);
  }

  const OpacityPoint& a_;
  const OpacityPoint& b_;
  double width_;
};

/// Returns by how much, relative to the depth, a chord of it over the opacities between the depths
/// u <= w exceeds it at most: a bound, attained for u = 0. With Δ = w - u
///
///   (√w - √u)² κ(Δ),  κ(Δ) = 1/(1 - e^-Δ) - 1/Δ, in [1/2, 1).
///
/// Proof. At the depth u + p the chord is u + Δ (1 - e^-p)/(1 - e^-Δ), too large by
/// e(p) = Δ (1 - e^-p)/(1 - e^-Δ) - p, which is 0 for p = 0 and Δ. e(p)/(p (Δ - p)) is minus the
/// divided difference e[0,p,Δ], whose derivative by p is -e[0,p,p,Δ] = -e'''(ξ)/6 < 0: it is
/// largest for p -> 0, where it is e'(0)/Δ = κ. What is left, p (Δ - p)/(u + p), is largest at u +
/// p = √(u w), where it is (√w - √u)². ∎
inline double chord_excess(double u, double w) {
  const double delta = w - u;
  // Below 0.01 the next term of the series, Δ⁵/30240, is below 4e-15, and nothing cancels.
  const double kappa = delta < 0.01 ? 0.5 + delta * (1 - delta * delta * (1.0 / 60)) * (1.0 / 12)
                                    : -1 / std::expm1(-delta) - 1 / delta;
  const double root = std::sqrt(w) - std::sqrt(u);
  return root * root * kappa;
}

}  // namespace pellucid
