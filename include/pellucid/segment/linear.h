// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/scaled_tail.h"
#include "pellucid/segment/constant.h"

namespace pellucid {

/// The weights of a segment with linear extinction for a color that is linear along it:
///
///   radiance = color_f · weight_f + color_b · weight_b
///
/// with psi = ∫₀¹ transparency(u) du, weight_f = 1 - psi and weight_b = psi - transparency, both
/// non-negative, and weight_f + weight_b = opacity (specification, equation 4).
template <class T>
struct LinearWeights {
  T optical_depth{};
  T opacity{};
  T transparency = T(1);
  T psi = T(1);
  T weight_f{}, weight_b{};
};

/// The weights of a segment with linear extinction for an independent emission that is linear along
/// it: radiance = length · (emission_f · weight_f + emission_b · weight_b).
template <class T>
struct EmissionWeights {
  T optical_depth{};
  T opacity{};
  T transparency = T(1);
  T weight_f = T(0.5);  ///< ∫₀¹ (1-u) transparency(u) du
  T weight_b = T(0.5);  ///< ∫₀¹ u transparency(u) du
};

namespace detail {

/// h = (x_f + x_b)/4, half of the optical depth, and g = (x_b - x_f)/4, with x = extinction ·
/// length. The difference is taken before the product: equal ends give g = 0 exactly. Terms are
/// halved first, so that the sum cannot overflow.
template <class T>
struct LinearRates {
  T x_f, x_b, h, g;
  PELLUCID_HD LinearRates(T extinction_f, T extinction_b, T length) noexcept
      : x_f(extinction_f * length),
        x_b(extinction_b * length),
        h(T(0.5) * ((T(0.5) * extinction_f + T(0.5) * extinction_b) * length)),
        g(T(0.5) * ((T(0.5) * extinction_b - T(0.5) * extinction_f) * length)) {}
};

/// The sums of the thin form (8)-(10): b0 = sinh(h)/h, H1 = cosh(h) - b0 and F1 = Σ g^k b_{k+1}, by
/// the two-term recurrence of section 3.3 with c_n = 1/(2n+1)!!.
template <class T>
struct ThinSums {
  T b0, h1, f1;
  PELLUCID_HD ThinSums(T h, T g) noexcept : ThinSums(h, g, h) {}
  /// Sums the series. `reach` >= max(h, |g|), for arguments with |g| above h; h >= 0.
  PELLUCID_HD ThinSums(T h, T g, T reach) noexcept {
    // With r = reach the tail of F1 after N terms is below r^N e^{r/2}/(2N+3)!! (proof in 3.3):
    // N = 8 and 15 leave less than u/10 of the weights up to r = 1, N = 4 and 8 up to r = 0.05.
    // There each omitted term is below half a unit in the last place of its sum, so that adding it
    // changes nothing: a lane's result does not depend on its neighbors. b0 and H1 are even in h
    // and end sooner.
    if (all(reach <= T(0.05))) {
      add<is_single<T> ? 2 : 4, is_single<T> ? 4 : 8>(h, g);
    } else {
      add<is_single<T> ? 5 : 9, is_single<T> ? 8 : 15>(h, g);
    }
  }

 private:
  template <int even_terms, int terms>
  PELLUCID_HD void add(T h, T g) noexcept {
    using S = scalar_t<T>;
    // 1/n, c_n and 2 n c_n for n = 1 … 15.
    static constexpr S inverse[15] = {S(1.0),        S(1.0 / 2.0),  S(1.0 / 3.0),  S(1.0 / 4.0),
                                      S(1.0 / 5.0),  S(1.0 / 6.0),  S(1.0 / 7.0),  S(1.0 / 8.0),
                                      S(1.0 / 9.0),  S(1.0 / 10.0), S(1.0 / 11.0), S(1.0 / 12.0),
                                      S(1.0 / 13.0), S(1.0 / 14.0), S(1.0 / 15.0)};
    static constexpr S c[15] = {S(1.0 / 3.0),
                                S(1.0 / 15.0),
                                S(1.0 / 105.0),
                                S(1.0 / 945.0),
                                S(1.0 / 10395.0),
                                S(1.0 / 135135.0),
                                S(1.0 / 2027025.0),
                                S(1.0 / 34459425.0),
                                S(1.0 / 654729075.0),
                                S(1.0 / 13749310575.0),
                                S(1.0 / 316234143225.0),
                                S(1.0 / 7905853580625.0),
                                S(1.0 / 213458046676875.0),
                                S(1.0 / 6190283353629375.0),
                                S(1.0 / 191898783962510625.0)};
    const T y = T(0.5) * (h * h);
    T power = T(1), p = T(1), b = T(0), sum_h = T(0), sum_f = T(0);
    for (int n = 1; n <= even_terms; ++n) {
      sum_f = multiply_add(T(c[n - 1]), p, sum_f);
      power *= y * T(inverse[n - 1]);
      p = multiply_add(g, p, power);
      const T term = T(c[n - 1]) * power;
      b += term;
      sum_h = multiply_add(T(S(2 * n)), term, sum_h);
    }
    for (int n = even_terms + 1; n <= terms; ++n) {
      sum_f = multiply_add(T(c[n - 1]), p, sum_f);
      power *= y * T(inverse[n - 1]);
      p = multiply_add(g, p, power);
    }
    b0 = T(1) + b;
    h1 = sum_h;
    f1 = sum_f;
  }
};

/// Returns W of rising extinction (scaled erfc) in the lanes of `rising`, of falling extinction
/// (Dawson) elsewhere.
template <class T, class Mask>
PELLUCID_HD T scaled_tail_0(T t, Mask rising) noexcept {
  if (all(rising)) return w0_plus(t);
  if (!any(rising)) return w0_minus(t);
  return select(rising, w0_plus(t), w0_minus(t));
}
template <class T, class Mask>
PELLUCID_HD T scaled_tail_1(T t, Mask rising) noexcept {
  if (all(rising)) return w1_plus(t);
  if (!any(rising)) return w1_minus(t);
  return select(rising, w1_plus(t), w1_minus(t));
}

/// M of the thick form (11), (12): M(x,q) = W0(t)/(x/2 + 2σ), t = 2σ/(x/2 + 2σ), σ = √|q|. The
/// lower limit of the denominator matters only in lanes with thin segments, whose result is not
/// used.
template <class T>
struct ThickTail {
  T t, inverse;
  PELLUCID_HD ThickTail(T x, T sigma) noexcept {
    using S = scalar_t<T>;
    const T denominator = max(T(0.5) * x + T(2) * sigma, T(std::numeric_limits<S>::min()));
    inverse = T(1) / denominator;
    t = min((T(2) * sigma) / denominator, T(1));
  }
};

template <class T>
PELLUCID_HD LinearWeights<T> thin_linear_weights(const LinearRates<T>& rate) noexcept {
  const ThinSums<T> sums(rate.h, rate.g);
  const T e = exp(-rate.h);
  const T s = rate.h * sums.b0;
  const T d = sums.h1 - rate.g * sums.f1;
  return {T(2) * rate.h, T(2) * e * s, e * e, e * (sums.b0 + rate.g * sums.f1),
          e * (s + d),   e * (s - d)};
}

template <class T>
PELLUCID_HD LinearWeights<T> thick_linear_weights(const LinearRates<T>& rate) noexcept {
  const auto rising = rate.g >= T(0);
  const T sigma = sqrt(T(2) * abs(rate.g));
  const T depth = T(2) * rate.h;
  const T transparency = exp(-depth);
  const ThickTail<T> front(rate.x_f, sigma), back(rate.x_b, sigma);
  const T psi = scaled_tail_0(front.t, rising) * front.inverse -
                transparency * (scaled_tail_0(back.t, rising) * back.inverse);
  return {depth, T(1) - transparency, transparency, psi, T(1) - psi, max(psi - transparency, T(0))};
}

template <class T>
PELLUCID_HD EmissionWeights<T> thin_emission_weights(const LinearRates<T>& rate) noexcept {
  const ThinSums<T> sums(rate.h, rate.g);
  const T e = exp(-rate.h);
  const T f = sums.b0 + rate.g * sums.f1;
  return {T(2) * rate.h, T(2) * e * (rate.h * sums.b0), e * e, T(0.5) * e * (f + rate.h * sums.f1),
          T(0.5) * e * (f - rate.h * sums.f1)};
}

/// Returns the weights of the thick form; the first moments are M1 = (1 - x M)/(2 q) = W1(t)/(x/2 +
/// 2σ)².
template <class T>
PELLUCID_HD EmissionWeights<T> thick_emission_weights(const LinearRates<T>& rate) noexcept {
  const auto rising = rate.g >= T(0);
  const T sigma = sqrt(T(2) * abs(rate.g));
  const T depth = T(2) * rate.h;
  const T transparency = exp(-depth);
  const ThickTail<T> front(rate.x_f, sigma), back(rate.x_b, sigma);
  const T m_f = scaled_tail_0(front.t, rising) * front.inverse;
  const T m_b = scaled_tail_0(back.t, rising) * back.inverse;
  const T m1_f = scaled_tail_1(front.t, rising) * front.inverse * front.inverse;
  const T m1_b = scaled_tail_1(back.t, rising) * back.inverse * back.inverse;
  const T weight_b = max(m1_f - transparency * (m_b + m1_b), T(0));
  const T weight_f = max((m_f - transparency * m_b) - weight_b, T(0));
  return {depth, T(1) - transparency, transparency, weight_f, weight_b};
}

}  // namespace detail

/// Returns the exact weights for extinction that is linear from extinction_f (front, nearest the
/// eye) to extinction_b over the length. One formula for rising, falling, equal and zero
/// extinction.
///
/// The thin form (8)-(10) of the specification, 3.3, is used for optical depth <= 2: a polynomial
/// of positive terms without a division by the contrast or by the depth. The thick form (11), (12)
/// is used beyond: Moreland's erf and Dawson forms, rescaled so that neither e^{x²} nor
/// 1/(extinction_b - extinction_f) occurs. No difference of nearly equal numbers is taken: opacity
/// is not 1 - transparency in a thin segment.
///
/// Largest error: 16 u relative in weight_f, weight_b, psi and opacity, for extinction and length
/// in [0, 1e6] (results below 1e-30 in float, 1e-290 in double: non-negative); transparency 4 u
/// absolute. Finite if extinction · length is. Asserted in tests/segment.
template <class T>
PELLUCID_HD LinearWeights<T> linear_weights(T extinction_f, T extinction_b, T length) noexcept {
  const detail::LinearRates<T> rate(extinction_f, extinction_b, length);
  const auto thin = rate.h <= T(1);  // optical depth <= 2
  if (all(thin)) return detail::thin_linear_weights(rate);
  const LinearWeights<T> thick = detail::thick_linear_weights(rate);
  if (!any(thin)) return thick;
  const LinearWeights<T> w = detail::thin_linear_weights(rate);
  return {thick.optical_depth,
          select(thin, w.opacity, thick.opacity),
          select(thin, w.transparency, thick.transparency),
          select(thin, w.psi, thick.psi),
          select(thin, w.weight_f, thick.weight_f),
          select(thin, w.weight_b, thick.weight_b)};
}

/// Returns the weights of an independent linear emission (specification, equation 13), which may be
/// positive where the extinction is zero.
///
/// Largest error: 32 u relative in both weights, for extinction and length in [0, 1e6]. Finite and
/// non-negative if extinction · length is finite. Asserted in tests/segment.
template <class T>
PELLUCID_HD EmissionWeights<T> emission_weights(T extinction_f, T extinction_b, T length) noexcept {
  const detail::LinearRates<T> rate(extinction_f, extinction_b, length);
  const auto thin = rate.h <= T(1);
  if (all(thin)) return detail::thin_emission_weights(rate);
  const EmissionWeights<T> thick = detail::thick_emission_weights(rate);
  if (!any(thin)) return thick;
  const EmissionWeights<T> w = detail::thin_emission_weights(rate);
  return {thick.optical_depth, select(thin, w.opacity, thick.opacity),
          select(thin, w.transparency, thick.transparency),
          select(thin, w.weight_f, thick.weight_f), select(thin, w.weight_b, thick.weight_b)};
}

/// Returns the segment with linear extinction and color (particle model): Moreland's integral,
/// exact (specification, 3.3). Colors >= 0 are added with non-negative weights, so that the
/// radiance has the weights' relative error: 16 u; asserted in tests/segment.
template <class T>
PELLUCID_HD SegmentResult<T> linear_segment(T extinction_f, T extinction_b, Rgb<T> color_f,
                                            Rgb<T> color_b, T length) noexcept {
  const LinearWeights<T> w = linear_weights(extinction_f, extinction_b, length);
  return {w.optical_depth, w.opacity, w.transparency, w.weight_f * color_f + w.weight_b * color_b};
}

/// Returns the same with a constant color: only the optical depth matters. Largest error 16 u.
template <class T>
PELLUCID_HD SegmentResult<T> linear_segment(T extinction_f, T extinction_b, Rgb<T> color,
                                            T length) noexcept {
  return segment_of_depth((T(0.5) * extinction_f + T(0.5) * extinction_b) * length, color);
}

/// Returns the segment with linear extinction and an independent linear emission (radiance per
/// length). Largest error 32 u; asserted in tests/segment.
template <class T>
PELLUCID_HD SegmentResult<T> linear_segment_independent(T extinction_f, T extinction_b,
                                                        Rgb<T> emission_f, Rgb<T> emission_b,
                                                        T length) noexcept {
  const EmissionWeights<T> w = emission_weights(extinction_f, extinction_b, length);
  return {w.optical_depth, w.opacity, w.transparency,
          (length * w.weight_f) * emission_f + (length * w.weight_b) * emission_b};
}

}  // namespace pellucid
