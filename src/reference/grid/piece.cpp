// SPDX-License-Identifier: Apache-2.0
#include "piece.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>

#include "pellucid/scene/error.h"

namespace pellucid::reference {
namespace {

double polynomial(const std::array<double, 4>& c, double w) {
  return ((c[3] * w + c[2]) * w + c[1]) * w + c[0];
}

}  // namespace

Piece::Piece(const Chord& chord, Real u_begin, Real u_end, const TableInterval& interval,
             Real t_begin, Real t_end)
    : interval_(interval), t_begin_(t_begin), length_(t_end - t_begin) {
  if (interval.constant()) return;
  const std::array<Real, 4> local = chord.monomial(u_begin, u_end);
  const Real left = interval.left->value, width = Real(interval.right->value) - left;
  for (std::size_t p = 0; p < 4; ++p) {
    share_[p] = static_cast<double>((p == 0 ? local[p] - left : local[p]) / width);
  }
}

double Piece::t(double w) const {
  return static_cast<double>(t_begin_ + w * length_);
}

double Piece::share(double w) const {
  return std::clamp(polynomial(share_, w), 0.0, 1.0);
}

double Piece::rate(double w) const {
  const double length = static_cast<double>(length_);
  if (interval_.constant()) return interval_.left->extinction * length;
  const double s = share(w);
  return ((1 - s) * interval_.left->extinction + s * interval_.right->extinction) * length;
}

Rgb<double> Piece::color(double w) const {
  const Rgb<double>& left = interval_.left->color;
  if (interval_.constant()) return left;
  return left + (interval_.right->color - left) * share(w);
}

double Piece::depth(double w_begin, double w_end) const {
  // Abramowitz and Stegun, table 25.4, n = 4.
  constexpr double node[2] = {0.339981043584856264802665759103, 0.861136311594052575223946488893};
  constexpr double weight[2] = {0.652145154862546142626936050778, 0.347854845137453857373063949222};
  const double middle = 0.5 * (w_begin + w_end), half = 0.5 * (w_end - w_begin);
  double sum = 0;
  for (int i = 0; i < 2; ++i) {
    sum += weight[i] * (rate(middle - half * node[i]) + rate(middle + half * node[i]));
  }
  return half * sum;
}

double Piece::weight_of_right(double w_begin, double w_end) const {
  // On [-1, 1], because Boost compares an error for that interval with a tolerance for [a, b]. A
  // part no deeper than 2 is smooth there: the recursion is hardly ever entered, never to its end.
  const double half = 0.5 * (w_end - w_begin);
  const auto integrand = [&](double x) {
    const double w = w_begin + half * (1 + x);
    return rate(w) * std::exp(-depth(w_begin, w)) * share(w);
  };
  return half * boost::math::quadrature::gauss_kronrod<double, 15>::integrate(integrand, -1.0, 1.0,
                                                                              10, 1e-12);
}

void Gatherer::add(const Piece& piece, double w_begin, double w_end) {
  const double depth = piece.depth(w_begin, w_end);
  if (depth == 0 || done()) return;
  if (!std::isfinite(depth)) {
    throw Error(
        "reference: the optical depth of a ray overflows; lengths and extinctions are too "
        "large together");
  }
  if (depth > 2) {
    const double middle = 0.5 * (w_begin + w_end);
    add(piece, w_begin, middle);
    add(piece, middle, w_end);
    return;
  }
  // The color is linear in the share s: τ C e^{-a} integrates to C_left α + (C_right − C_left) S.
  const Real opacity = -std::expm1(-Real(depth));
  const Rgb<double>&left = piece.interval().left->color, &right = piece.interval().right->color;
  const Real share = left == right ? Real(0) : Real(piece.weight_of_right(w_begin, w_end));
  add(depth, {left.r * opacity + (Real(right.r) - left.r) * share,
              left.g * opacity + (Real(right.g) - left.g) * share,
              left.b * opacity + (Real(right.b) - left.b) * share});
}

void Gatherer::add(double depth, const std::array<Real, 3>& light) {
  const Real transparency = std::exp(-depth_);
  for (std::size_t c = 0; c < 3; ++c) radiance_[c] += transparency * light[c];
  depth_ += depth;
}

bool Gatherer::done() const {
  return depth_ > 37;  // exp(-37) < 1e-16
}

ReferencePixel Gatherer::result() const {
  ReferencePixel pixel;
  pixel.radiance = {static_cast<double>(radiance_[0]), static_cast<double>(radiance_[1]),
                    static_cast<double>(radiance_[2])};
  pixel.optical_depth = static_cast<double>(depth_);
  pixel.opacity = static_cast<double>(-std::expm1(-depth_));
  return pixel;
}

}  // namespace pellucid::reference
