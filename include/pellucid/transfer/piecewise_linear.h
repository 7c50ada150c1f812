// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/rgb.h"

namespace pellucid {

/// Extinction and color of a transfer function at one data value.
template <class T>
struct Material {
  T extinction{};  ///< 1/length, >= 0
  Rgb<T> color{};  ///< of the particles, linear, not premultiplied; the source is color ·
                   ///< extinction
};

/// A one-dimensional transfer function, linear between control points and constant outside of them.
/// A view; owns nothing, so that a device can hold it too.
///
/// The owner has checked that count >= 1, values ascend, at most two are equal (a jump; the right
/// one holds at the value itself), all numbers are finite and no extinction is negative. Interval
/// i, 0 <= i <= count, lies between point i-1 and point i; 0 and count are the outer intervals.
template <class T>
struct PiecewiseLinear {
  const T* value = nullptr;               ///< count data values, ascending
  const Material<T>* material = nullptr;  ///< count materials
  int count = 0;

  /// Returns the interval that contains v: the number of control points with value <= v.
  PELLUCID_HD int interval(scalar_t<T> v) const noexcept {
    int lo = 0, hi = count;
    while (lo < hi) {
      const int mid = (lo + hi) / 2;
      if (value[mid] <= v) {
        lo = mid + 1;
      } else {
        hi = mid;
      }
    }
    return lo;
  }

  /// Returns the material at v, which lies in interval i or on its closure (the limit from inside).
  /// Interpolates from the nearer control point: numbers that vanish there keep their relative
  /// precision nearby, and control points give their material exactly.
  PELLUCID_HD Material<T> evaluate_in(int i, T v) const noexcept {
    if (i == 0) return material[0];
    if (i == count) return material[count - 1];
    const T below = v - value[i - 1], above = value[i] - v, width = value[i] - value[i - 1];
    const auto lower = below <= above;
    const T s = clamp(select(lower, below, above) / width, T(0), T(1));
    const Material<T>&a = lower ? material[i - 1] : material[i],
          &b = lower ? material[i] : material[i - 1];
    return {a.extinction + s * (b.extinction - a.extinction), a.color + s * (b.color - a.color)};
  }

  PELLUCID_HD Material<T> evaluate(T v) const noexcept { return evaluate_in(interval(v), v); }

  /// Return the materials at the ends of interval i, as limits from inside; equal for an outer
  /// interval.
  PELLUCID_HD const Material<T>& lower_material(int i) const noexcept {
    return material[max(i - 1, 0)];
  }
  PELLUCID_HD const Material<T>& upper_material(int i) const noexcept {
    return material[min(i, count - 1)];
  }

  /// Returns whether extinction and color are constant in the intervals first … last (0 <= first <=
  /// last <= count).
  bool is_constant(int first, int last) const noexcept {
    const int end = min(last, count - 1);
    const Material<T>& m = material[max(first - 1, 0)];
    for (int j = max(first, 1); j <= end; ++j) {
      const Material<T>& other = material[j];
      if (other.extinction != m.extinction || other.color.r != m.color.r ||
          other.color.g != m.color.g || other.color.b != m.color.b) {
        return false;
      }
    }
    return true;
  }

  /// Returns whether anything absorbs in the intervals first … last (0 <= first <= last <= count).
  PELLUCID_HD bool has_extinction(int first, int last) const noexcept {
    const int end = min(last, count - 1);
    for (int j = max(first - 1, 0); j <= end; ++j) {
      if (material[j].extinction > 0) return true;
    }
    return false;
  }
};

}  // namespace pellucid
