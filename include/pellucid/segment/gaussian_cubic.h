// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/segment/gaussian.h"

namespace pellucid {

/// Errors of a Gaussian's mean density over [0, 1] if a line replaces a cubic.
template <class T>
struct LineReplacementError {
  T mean{};      ///< upper bound on |∫ (density of the cubic - density of the line)|
  T absolute{};  ///< upper bound on ∫ |density of the cubic - density of the line|
};

/// A Gaussian primitive along data whose channels are cubics of u in [0, 1]: density(u) =
/// e^(-|p(u)|²), where p(u) = K (v(u) - c) is again a cubic, given by its Bernstein coefficients.
///
/// The least-squares line replaces p (specification, 3.8): end values p̄ ∓ (3/20) (3 (p3 - p0) +
/// (p2 - p1)). The residual is e(u) = q P2(u) + r P3(u), with the Legendre polynomials P on [0,1],
/// the second differences D1, D2 of the coefficients, q = (D1 + D2)/4 and r = (D2 - D1)/20. Hence
/// ∫|e|² = |q|²/5 + |r|²/7 =: N² and |e| <= |q| + |r|.
///
/// Proof of line_replacement_error(). Let φ(x) = e^(-|x|²), and M_k the largest |D^k φ| between the
/// line and the cubic. Derivatives of a symmetric form are largest if all directions agree
/// (Banach), and along a line φ is a Gaussian, so that M_1 = √(2/e), M_2 = 2, M_3 < 3.905; for |x|
/// >= s >= 1 also (2 s, 4 s² + 2, 8 s³ + 12 s) e^(-s²), which decrease from there on.
///   (A) ∫|φ(p) - φ(l)| <= M_1 ∫|e| <= M_1 N.
///   (B) φ(p) - φ(l) = ∇φ(l)·e + R, |R| <= M_2 |e|²/2. As e is orthogonal to linear functions,
///   only the residual of ∇φ(l(u)) from a line matters, whose second derivative is at most
///   M_3 |d|²: its L2 norm is at most M_3 |d|²/(12 √5), as for a parabola, because the kernel of
///   that residual, the Green's function of a clamped beam, is positive. Hence
///   |∫(φ(p) - φ(l))| <= M_3 |d|² N /(12 √5) + M_2 N²/2: fourth order in the width of the panel.
///
/// Most: the largest number of rows.
template <class T, int Most = max_channels>
class GaussianCubic {
 public:
  /// Maps the data to K (v - c). `data` holds one cubic per channel of the primitive.
  template <class S>
  PELLUCID_HD GaussianCubic(const Gaussian<S>& primitive, const CubicBernstein<T>* data) noexcept
      : rows_(primitive.rows) {
    for (int k = 0; k < 4; ++k) {
      T v[max_channels];
      for (int c = 0; c < primitive.channels; ++c) v[c] = data[c].b[k];
      primitive.transform(v, p_[k]);
    }
    bound();
  }
  /// Takes p itself: `first` is p at u = 0, `difference` the differences of consecutive Bernstein
  /// coefficients.
  PELLUCID_HD GaussianCubic(int rows, const T* first, const T (*difference)[Most]) noexcept
      : rows_(rows) {
    for (int i = 0; i < this->rows(); ++i) {
      p_[0][i] = first[i];
      for (int k = 0; k < 3; ++k) p_[k + 1][i] = p_[k][i] + difference[k][i];
    }
    bound();
  }

  /// Return bounds on the exponent |p|² over [0, 1].
  PELLUCID_HD T lower() const noexcept { return lower_; }
  PELLUCID_HD T upper() const noexcept { return upper_; }

  /// A part of [0, 1]; empty if `to` < `from`.
  struct Part {
    T from, to;
  };
  /// Returns a part of [0, 1] outside of which |p| > reach. For the direction n from end to end,
  /// |p| >= |n·p|; from either end n·p approaches 0 at most at three times the largest difference
  /// of its coefficients.
  PELLUCID_HD Part range_within(T reach) const noexcept {
    T n[Most], x[4];
    T square = T(0);
    for (int i = 0; i < rows(); ++i) {
      n[i] = rows() == 1 ? T(1) : p_[3][i] - p_[0][i];
      square = multiply_add(n[i], n[i], square);
    }
    const T scale = rows() == 1 ? T(1) : T(1) / sqrt(max(square, T(smallest_normal<T>)));
    for (int k = 0; k < 4; ++k) x[k] = scale * dot(n, p_[k]);
    // Rounding must not make the band narrower.
    const T band = reach * T(1 + guard) + T(64 * rounding_unit<T>) * sqrt(upper_);
    return {enters(x[0], x[1], x[2], x[3], band), T(1) - enters(x[3], x[2], x[1], x[0], band)};
  }

  /// The least-squares line and its residual.
  struct Line {
    T front[Most], back[Most], d[Most];
    T squared_length{};  ///< |d|²
    T squared_norm{};    ///< N²
    T farthest{};        ///< |q| + |r|
  };
  PELLUCID_HD Line line() const noexcept {
    Line l;
    T qq = T(0), rr = T(0);
    for (int i = 0; i < rows(); ++i) {
      const T d0 = p_[1][i] - p_[0][i], d1 = p_[2][i] - p_[1][i], d2 = p_[3][i] - p_[2][i];
      const T mean = T(0.25) * ((p_[0][i] + p_[3][i]) + (p_[1][i] + p_[2][i]));
      const T half = T(0.15) * (T(3) * (d0 + d1 + d2) + d1);
      l.front[i] = mean - half;
      l.back[i] = mean + half;
      l.d[i] = T(2) * half;
      l.squared_length += l.d[i] * l.d[i];
      const T first = d1 - d0, second = d2 - d1;
      const T q = T(0.25) * (first + second), r = T(0.05) * (second - first);
      qq += q * q;
      rr += r * r;
    }
    l.squared_norm = T(0.2) * qq + T(1.0 / 7) * rr;
    l.farthest = sqrt(qq) + sqrt(rr);
    return l;
  }
  PELLUCID_HD T mean_density(const Line& l) const noexcept {
    return gaussian_mean_density(l.front, l.back, l.d, rows());
  }
  PELLUCID_HD LineReplacementError<T> line_replacement_error(const Line& l) const noexcept {
    T m1 = T(0.857764), m2 = T(2), m3 = T(3.905);
    const T s = max(sqrt(lower_) - l.farthest, T(0));
    const auto away = s >= T(1);
    if (any(away)) {
      const T far = select(away, exp(-(s * s)), T(largest<T>));
      const T s2 = max(s * s, T(1));
      m1 = min(m1, T(2) * max(s, T(1)) * min(far, T(1e9)));
      m2 = min(m2, (T(4) * s2 + T(2)) * min(far, T(1e9)));
      m3 = min(m3, (T(8) * s2 + T(12)) * max(s, T(1)) * min(far, T(1e9)));
    }
    const T norm = sqrt(l.squared_norm);
    const T absolute = min(m1 * norm, T(1));
    // 1/(12 √5) = 0.0372678
    const T second_order = T(0.03727) * m3 * l.squared_length * norm + T(0.5) * m2 * l.squared_norm;
    return {min(absolute, second_order), absolute};
  }

  /// Returns the slope of the exponent |front|² + slope u + |d|² u² along the line.
  PELLUCID_HD T slope(const Line& l) const noexcept { return T(2) * dot(l.front, l.d); }

 private:
  PELLUCID_HD constexpr int rows() const noexcept { return Most == 1 ? 1 : rows_; }

  PELLUCID_HD T dot(const T* a, const T* b) const noexcept {
    T sum = T(0);
    for (int i = 0; i < rows(); ++i) sum = multiply_add(a[i], b[i], sum);
    return sum;
  }

  PELLUCID_HD void bound() noexcept {
    upper_ = T(0);
    for (int k = 0; k < 4; ++k) upper_ = max(upper_, dot(p_[k], p_[k]));
    lower_ = rows() == 1 ? squared_gap() : squared_distance();
  }

  static constexpr scalar_t<T> guard = max(scalar_t<T>(1e-9), 8 * rounding_unit<T>);

  /// Returns the earliest position at which a cubic with these coefficients can be within the band.
  PELLUCID_HD static T enters(T a, T b, T c, T d, T band) noexcept {
    const T sign = select(a < T(0), T(-1), T(1));
    const T above = sign * a - band;
    const T rate = T(3) * max(sign * (a - b), max(sign * (b - c), sign * (c - d)));
    return select(above > T(0), above / max(rate, T(smallest_normal<T>)) * T(1 - guard), T(0));
  }

  /// Returns the squared distance of 0 from the range of the coefficients, for one row.
  PELLUCID_HD T squared_gap() const noexcept {
    const T lower = min(min(p_[0][0], p_[3][0]), min(p_[1][0], p_[2][0]));
    const T upper = max(max(p_[0][0], p_[3][0]), max(p_[1][0], p_[2][0]));
    const T gap = max(T(0), max(lower, -upper));
    return gap * gap;
  }

  /// Returns a lower bound on the squared distance of the coefficients' hull from 0. The hull lies
  /// beyond the plane perpendicular to any x at min p_k·x / |x| (Gilbert 1966); x is the mean of
  /// the coefficients. For at most two in five random curves it is below 0.8 of the square, and it
  /// is 0 if the mean is no direction away from all of them; asserted in tests/segment.
  PELLUCID_HD T squared_distance() const noexcept {
    T x[Most];
    for (int i = 0; i < rows(); ++i) {
      x[i] = T(0.25) * ((p_[0][i] + p_[3][i]) + (p_[1][i] + p_[2][i]));
    }
    const T xx = dot(x, x);
    const T least = min(min(dot(p_[0], x), dot(p_[3], x)), min(dot(p_[1], x), dot(p_[2], x)));
    // Rounding of the products must not raise the bound.
    const T ahead = max(least - T(16 * rounding_unit<T>) * sqrt(upper_ * xx), T(0));
    return min(ahead * (ahead / max(xx, T(smallest_normal<T>))) * T(1 - 64 * rounding_unit<T>),
               upper_);
  }

  int rows_;
  T p_[4][Most];
  T lower_, upper_;
};

/// Returns the primitive along the data of all channels.
template <class S, class T>
PELLUCID_HD GaussianCubic<T> gaussian_along(const Gaussian<S>& primitive,
                                            const CubicBernstein<T>* data) noexcept {
  return {primitive, data};
}

}  // namespace pellucid
