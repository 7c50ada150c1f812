// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/gaussian.h"

namespace pellucid {

/// A Gaussian primitive along linear data, however many channels it has: with the signed distance x
/// = a + u length from the closest approach,
///
///   density(u) = e^(-perpendicular - x²).
///
/// For repeated evaluation of parts of a segment. The exponent is a sum of squares; its error is
/// the rounding of a and b, which is that of K (v - c).
template <class T>
struct GaussianLine {
  T a{}, b{};         ///< x at the front and at the back, in widths
  T length{};         ///< |d| = b - a
  T perpendicular{};  ///< the squared distance of the line from the center

  GaussianLine() = default;
  PELLUCID_HD GaussianLine(const T* p1, const T* p2, const T* d, int rows) noexcept {
    const detail::Direction<T> direction(d, rows);
    a = direction.along(p1, rows);
    b = direction.along(p2, rows);
    length = direction.length;
    perpendicular = direction.perpendicular(p1, p2, a, b, rows);
  }

  /// Returns x at u, computed from the nearer end.
  PELLUCID_HD T position(T u) const noexcept {
    return select(u <= T(0.5), a + u * length, b - (T(1) - u) * length);
  }
  /// Returns the density at u.
  PELLUCID_HD T density(T u) const noexcept {
    const T x = position(u);
    return exp(-(perpendicular + x * x));
  }
  /// Returns the u of the closest approach: outside of [0, 1] if the segment does not contain it,
  /// and not finite for a point.
  PELLUCID_HD T closest() const noexcept {
    return select(abs(a) <= abs(b), -a / length, T(1) - b / length);
  }
  /// Returns the smallest exponent over x between x0 and x1.
  PELLUCID_HD T least_exponent(T x0, T x1) const noexcept {
    const T distance = max(T(0), max(x0, -x1));
    return perpendicular + distance * distance;
  }

  /// Returns the mean density over u in [from, to]. Largest error as gaussian_mean_density(): 8 u
  /// absolute and the relative error stated there; asserted in tests/segment.
  PELLUCID_HD T mean_density(T from, T to) const noexcept {
    const T x0 = position(from), x1 = position(to), part = (to - from) * length;
    const T g = T(0.5) * (part * part), h = part * (T(0.5) * x0 + T(0.5) * x1);
    const T square_0 = perpendicular + x0 * x0, square_1 = perpendicular + x1 * x1;
    const auto is_short = max(g, abs(h)) <= T(1);
    T mean = T(0);
    if (any(is_short)) mean = detail::short_gaussian_density(square_0, square_1, g, h);
    if (!all(is_short)) {
      const T beyond = detail::long_gaussian_density(square_0, square_1, x0, x1, part,
                                                     [&] { return perpendicular; });
      mean = select(is_short, mean, beyond);
    }
    return clamp(mean, T(0), T(1));
  }
};

}  // namespace pellucid
