// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace pellucid::imported {

/// A closed interval that encloses all values of a quantity. Rounding is left out: what is proved
/// by it holds to some units in the last place, which curve_fit.h adds.
struct Range {
  double lower = 0, upper = 0;

  constexpr Range() = default;
  constexpr Range(double value) : lower(value), upper(value) {}  // NOLINT: numbers are ranges
  constexpr Range(double a, double b) : lower(a), upper(b) {}

  static constexpr Range all() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  double magnitude() const { return std::max(std::abs(lower), std::abs(upper)); }
  double width() const { return upper - lower; }
};

inline Range hull(Range a, Range b) {
  return {std::min(a.lower, b.lower), std::max(a.upper, b.upper)};
}
inline Range operator+(Range a, Range b) {
  return {a.lower + b.lower, a.upper + b.upper};
}
inline Range operator-(Range a, Range b) {
  return {a.lower - b.upper, a.upper - b.lower};
}
/// Returns a b; 0 · ∞ counts as 0: an infinite bound stands for "unknown, but finite".
inline double times(double a, double b) {
  return a == 0 || b == 0 ? 0 : a * b;
}
inline Range operator*(Range a, Range b) {
  const double p = times(a.lower, b.lower), q = times(a.lower, b.upper),
               r = times(a.upper, b.lower), s = times(a.upper, b.upper);
  // Without lists, which no compiler takes apart at -O1.
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
/// Returns c x of a finite number, of which times() speaks where it is 0.
inline Range scaled(double c, Range x) {
  if (c == 0) return {0, 0};
  return c > 0 ? Range(c * x.lower, c * x.upper) : Range(c * x.upper, c * x.lower);
}
/// Returns x^p of x >= 0.
inline Range power(Range x, double p) {
  const double a = std::pow(std::max(x.lower, 0.0), p), b = std::pow(std::max(x.upper, 0.0), p);
  return {std::min(a, b), std::max(a, b)};
}

/// A function of one variable over an interval: ranges of its value and of its first and second
/// derivatives. Where the function has a kink the first is the hull of those at either side, and
/// the second is Range::all(). Arithmetic follows the chain rule, so that a formula written once,
/// as a template, gives both its value (T = double) and a bound on how far it is from its chord.
struct Jet {
  Range value, first, second;

  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT: numbers are constant functions
  Jet(Range v, Range d, Range dd) : value(v), first(d), second(dd) {}
};

inline Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}
inline Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}
inline Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.value * b.first + a.first * b.value,
          a.value * b.second + scaled(2, a.first * b.first) + a.second * b.value};
}
/// Returns f(x) by the ranges of f, f' and f'' over the value of x.
inline Jet compose(const Jet& x, Range f, Range df, Range ddf) {
  return {f, df * x.first, ddf * (x.first * x.first) + df * x.second};
}

/// Returns x^p of x >= 0; what is below counts as 0.
inline Jet power(const Jet& x, double p) {
  const Range v{std::max(x.value.lower, 0.0), std::max(x.value.upper, 0.0)};
  return compose(x, power(v, p), scaled(p, power(v, p - 1)), scaled(p * (p - 1), power(v, p - 2)));
}
inline double power(double x, double p) {
  return std::pow(std::max(x, 0.0), p);
}

/// Returns ln x of x > 0.
inline Jet logarithm(const Jet& x) {
  const Range v = x.value, inverse{1 / v.upper, 1 / v.lower};
  return compose(x, {std::log(v.lower), std::log(v.upper)}, inverse, scaled(-1, inverse * inverse));
}
inline double logarithm(double x) {
  return std::log(x);
}

/// Returns the range of the cosine over the angle's interval.
inline Range cosine(Range x) {
  constexpr double pi = std::numbers::pi;
  if (!(x.width() < 2 * pi)) return {-1, 1};
  Range y{std::min(std::cos(x.lower), std::cos(x.upper)),
          std::max(std::cos(x.lower), std::cos(x.upper))};
  if (std::floor(x.upper / (2 * pi)) >= std::ceil(x.lower / (2 * pi))) y.upper = 1;
  if (std::floor((x.upper - pi) / (2 * pi)) >= std::ceil((x.lower - pi) / (2 * pi))) y.lower = -1;
  return y;
}
inline Jet cosine(const Jet& x) {
  const Range c = cosine(x.value), s = cosine(x.value - Range(std::numbers::pi / 2));
  return compose(x, c, scaled(-1, s), scaled(-1, c));
}
inline double cosine(double x) {
  return std::cos(x);
}
template <class T>
T sine(const T& x) {
  return cosine(x - T(std::numbers::pi / 2));
}
inline double sine(double x) {
  return std::sin(x);
}

/// Returns e^x.
inline Jet exponential(const Jet& x) {
  const Range e{std::exp(x.value.lower), std::exp(x.value.upper)};
  return compose(x, e, e, e);
}
inline double exponential(double x) {
  return std::exp(x);
}

inline Jet larger(const Jet& a, const Jet& b) {
  if (a.value.lower >= b.value.upper) return a;
  if (b.value.lower >= a.value.upper) return b;
  return {{std::max(a.value.lower, b.value.lower), std::max(a.value.upper, b.value.upper)},
          hull(a.first, b.first),
          Range::all()};
}
inline double larger(double a, double b) {
  return std::max(a, b);
}
template <class T>
T smaller(const T& a, const T& b) {
  return T(0) - larger(T(0) - a, T(0) - b);
}

/// Returns 1/x of x >= 1.
inline Jet reciprocal(const Jet& x) {
  return compose(x, power(x.value, -1), scaled(-1, power(x.value, -2)),
                 scaled(2, power(x.value, -3)));
}
inline double reciprocal(double x) {
  return 1 / x;
}

/// Returns low(x) up to the threshold and high(x) above it, which are to meet there.
template <class Low, class High>
double branch(double x, double threshold, Low&& low, High&& high) {
  return x <= threshold ? low(x) : high(x);
}
template <class Low, class High>
Jet branch(const Jet& x, double threshold, Low&& low, High&& high) {
  if (x.value.upper <= threshold) return low(x);
  if (x.value.lower > threshold) return high(x);
  const Jet a = low(Jet({x.value.lower, threshold}, x.first, x.second));
  const Jet b = high(Jet({threshold, x.value.upper}, x.first, x.second));
  return {hull(a.value, b.value), hull(a.first, b.first), Range::all()};
}

/// Returns a bound on the distance of a function from its chord over an interval of this length:
///
///   h²/8 · max|f''|,  and with M and m the bounds of f'  h/4 · (M - m).
///
/// The second holds for kinks too. Proof: with the chord's slope s in [m, M] the difference is at
/// most λh(M - s) and at most (1 - λ)h(s - m) at the share λ of the way; the smaller of the two is
/// largest where they meet, at h (M - s)(s - m)/(M - m) <= h (M - m)/4. So is it downwards. ∎
inline double chord_deviation(const Jet& f, double length) {
  const double curved = length * length / 8 * f.second.magnitude();
  const double kinked = length / 4 * f.first.width();
  // A quantity that is unknown gives NaN, which must not pass for a small one.
  if (curved <= kinked) return curved;
  return kinked >= 0 ? kinked : std::numeric_limits<double>::infinity();
}

}  // namespace pellucid::imported
