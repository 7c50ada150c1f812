// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/error_function.h"
#include "pellucid/segment/linear.h"
#include "pellucid/transfer/gaussian.h"

namespace pellucid {

namespace detail {

/// Returns e^(-(s1 + s2)/2) F(h², g), equation (15): the mean of a Gaussian over a segment that is
/// short compared to its widths, with squares s1 and s2 at the ends; max(g, |h|) <= 1.
template <class T>
PELLUCID_HD T short_gaussian_density(T square_1, T square_2, T g, T h) noexcept {
  const ThinSums<T> sums(abs(h), g, max(g, abs(h)));
  return exp(-(T(0.5) * square_1 + T(0.5) * square_2)) * (sums.b0 + g * sums.f1);
}

/// Returns the mean over a segment that is not short, √π/2 (Φ(b) - Φ(a)) / |d|, from the tails
/// beyond its ends, tail = ρ_end erfcx|end|.
///
/// If the closest approach is outside (a, b of one sign), it is the difference of the tails, whose
/// ratio is below e^-2. If the segment contains it, the sum is S erf|a| + S erf|b|, with S = ρ at
/// the closest approach and S erf(x) = S - tail from x = 1 on.
///
/// `perpendicular()` returns -ln S; it is called only if a lane contains the closest approach.
template <class T, class Perpendicular>
PELLUCID_HD T long_gaussian_density(T square_1, T square_2, T a, T b, T length,
                                    const Perpendicular& perpendicular) noexcept {
  const T x1 = abs(a), x2 = abs(b);
  const T tail_1 = exp(-square_1) * erfcx_nonnegative(x1);
  const T tail_2 = exp(-square_2) * erfcx_nonnegative(x2);
  const auto crossing = min(b, -a) > T(0);
  T sum = abs(tail_1 - tail_2);
  if (any(crossing)) {
    const T top = exp(-perpendicular());
    // Beyond 1 the polynomial is not used.
    const T y1 = min(x1, T(1)), y2 = min(x2, T(1));
    const T part_1 = select(x1 < T(1), top * (y1 * erf_over_x(y1 * y1)), top - tail_1);
    const T part_2 = select(x2 < T(1), top * (y2 * erf_over_x(y2 * y2)), top - tail_2);
    sum = select(crossing, part_1 + part_2, sum);
  }
  return T(half_sqrt_pi<T>) * sum / max(length, T(smallest_normal<T>));
}

/// d as a unit vector and its length, scaled by the largest component so that no square over- or
/// underflows. d = 0 has unit vector 0.
template <class T>
struct Direction {
  T unit[max_channels];
  T length;
  PELLUCID_HD Direction(const T* d, int rows) noexcept {
    T scale = T(smallest_normal<T>);
    for (int k = 0; k < rows; ++k) scale = max(scale, abs(d[k]));
    T square = T(0);
    for (int k = 0; k < rows; ++k) {
      unit[k] = d[k] / scale;
      square = multiply_add(unit[k], unit[k], square);
    }
    const T norm = sqrt(square);
    const T inverse = T(1) / max(norm, T(smallest_normal<T>));
    for (int k = 0; k < rows; ++k) unit[k] *= inverse;
    length = scale * norm;
  }
  /// Returns the component of p along the direction.
  PELLUCID_HD T along(const T* p, int rows) const noexcept {
    T sum = T(0);
    for (int k = 0; k < rows; ++k) sum = multiply_add(unit[k], p[k], sum);
    return sum;
  }

  /// Returns the squared distance of the line from the center, computed from the end that is nearer
  /// to the closest approach and orthogonalised twice.
  PELLUCID_HD T perpendicular(const T* p1, const T* p2, T a, T b, int rows) const noexcept {
    const auto first = abs(a) <= abs(b);
    const T along_it = select(first, a, b);
    T w[max_channels];
    for (int k = 0; k < rows; ++k) w[k] = select(first, p1[k], p2[k]) - along_it * unit[k];
    const T rest = along(w, rows);
    T square = T(0);
    for (int k = 0; k < rows; ++k) {
      w[k] -= rest * unit[k];
      square = multiply_add(w[k], w[k], square);
    }
    return square;
  }
};

}  // namespace detail

/// Returns the mean of e^(-|p|²) along the straight segment from p1 to p2 = p1 + d, all of `rows`
/// <= 8 numbers: ∫₀¹ e^(-|p1 + u d|²) du (specification, 3.4). d is a separate argument, because p2
/// - p1 has lost its digits where both are large; see Gaussian::displacement().
///
/// Three regimes: a short segment (|d|² <= 2 and |d·(p1 + p2)| <= 2) uses the entire function of
/// 3.3 without a division by |d|; a segment across the closest approach uses positive terms only;
/// otherwise the difference of scaled tails, which is safe. d = 0, ends far in one tail and the
/// order of the ends are no special cases; lanes in different regimes execute the same steps.
///
/// Largest error: 8 u absolute, and 4 u (1 + 2 l + 2 √(1+l) η) relative, with l = |ln| of the
/// result and η = max |K| |v - c| from which the p_i are computed (for results >= 1e-30 in float,
/// 1e-290 in double); always in [0, 1]. Asserted in tests/segment and tests/simd.
template <class T>
PELLUCID_HD T gaussian_mean_density(const T* p1, const T* p2, const T* d, int rows) noexcept {
  T square_1 = T(0), square_2 = T(0), g = T(0), h = T(0);
  for (int k = 0; k < rows; ++k) {
    square_1 = multiply_add(p1[k], p1[k], square_1);
    square_2 = multiply_add(p2[k], p2[k], square_2);
    g = multiply_add(d[k], d[k], g);
    h = multiply_add(d[k], T(0.5) * p1[k] + T(0.5) * p2[k], h);
  }
  g *= T(0.5);
  const auto is_short = max(g, abs(h)) <= T(1);
  T mean = T(0);
  if (any(is_short)) {
    mean = detail::short_gaussian_density(square_1, square_2, g, h);
  }
  if (!all(is_short)) {
    const detail::Direction<T> direction(d, rows);
    const T a = direction.along(p1, rows), b = direction.along(p2, rows);
    const T beyond = detail::long_gaussian_density(square_1, square_2, a, b, direction.length, [&] {
      return direction.perpendicular(p1, p2, a, b, rows);
    });
    mean = select(is_short, mean, beyond);
  }
  return clamp(mean, T(0), T(1));
}

/// Returns the mean density of a primitive along data that are linear from v1 (front) to v2.
template <class S, class T>
PELLUCID_HD T gaussian_mean_density(const Gaussian<S>& primitive, const T* v1,
                                    const T* v2) noexcept {
  T p1[max_channels], p2[max_channels], d[max_channels];
  primitive.transform(v1, p1);
  primitive.transform(v2, p2);
  primitive.displacement(v1, v2, d);
  return gaussian_mean_density(p1, p2, d, primitive.rows);
}

/// Returns the exact segment of one primitive along linear data; its color is constant
/// (specification, equation 14). With the relative error R of the mean density and the depth m, the
/// opacity is within m e^-m R + 4 u, asserted in tests/segment.
template <class S, class T>
PELLUCID_HD SegmentResult<T> gaussian_segment(const Gaussian<S>& primitive, const T* v1,
                                              const T* v2, T length) noexcept {
  const Rgb<S>& c = primitive.color;
  return segment_of_depth((T(primitive.peak) * length) * gaussian_mean_density(primitive, v1, v2),
                          Rgb<T>{T(c.r), T(c.g), T(c.b)});
}

/// Returns the charge for the relative error of gaussian_mean_density(): the R of the specification
/// (3.4), 16 u (1 + 2 l + 2 √(1+l) η), four times the asserted error. Infinite for a mean of 0.
template <class S, class T>
PELLUCID_HD T gaussian_rounding(const Gaussian<S>& primitive, const T* v1, const T* v2,
                                T mean_density) noexcept {
  T square_1 = T(0), square_2 = T(0);
  for (int i = 0; i < primitive.rows; ++i) {
    T sum_1 = T(0), sum_2 = T(0);
    for (int k = 0; k < primitive.channels; ++k) {
      const T entry = abs(T(primitive.matrix[i][k]));
      sum_1 += entry * abs(v1[k] - T(primitive.center[k]));
      sum_2 += entry * abs(v2[k] - T(primitive.center[k]));
    }
    square_1 += sum_1 * sum_1;
    square_2 += sum_2 * sum_2;
  }
  const T l = abs(log(mean_density));
  const T reach = sqrt(max(square_1, square_2));
  return T(16 * rounding_unit<T>) * (T(1) + T(2) * l + T(2) * (sqrt(T(1) + l) * reach));
}

}  // namespace pellucid
