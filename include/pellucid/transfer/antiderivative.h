// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// The integrals of a transfer function over a range of data values. The default is the empty
/// range.
template <class T>
struct RangeIntegrals {
  T mass{};           ///< ∫ extinction dv
  Rgb<T> emission{};  ///< ∫ extinction · color dv

  PELLUCID_HD void add(const RangeIntegrals& other) noexcept {
    mass += other.mass;
    emission += other.emission;
  }
};

/// The integrals of a transfer function over a range of data values, and bounds on its variation
/// there. Adjacent ranges merge into one; the default is the empty range. A value absorbs if its
/// extinction is positive; colors of values that do not absorb are ignored.
template <class T>
struct RangeSummary {
  RangeIntegrals<T> integral;
  T variation{};  ///< ∫ |extinction'| dv, jumps included
  /// The smallest and the largest extinction'; ∓infinity with a jump, min > max for the empty
  /// range.
  T slope_min = infinity, slope_max = -infinity;
  T color_variation{};  ///< ∫ extinction · |color'| dv (the largest channel), jumps included
  T color_slope{};      ///< largest extinction · |color'|; infinite with a jump
  /// The hull of the absorbing colors; min > max if nothing absorbs.
  Rgb<T> color_min{infinity, infinity, infinity}, color_max{-infinity, -infinity, -infinity};
  /// The smallest and the largest absorbing value; min > max if nothing absorbs.
  T support_min = infinity, support_max = -infinity;

  static constexpr scalar_t<T> infinity = std::numeric_limits<scalar_t<T>>::infinity();

  PELLUCID_HD bool absorbs() const noexcept { return support_min <= support_max; }

  /// Returns the largest difference of two absorbing colors in any channel; 0 if nothing absorbs.
  PELLUCID_HD T color_range() const noexcept {
    const Rgb<T> range = color_max - color_min;
    return max(max(range.r, T(0)), max(range.g, range.b));
  }

  PELLUCID_HD void merge(const RangeSummary& other) noexcept {
    integral.add(other.integral);
    variation += other.variation;
    slope_min = min(slope_min, other.slope_min);
    slope_max = max(slope_max, other.slope_max);
    color_variation += other.color_variation;
    color_slope = max(color_slope, other.color_slope);
    color_min = {min(color_min.r, other.color_min.r), min(color_min.g, other.color_min.g),
                 min(color_min.b, other.color_min.b)};
    color_max = {max(color_max.r, other.color_max.r), max(color_max.g, other.color_max.g),
                 max(color_max.b, other.color_max.b)};
    support_min = min(support_min, other.support_min);
    support_max = max(support_max, other.support_max);
  }
};

/// Adds the integrals over a part of one interval of a transfer function, from the materials at
/// both ends; extinction and color are linear between them. Every term is >= 0 if colors are.
template <class T>
PELLUCID_HD void add_stretch(RangeIntegrals<T>& sum, T width, const Material<T>& a,
                             const Material<T>& b) noexcept {
  sum.mass += width * (T(0.5) * (a.extinction + b.extinction));
  sum.emission += (T(1.0 / 6) * width) * ((T(2) * a.extinction + b.extinction) * a.color +
                                          (a.extinction + T(2) * b.extinction) * b.color);
}

template <class T>
PELLUCID_HD T largest_difference(const Rgb<T>& a, const Rgb<T>& b) noexcept {
  const Rgb<T> d = a - b;
  return max(abs(d.r), max(abs(d.g), abs(d.b)));
}

/// Returns the summary of [lower, upper], lower <= upper, inside one interval between two control
/// points (or its closure), with the materials a and b at the ends. The slopes are those of the
/// whole interval: extinction', and the largest of extinction · |color'|.
template <class T>
PELLUCID_HD RangeSummary<T> stretch_summary(T lower, T upper, const Material<T>& a,
                                            const Material<T>& b, T slope, T color_slope) noexcept {
  RangeSummary<T> s;
  add_stretch(s.integral, upper - lower, a, b);
  s.variation = abs(b.extinction - a.extinction);
  s.slope_min = s.slope_max = slope;
  if (max(a.extinction, b.extinction) > T(0)) {
    s.color_slope = color_slope;
    s.color_variation =
        largest_difference(a.color, b.color) * (T(0.5) * (a.extinction + b.extinction));
    s.color_min = {min(a.color.r, b.color.r), min(a.color.g, b.color.g), min(a.color.b, b.color.b)};
    s.color_max = {max(a.color.r, b.color.r), max(a.color.g, b.color.g), max(a.color.b, b.color.b)};
    s.support_min = lower;
    s.support_max = upper;
  }
  return s;
}

/// The antiderivatives of a transfer function, with the summaries that error bounds need (J. Kniss
/// et al. 2003, equation 5, after N. Max 1990; here summed by intervals).
///
/// A binary tree of summaries: leaf node[leaves + i] is the interval between control points i and
/// i+1, and node[k] merges node[2 k] and node[2 k + 1]. Any run of intervals is the union of at
/// most 2 log2(leaves) nodes. All terms of a sum have the same sign, so that nothing cancels,
/// however short the run is compared to the table. A view; owns nothing. Built by
/// scene/internal/antiderivative_storage.h.
template <class T>
struct PiecewiseLinearAntiderivative {
  const RangeSummary<T>* node = nullptr;  ///< 2 · leaves summaries, node[0] unused
  int leaves = 0;                         ///< control points - 1
  T rounding{};                           ///< relative error of any sum of nodes

  /// Calls visit(node) for nodes that tile the table's intervals first … last - 1, first >= 1, last
  /// <= leaves + 1 (as in PiecewiseLinear::interval(), never the two outer ones).
  template <class Visit>
  PELLUCID_HD void for_each_node(int first, int last, Visit&& visit) const noexcept {
    for (int l = first - 1 + leaves, r = last - 1 + leaves; l < r; l /= 2, r /= 2) {
      if (l % 2 == 1) visit(node[l++]);
      if (r % 2 == 1) visit(node[--r]);
    }
  }
};

/// Returns the interval that contains the values just below v: the number of control points with
/// value < v, but at least `first`. Counts up from `first`, then bisects, because ranges are mostly
/// short.
template <class T>
PELLUCID_HD int interval_below(const PiecewiseLinear<T>& table, T v, int first) noexcept {
  int lo = first, hi = table.count;
  for (const int near = min(first + 8, table.count); lo < near; ++lo) {
    if (!(table.value[lo] < v)) return lo;
  }
  while (lo < hi) {
    const int mid = (lo + hi) / 2;
    if (table.value[mid] < v) {
      lo = mid + 1;
    } else {
      hi = mid;
    }
  }
  return lo;
}

/// Returns table.interval(v), which is expected near `guess`.
template <class T>
PELLUCID_HD int interval_near(const PiecewiseLinear<T>& table, T v, int guess) noexcept {
  int i = guess;
  for (int step = 0; step < 8; ++step) {
    if (i < table.count && table.value[i] <= v) {
      ++i;
    } else if (i > 0 && table.value[i - 1] > v) {
      --i;
    } else {
      return i;
    }
  }
  return table.interval(v);
}

/// A range of more than one value, and the intervals of its ends: first = table.interval(lower),
/// last = interval_below(table, upper, first).
template <class T>
struct ValueRange {
  T lower, upper;
  int first, last;
  PELLUCID_HD ValueRange(const PiecewiseLinear<T>& table, T lo, T hi) noexcept
      : lower(lo), upper(hi), first(table.interval(lo)), last(interval_below(table, hi, first)) {}
  PELLUCID_HD ValueRange(T lo, T hi, int first_interval, int last_interval) noexcept
      : lower(lo), upper(hi), first(first_interval), last(last_interval) {}
};

/// Returns the summary of a range. Largest relative error of the sums: antiderivative.rounding.
template <class T>
PELLUCID_HD RangeSummary<T> range_summary(const PiecewiseLinear<T>& table,
                                          const PiecewiseLinearAntiderivative<T>& antiderivative,
                                          const ValueRange<T>& range) noexcept {
  const auto part = [&](int i, T lower, T upper, const Material<T>& a,
                        const Material<T>& b) noexcept {
    if (i == 0 || i == table.count) return stretch_summary(lower, upper, a, b, T(0), T(0));
    const RangeSummary<T>& whole = antiderivative.node[antiderivative.leaves + i - 1];
    return stretch_summary(lower, upper, a, b, whole.slope_min, whole.color_slope);
  };
  const int first = range.first, last = range.last;
  if (first == last) {
    return part(first, range.lower, range.upper, table.evaluate_in(first, range.lower),
                table.evaluate_in(first, range.upper));
  }
  RangeSummary<T> sum = part(first, range.lower, table.value[first],
                             table.evaluate_in(first, range.lower), table.upper_material(first));
  antiderivative.for_each_node(first + 1, last,
                               [&](const RangeSummary<T>& node) noexcept { sum.merge(node); });
  sum.merge(part(last, table.value[last - 1], range.upper, table.lower_material(last),
                 table.evaluate_in(last, range.upper)));
  return sum;
}

/// Returns the integrals of a range only, with the same error.
template <class T>
PELLUCID_HD RangeIntegrals<T> range_integrals(
    const PiecewiseLinear<T>& table, const PiecewiseLinearAntiderivative<T>& antiderivative,
    const ValueRange<T>& range) noexcept {
  RangeIntegrals<T> sum;
  const int first = range.first, last = range.last;
  if (first == last) {
    add_stretch(sum, range.upper - range.lower, table.evaluate_in(first, range.lower),
                table.evaluate_in(first, range.upper));
    return sum;
  }
  add_stretch(sum, table.value[first] - range.lower, table.evaluate_in(first, range.lower),
              table.upper_material(first));
  antiderivative.for_each_node(
      first + 1, last, [&](const RangeSummary<T>& node) noexcept { sum.add(node.integral); });
  add_stretch(sum, range.upper - table.value[last - 1], table.lower_material(last),
              table.evaluate_in(last, range.upper));
  return sum;
}

}  // namespace pellucid
