// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/line_window.h"
#include "pellucid/segment/result.h"
#include "pellucid/transfer/antiderivative.h"

namespace pellucid {

/// Returns an upper bound on the error of a segment's opacity, given an error of at most `error` in
/// its depth and of 4 u in the opacity of that depth. With e^x - 1 <= x + (e - 2) x² on [0,1].
template <class T>
PELLUCID_HD T opacity_error_bound(const SegmentResult<T>& s, T error) noexcept {
  constexpr scalar_t<T> u = rounding_unit<T>;
  const T less = min(error, s.optical_depth);  // the true depth is not negative
  const T above = less > T(1) ? exp(less - s.optical_depth) - s.transparency
                              : s.transparency * (less + T(0.71828183) * (less * less));
  const T below = s.transparency * min(error, T(1));
  return T(1 + 16 * u) * max(above, below) + T(4 * u) * s.opacity;
}

/// The means along the line of a window: of the extinction, and of the color weighted by it.
template <class T>
struct LineMean {
  int first, last;  ///< the intervals of the line's ends
  T rise;           ///< the divisor of its integrals
  T extinction;
  Rgb<T> color;  ///< in the hull of the absorbing colors
};

/// Clamps each channel.
template <class T>
PELLUCID_HD Rgb<T> clamp_color(const Rgb<T>& c, const Rgb<T>& lower, const Rgb<T>& upper) noexcept {
  return {clamp(c.r, lower.r, upper.r), clamp(c.g, lower.g, upper.g), clamp(c.b, lower.b, upper.b)};
}

/// Returns the quotient (R(v₂) - R(v₁)) / (v₂ - v₁) (J. Kniss et al. 2003, equation 5), or for a
/// line inside one interval the material at its middle, without a quotient.
template <class T>
PELLUCID_HD LineMean<T> line_mean(const LineWindow<T>& window, const PiecewiseLinear<T>& table,
                                  const PiecewiseLinearAntiderivative<T>& antiderivative) noexcept {
  const T lower = window.data.lower(), upper = window.data.upper();
  LineMean<T> mean;
  mean.first = interval_near(table, lower, window.interval);
  mean.last = interval_below(table, upper, mean.first);
  // If the ends absorb, the divisor must match their rounded values; otherwise 2 p1 is more exact.
  const bool inside = !window.rest.at_lower && !window.rest.at_upper;
  mean.rise = inside ? T(2) * window.data.p1 : upper - lower;
  RangeIntegrals<T> sum;
  if (mean.first == mean.last) {
    add_stretch(sum, T(1), table.evaluate_in(mean.first, lower),
                table.evaluate_in(mean.first, upper));
    mean.extinction = sum.mass;
  } else {
    sum =
        range_integrals(table, antiderivative, ValueRange<T>(lower, upper, mean.first, mean.last));
    mean.extinction = sum.mass / mean.rise;
  }
  mean.color =
      clamp_color((T(1) / sum.mass) * sum.emission, window.table.color_min, window.table.color_max);
  return mean;
}

/// Errors if a window's line replaces its data.
template <class T>
struct LineError {
  T extinction;  ///< of the mean extinction
  T color;       ///< of the mean color weighted by extinction, times the mean extinction
  /// Errors of the integral over a part of the window that begins at either end: of the extinction,
  /// and of extinction · (color - c) for any absorbing color c.
  T part_extinction, part_emission;
  /// Relative difference between the lengths that a value has in the line and in the data; half of
  /// the range of their ratio; and the contribution of the ends to the mean extinction. Infinite if
  /// the data are not monotone.
  T ratio, spread, ends;
};

/// Computes the errors if a window's line replaces its data.
///
/// Proof. Write f for the data, l for the line, g = f - l, k = v₂ - v₁ >= 0. For a function H of
/// the data, ∫ H(f) - H(l) dt = ∫ H'(v) Δ(v) dv with Δ(v) = |{t: f > v}| - |{t: l > v}|, and
///
/// (a) ∫ |Δ| dv <= ∫ |g| dt, and ∫ Δ dv = ∫ g dt = 0, so that a constant may be subtracted from H'.
/// The mean of |g| is at most that of |p2 L2| + |p3 L3|, 2/√27 and 13/40, and at most the norm,
/// 1/√5 and 1/√7.
///
/// (b) |Δ(v)| <= min(1, max |g|/k): it is the difference of |{l <= v < f}| and |{f <= v < l}|,
/// which lie on either side of the crossing of l with v, neither longer than max |g|/k.
///
/// (c) If f' is in [a,b], a > 0, a value of both takes the length dv/f' of f and dv/k of l. A value
/// of only one lies between an end of the line and that of the data, and takes at most dv/min(a,k).
///
/// In (b) and (c) only those t count at which f or l absorbs. With H = extinction the error of the
/// mean is at most (a) mean |g| times half of the range of slopes, (b) the variation times max
/// |g|/k, (c) the mean times max(|a - k|/a, |b - k|/b), plus the mass at the ends over min(a,k).
///
/// Let ω be the range of colors, c the true mean color and H = extinction · (color - c). As ∫ H(f)
/// dt = 0, the extinction times the error of the mean color is ∫ H(l) - H(f) dt, with |H'| <= ω
/// |extinction'| + extinction |color'| and |H| <= ω extinction. In (c), l gives a value the
/// fraction f'/k of the length that f gives it. A multiple of ∫ H(f) dt may be subtracted, so that
/// only half of the range of f'/k counts, (b - a)/(2k), and ∫ |H(f)| dt, which for a mean c is at
/// most ω/2 ∫ extinction(f) dt.
///
/// Over a part [0,ξ] of the window (b) holds unchanged, and (a) without the constant. Rounding
/// changes values by less than twice data.rounding and slopes by less than slope_rounding. ∎
template <class T>
PELLUCID_HD LineError<T> line_error(
    const LineWindow<T>& window, const LineMean<T>& mean, const PiecewiseLinear<T>& table,
    const PiecewiseLinearAntiderivative<T>& antiderivative) noexcept {
  const LegendreCubic<T>& f = window.data;
  const LineResidual<T>& rest = window.rest;
  const RangeSummary<T>& all = window.table;
  const T range = all.color_range(), shift = T(2) * f.rounding, k = mean.rise;
  const T a2 = abs(f.p2), a3 = abs(f.p3);
  const T mean_rest =
      min(T(0.38490018) * a2 + T(0.325) * a3, sqrt(T(0.2) * (a2 * a2) + T(0.14285715) * (a3 * a3)));
  const T largest_rest = rest.value + (shift + f.slope_rounding);
  const T crossing = largest_rest < k ? largest_rest / k : T(1);
  const T steepest = max(abs(all.slope_max), abs(all.slope_min));
  const T by_variation = all.variation * crossing;
  LineError<T> error;
  error.extinction =
      min(T(0.5) * (all.slope_max - all.slope_min) * mean_rest + steepest * shift, by_variation);
  error.part_extinction = min(steepest * (mean_rest + shift), by_variation);
  error.color = min((range * steepest + all.color_slope) * (mean_rest + shift),
                    (range * all.variation + all.color_variation) * crossing);
  error.part_emission = error.color;

  error.ratio = error.spread = error.ends = RangeSummary<T>::infinity;
  const bool inside = !rest.at_lower && !rest.at_upper;
  const T slope_error = inside ? f.slope_rounding : f.slope_rounding + T(2) * shift;
  const T least = (k - slope_error) + rest.slope_min, most = (k + slope_error) + rest.slope_max;
  if (least > T(0)) {
    const T ratio = max(abs(least - k) / least, abs(most - k) / most);
    const T spread = T(0.5) * (most - least) / k;
    const T color_ratio = T(0.5) * range * spread * (k / least);
    if (inside || ratio * mean.extinction < error.extinction ||
        color_ratio * mean.extinction < error.color) {
      T mass = T(0);
      const auto add_between = [&](T end, T step, int near) noexcept {
        const T from = end + min(step, T(0)) - shift, to = end + max(step, T(0)) + shift;
        const int first = interval_near(table, from, near);
        mass += range_integrals(table, antiderivative,
                                ValueRange<T>(from, to, first, interval_below(table, to, first)))
                    .mass;
      };
      if (rest.at_lower) add_between(f.lower(), f.p2 - f.p3, mean.first);
      if (rest.at_upper) add_between(f.upper(), f.p2 + f.p3, mean.last);
      error.ratio = ratio;
      error.spread = spread;
      error.ends = mass / min(least, k);
      error.extinction = min(error.extinction, ratio * mean.extinction + error.ends);
      error.color = min(error.color, color_ratio * (mean.extinction + mass / k) +
                                         range * mass * (T(0.5) * (most + least) / (k * least)));
    }
  }
  const T slack = antiderivative.rounding;
  error.extinction = (T(1) + slack) * error.extinction + slack * mean.extinction;
  error.part_extinction = (T(1) + slack) * error.part_extinction;
  error.color = (T(1) + T(2) * slack) * error.color;
  error.part_emission = (T(1) + slack) * error.part_emission;
  return error;
}

}  // namespace pellucid
