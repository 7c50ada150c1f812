// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/bounds.h"
#include "pellucid/segment/bounded.h"
#include "pellucid/segment/constant.h"
#include "pellucid/segment/line_error.h"
#include "pellucid/segment/piecewise_linear.h"

namespace pellucid {

/// A segment with proved bounds on its errors, rounding included.
template <class T>
using LineResult = BoundedSegment<T>;

namespace detail {

/// Returns a segment of a single color with error `color_error`; the weighting by transparency adds
/// the error of (5).
template <class T>
PELLUCID_HD LineResult<T> mean_result(T length, T extinction, Rgb<T> color, T extinction_error,
                                      T color_error, T color_range) noexcept {
  constexpr scalar_t<T> u = rounding_unit<T>;
  const T depth = length * extinction;
  const T depth_error = length * extinction_error + T(2 * u) * depth;
  LineResult<T> result;
  result.segment = segment_of_depth(depth, color);
  result.opacity_error = opacity_error_bound(result.segment, depth_error);
  const T weighting = color_range * mean_color_bound(depth + depth_error);
  result.color_error =
      result.segment.opacity * (T(1 + 16 * u) * min(weighting + color_error, color_range) +
                                T(4 * u) * largest_component(color));
  return result;
}

/// Returns the segment of data in one interval of the table: extinction and color are linear in the
/// data, and the mean of their product follows from the variance of the data, p1²/3 + p2²/5 +
/// p3²/7.
template <class T>
PELLUCID_HD LineResult<T> mean_in_interval(const LegendreCubic<T>& f, T data_range, T length,
                                           const PiecewiseLinear<T>& table, int interval) noexcept {
  constexpr scalar_t<T> u = rounding_unit<T>;
  const Material<T> m = table.evaluate_in(interval, f.mean);
  if (interval == 0 || interval == table.count) {
    return mean_result(length, m.extinction, m.color, T(0), T(0), T(0));
  }
  const Material<T>&from = table.material[interval - 1], &to = table.material[interval];
  const T width = table.value[interval] - table.value[interval - 1];
  const T slope = (to.extinction - from.extinction) / width;
  const T variance =
      T(1.0 / 3) * (f.p1 * f.p1) + T(0.2) * (f.p2 * f.p2) + T(1.0 / 7) * (f.p3 * f.p3);
  const Rgb<T> change = to.color - from.color;
  const T share_range = min(data_range / width, T(1));
  // How far the weighting by extinction moves the mean share: by no more than the share varies.
  const T relative_slope = m.extinction > T(0) ? slope / m.extinction : T(0);
  const T shift = clamp(relative_slope * variance / width, -share_range, share_range);
  const T spread = T(2) * (f.p1 + abs(f.p2) + abs(f.p3));
  const T share_error =
      (T(1) + abs(relative_slope) * (share_range * width + spread)) / width * f.rounding +
      T(16 * u) * share_range;
  const T color_error = share_error * largest_component(change) +
                        T(4 * u) * max(largest_component(from.color), largest_component(to.color));
  return mean_result(length, m.extinction, m.color + shift * change,
                     abs(slope) * f.rounding + T(8 * u) * m.extinction, color_error,
                     share_range * largest_component(change));
}

/// The intermediate results that both line rules share.
template <class T>
struct LineStretch {
  const LineWindow<T>& window;
  LineMean<T> mean;
  LineError<T> error;
  T length;  ///< of the window

  PELLUCID_HD LineStretch(const LineWindow<T>& w, T cell_length, const PiecewiseLinear<T>& table,
                          const PiecewiseLinearAntiderivative<T>& antiderivative) noexcept
      : window(w),
        mean(line_mean(w, table, antiderivative)),
        error(line_error(w, mean, table, antiderivative)),
        length(w.width * cell_length) {}
};

template <class T>
PELLUCID_HD LineResult<T> line_mean_result(const LineStretch<T>& line, T rounding) noexcept {
  const RangeSummary<T>& all = line.window.table;
  const T range = all.color_range(),
          size = max(largest_component(all.color_min), largest_component(all.color_max));
  const T color_error = line.mean.extinction > T(0)
                            ? line.error.color / line.mean.extinction + rounding * size
                            : range;
  return mean_result(line.length, line.mean.extinction, line.mean.color, line.error.extinction,
                     color_error, range);
}

template <class T>
PELLUCID_HD LineResult<T> line_emission_result(const LineStretch<T>& line,
                                               const PiecewiseLinear<T>& table) noexcept {
  const LineMean<T>& mean = line.mean;
  const LineError<T>& error = line.error;
  const T part = line.length;
  const RangeSummary<T>& all = line.window.table;
  const LegendreCubic<T>& f = line.window.data;
  LineResult<T> result;
  // The rise that a line inside of the window has as rounded may not be its own.
  result.segment = piecewise_linear_segment(
      table, f.reversed ? f.upper() : f.lower(), f.reversed ? f.lower() : f.upper(),
      mean.first == mean.last ? part : part * ((f.upper() - f.lower()) / mean.rise));
  const SegmentResult<T>& s = result.segment;
  const T rounding = static_cast<T>(24 + 3 * (mean.last - mean.first)) * T(rounding_unit<T>);
  result.opacity_error =
      opacity_error_bound(s, part * error.extinction + rounding * s.optical_depth) +
      rounding * s.opacity;

  const auto exp_minus_1 = [](T x) noexcept {  // on [0,1], from above
    return x <= T(1) ? x + T(0.71828183) * (x * x) : RangeSummary<T>::infinity;
  };
  const T range = all.color_range();
  const T by_parts = part * error.part_emission + range * (s.opacity + result.opacity_error) *
                                                      exp_minus_1(part * error.part_extinction);
  T by_values = RangeSummary<T>::infinity;
  if (error.ratio < T(1)) {
    const T r = error.ratio, more = T(1) / (T(1) - r);
    const T ends = part * error.ends, moved = exp_minus_1(ends);
    const T thick = r * s.opacity + (T(1) + r) * ((T(1) + moved) * (r * more) + moved * s.opacity);
    const T thin = T(0.5) * (s.opacity + result.opacity_error) *
                   (error.spread + more * exp_minus_1(r * s.optical_depth + ends));
    by_values = range * (min(thin, thick) + ends * more);
  }
  const T size = max(largest_component(all.color_min), largest_component(all.color_max));
  result.color_error = (T(1) + rounding) * min(min(by_parts, by_values), range * s.opacity) +
                       T(2) * rounding * size * s.opacity;
  return result;
}

}  // namespace detail

/// Computes the first of line_rule() and line_emission_rule() whose result satisfies
/// `fits(LineResult<T>)`; returns false if none does. Shared intermediate results are computed
/// once. The second rule is skipped if the line crosses so many control points that it would not be
/// cheap.
template <class T, class Fits>
PELLUCID_HD bool select_line_rule(const CubicBernstein<T>& data, T length,
                                  const PiecewiseLinear<T>& table,
                                  const PiecewiseLinearAntiderivative<T>& antiderivative,
                                  LineResult<T>& result, Fits&& fits) noexcept {
  const LegendreCubic<T> cell = legendre(data);
  const T data_min = data.hull_min(), data_max = data.hull_max();
  const int near = table.interval(data_min);
  const bool one_interval = interval_below(table, data_max, near) == near;
  if (one_interval) {
    result = detail::mean_in_interval(cell, data_max - data_min, length, table, near);
    if (fits(result)) return true;
  }
  const LineWindow<T> window = line_window(cell, data_min, data_max, near, table, antiderivative);
  if (window.rest.empty) {
    result = {};
    return true;
  }
  const detail::LineStretch<T> line(window, length, table, antiderivative);
  if (!one_interval) {
    result = detail::line_mean_result(line, antiderivative.rounding);
    if (fits(result)) return true;
  }
  constexpr int max_intervals = 16;
  if (line.mean.last - line.mean.first >= max_intervals) return false;
  result = detail::line_emission_result(line, table);
  return fits(result);
}

/// Integrates the volume rendering integral (particle model) over cubic data, as in a trilinear
/// cell, through a piecewise-linear transfer function, with a line in place of the cubic. It needs
/// neither roots nor cuts at control points; jumps are allowed.
///
/// The line is the least-squares line of the part of the segment outside of which nothing absorbs.
/// Its depth comes from antiderivatives of the extinction, its color is the mean weighted by
/// extinction. The depth is exact for linear data, and for data in one interval of the table.
/// line_error() bounds the errors of the line, (5) those of the weighting by transparency, with the
/// range of the absorbing colors.
///
/// Preconditions: length >= 0, finite data with finite differences, finite mass of the table and
/// finite depth. The bounds hold except for contributions below the smallest normal number.
/// Asserted in tests/segment.
template <class T>
PELLUCID_HD LineResult<T> line_rule(
    const CubicBernstein<T>& data, T length, const PiecewiseLinear<T>& table,
    const PiecewiseLinearAntiderivative<T>& antiderivative) noexcept {
  LineResult<T> result;
  select_line_rule(data, length, table, antiderivative, result,
                   [](const LineResult<T>&) noexcept { return true; });
  return result;
}

/// Integrates the same line exactly: cut at the control points that the line crosses. It adds what
/// the mean color misses if colors vary over a depth that is not small.
///
/// With the notation of line_error(), the depths a_l and a_f in front, the true color c and H =
/// extinction · (color - c), the line's opacity times the error of its color is the integral E of
/// H(l) e^(-a_l) - H(f) e^(-a_f).
///
/// By (a), (b): E = ∫ (H(l) - H(f)) e^(-a_l) dt + ∫ H(f) (e^(-a_l) - e^(-a_f)) dt. By the second
/// mean value theorem the first is at most part_emission, and the second at most ω · (true opacity)
/// · (e^δ - 1), with δ the largest |a_l - a_f|, part_extinction.
///
/// By (c), with the value in place of t: a value that both have adds H (e^(-a_l) - w e^(-a_f)) da_l
/// / extinction to E, with |w - 1| <= ratio and |a_f - a_l| <= ratio · a_l + ends. With |1 - w e^x|
/// <= |w - 1| + w (e^|x| - 1), and r/(1 - r) for the integral of (e^(r a) - 1) e^(-a) over all a >
/// 0, this bounds E if depths are large. If not, exchange f and l and subtract a multiple of the
/// integral of H(f) e^(-a_f), which is 0 while that of its absolute value is at most ω/2 · (true
/// opacity). Values that only one of them has add at most ω · ends/(1 - ratio).
template <class T>
PELLUCID_HD LineResult<T> line_emission_rule(
    const CubicBernstein<T>& data, T length, const PiecewiseLinear<T>& table,
    const PiecewiseLinearAntiderivative<T>& antiderivative) noexcept {
  const T data_min = data.hull_min();
  const LineWindow<T> window = line_window(legendre(data), data_min, data.hull_max(),
                                           table.interval(data_min), table, antiderivative);
  if (window.rest.empty) return {};
  return detail::line_emission_result(detail::LineStretch<T>(window, length, table, antiderivative),
                                      table);
}

}  // namespace pellucid
