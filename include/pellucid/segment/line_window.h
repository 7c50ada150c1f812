// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/transfer/antiderivative.h"

namespace pellucid {

/// A cubic on a window of [0,1] in shifted Legendre polynomials of the window's own coordinate,
///
///   f = mean + p1 L1 + p2 L2 + p3 L3,  L1 = 2t - 1, L2 = 6t² - 6t + 1, L3 = 20t³ - 30t² + 12t - 1.
///
/// mean + p1 L1 is its least-squares line; the residual is orthogonal to it. p1 >= 0: if the line
/// falls, the window is reversed.
template <class T>
struct LegendreCubic {
  T mean, p1, p2, p3;
  T rounding;        ///< of the line at any position
  T slope_rounding;  ///< of 2 p1, 6 p2 and 12 p3, together
  bool reversed;     ///< whether t runs from back to front

  PELLUCID_HD T lower() const noexcept { return mean - p1; }
  PELLUCID_HD T upper() const noexcept { return mean + p1; }

  /// Reverses the window if its line falls.
  PELLUCID_HD void rise() noexcept {
    if (p1 < T(0)) {
      p1 = -p1;
      p3 = -p3;
      reversed = !reversed;
    }
  }
};

/// Returns the cubic on all of [0,1]; mean ∓ p1 are the ends of the least-squares line
/// (specification, 3.8). Differences are taken first, so that data with small variation far from
/// zero keep their digits: p1 is within 5 u, p2 2 u, p3 1.3 u and the mean 2 u of the largest |b_k
/// - b_0|; the mean has an additional error of u of itself.
template <class T>
PELLUCID_HD LegendreCubic<T> legendre(const CubicBernstein<T>& f) noexcept {
  const T d1 = f.b[1] - f.b[0], d2 = f.b[2] - f.b[0], d3 = f.b[3] - f.b[0], inner = f.b[2] - f.b[1];
  const T range = max(abs(d1), max(abs(d2), abs(d3)));
  LegendreCubic<T> c;
  c.mean = f.b[0] + T(0.25) * ((d1 + d2) + d3);
  c.p1 = T(0.15) * (T(3) * d3 + inner);
  c.p2 = T(0.25) * (d3 - (d1 + d2));
  c.p3 = T(0.05) * (d3 - T(3) * inner);
  c.rounding = range > T(0) ? rounding_unit<T> * (T(2) * abs(c.mean) + T(16) * range) : T(0);
  c.slope_rounding = T(64 * rounding_unit<T>) * range;
  c.reversed = false;
  c.rise();
  return c;
}

/// Returns the cubic on [x - h, x + h], a part of [-1,1] in the coordinate 2t - 1, by its Taylor
/// expansion. Slopes keep their precision relative to those of the whole window, however narrow the
/// part is.
template <class T>
PELLUCID_HD LegendreCubic<T> restrict_to(const LegendreCubic<T>& f, T x, T h) noexcept {
  const T xx = x * x, hh = h * h;
  LegendreCubic<T> c;
  c.mean = f.mean + (f.p1 * x + f.p2 * (T(1.5) * xx - T(0.5) + T(0.5) * hh) +
                     f.p3 * (x * (T(2.5) * xx - T(1.5) + T(2.5) * hh)));
  c.p1 = h * (f.p1 + T(3) * x * f.p2 + f.p3 * (T(7.5) * xx - T(1.5) + T(1.5) * hh));
  c.p2 = hh * (f.p2 + T(5) * x * f.p3);
  c.p3 = hh * (h * f.p3);
  c.rounding = T(2) * f.rounding;
  c.slope_rounding = T(4) * h * f.slope_rounding;
  c.reversed = f.reversed;
  c.rise();
  return c;
}

/// The residual of a cubic from its line in the part [begin,end] of its window in which the line,
/// widened by the residual, has values in [support_min, support_max]. Elsewhere neither the cubic
/// nor the line has such values.
template <class T>
struct LineResidual {
  bool empty;               ///< the cubic has none of these values
  bool at_lower, at_upper;  ///< whether the part reaches the line's lower, upper end
  T begin, end;
  T value;                 ///< largest |f - line|
  T slope_min, slope_max;  ///< of f' - line'

  PELLUCID_HD LineResidual(const LegendreCubic<T>& f, T support_min, T support_max) noexcept {
    const T rise = T(2) * f.p1, a2 = abs(f.p2), a3 = abs(f.p3);
    const T margin = (a2 + a3) + T(4) * f.rounding;
    const T below = (support_min - f.mean) + (f.p1 - margin),
            above = (support_max - f.mean) + (f.p1 + margin);
    empty = below > rise || above < T(0);
    at_lower = !(below > T(0));
    at_upper = !(above < rise);
    begin = at_lower ? T(0) : min(below / rise, T(1));
    end = at_upper ? T(1) : max(above / rise, T(0));
    const T s0 = begin * (T(1) - begin), s1 = end * (T(1) - end);
    const T w0 = T(2) * begin - T(1), w1 = T(2) * end - T(1);
    const T value0 = f.p2 * (T(1) - T(6) * s0) + f.p3 * (w0 * (T(1) - T(10) * s0)),
            value1 = f.p2 * (T(1) - T(6) * s1) + f.p3 * (w1 * (T(1) - T(10) * s1));
    const T slope0 = T(6) * (f.p2 * w0) + T(12) * (f.p3 * (T(1) - T(5) * s0)),
            slope1 = T(6) * (f.p2 * w1) + T(12) * (f.p3 * (T(1) - T(5) * s1));
    // Between its ends a function leaves its chord by width²/8 of its largest second derivative:
    // L2'' = 12, |L3''| <= 60, L3''' = 120. Anywhere, |L2|, |L3| <= 1, |L2'| <= 6, |L3'| <= 12.
    const T square = (end - begin) * (end - begin);
    const T bend = square * (T(15) * a3), steepest = T(6) * a2 + T(12) * a3;
    value = min(max(abs(value0), abs(value1)) + square * (T(1.5) * a2 + T(7.5) * a3), a2 + a3);
    slope_min = max(min(slope0, slope1) - bend, -steepest);
    slope_max = min(max(slope0, slope1) + bend, steepest);
  }
};

/// A part of a cell outside of which nothing absorbs, with the summary of the transfer function
/// over all values of the data and of the part's line.
template <class T>
struct LineWindow {
  LegendreCubic<T> data;
  RangeSummary<T> table;
  LineResidual<T> rest;
  T begin, width;  ///< in the cell, whose line rises
  int interval;    ///< of the table, near the line's lower end
};

/// Returns the smallest such window that a few steps find. A line in a narrower window has a
/// smaller residual and locates the next window better. The window's ends lie on a grid on which
/// they and their midpoint are exact. `interval` is that of data_min, which is at most the smallest
/// value.
template <class T>
PELLUCID_HD LineWindow<T> line_window(
    const LegendreCubic<T>& cell, T data_min, T data_max, int interval,
    const PiecewiseLinear<T>& table,
    const PiecewiseLinearAntiderivative<T>& antiderivative) noexcept {
  T lower = min(data_min, cell.lower()), upper = max(data_max, cell.upper());
  const int first = interval_near(table, lower, interval);
  const RangeSummary<T> over_all =
      range_summary(table, antiderivative,
                    ValueRange<T>(lower, upper, first, interval_below(table, upper, first)));
  const auto rest_of = [](const LegendreCubic<T>& data, const RangeSummary<T>& s) noexcept {
    return LineResidual<T>(data, s.support_min, s.support_max);
  };
  LineWindow<T> window{cell, over_all, rest_of(cell, over_all), T(0), T(1), first};
  constexpr scalar_t<T> grid = 4 * rounding_unit<T>;
  for (int pass = 0; pass < 3; ++pass) {
    const LineResidual<T>& rest = window.rest;
    if (rest.empty || rest.end - rest.begin > T(0.7)) break;
    const bool turned = window.data.reversed != cell.reversed;
    const T from = window.begin + window.width * (turned ? T(1) - rest.end : rest.begin),
            to = window.begin + window.width * (turned ? T(1) - rest.begin : rest.end);
    const T begin = (max(from - T(grid), T(0)) + T(1)) - T(1);
    const T end = (min(to + T(grid), T(1)) + T(1)) - T(1);
    window.begin = begin;
    window.width = end - begin;
    window.data = restrict_to(cell, (begin + end) - T(1), end - begin);
    // If the new line leaves the range, the range grows, including a jump at its end.
    const auto add = [&](T from_value, T to_value) noexcept {
      int i = interval_near(table, from_value, first);
      while (i > 0 && !(table.value[i - 1] < from_value)) --i;
      const ValueRange<T> more(from_value, to_value, i, interval_near(table, to_value, i));
      window.table.merge(range_summary(table, antiderivative, more));
    };
    if (window.data.lower() < lower) {
      add(window.data.lower(), lower);
      lower = window.data.lower();
    }
    if (window.data.upper() > upper) {
      add(upper, window.data.upper());
      upper = window.data.upper();
    }
    window.rest = rest_of(window.data, window.table);
  }
  return window;
}

}  // namespace pellucid
