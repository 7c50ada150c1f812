// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/constants.h"

namespace pellucid {

/// A polynomial of degree N on [0, 1] by its Bernstein coefficients.
template <class T, int N>
struct BernsteinPolynomial {
  T b[N + 1]{};
};

/// Returns the product of two polynomials, c_k = Σ_{i+j=k} C(M,i) C(N,j) / C(M+N,k) a_i b_j.
template <class T, int M, int N>
PELLUCID_HD constexpr BernsteinPolynomial<T, M + N> product(
    const BernsteinPolynomial<T, M>& a, const BernsteinPolynomial<T, N>& b) noexcept {
  // C(M,i) C(N,j) / C(M+N,i+j) from one i to the next and from one j to the next.
  BernsteinPolynomial<T, M + N> result;
  T of_row = T(1);
  for (int i = 0; i <= M; ++i) {
    T weight = of_row;
    for (int j = 0; j <= N; ++j) {
      result.b[i + j] += weight * a.b[i] * b.b[j];
      if (j < N) weight *= T((N - j) * (i + j + 1)) / T((j + 1) * (M + N - i - j));
    }
    of_row *= T((M - i) * (i + 1)) / T((i + 1) * (M + N - i));
  }
  return result;
}

namespace detail {

/// Halves a polynomial at 1/2 by de Casteljau: `f` becomes the first half; returns the second.
template <class T, int N>
PELLUCID_HD constexpr BernsteinPolynomial<T, N> split_in_half(
    BernsteinPolynomial<T, N>& f) noexcept {
  BernsteinPolynomial<T, N> back;
  for (int k = 0; k <= N; ++k) {
    back.b[N - k] = f.b[N];
    for (int i = N; i > k; --i) f.b[i] = T(0.5) * (f.b[i - 1] + f.b[i]);
  }
  return back;
}

template <class T, int N>
PELLUCID_HD constexpr int sign_changes(const BernsteinPolynomial<T, N>& f) noexcept {
  int changes = 0;
  T last = T(0);
  for (const T& b : f.b) {
    if (b == T(0)) continue;
    if (last != T(0) && (b > T(0)) != (last > T(0))) ++changes;
    last = b;
  }
  return changes;
}

/// Returns f(t) by de Casteljau.
template <class T, int N>
PELLUCID_HD constexpr T evaluate(BernsteinPolynomial<T, N> f, T t) noexcept {
  for (int k = N; k > 0; --k) {
    for (int i = 0; i < k; ++i) f.b[i] += t * (f.b[i + 1] - f.b[i]);
  }
  return f.b[0];
}

/// Narrows an interval in which f changes its sign once, by the Illinois method (Dowell and Jarratt
/// 1971) and halving in turn; returns a position within 2^-44 of the change.
template <class T, int N>
PELLUCID_HD T narrow_down(const BernsteinPolynomial<T, N>& f, T lower, T upper) noexcept {
  T at_lower = evaluate(f, lower), at_upper = evaluate(f, upper);
  if (at_lower == T(0)) return lower;
  for (int i = 0; i < 100 && upper - lower > T(0x1p-44); ++i) {
    const T share = at_lower / (at_lower - at_upper);
    const bool usable = share > T(0) && share < T(1) && i % 3 != 2;
    const T t = lower + (usable ? share : T(0.5)) * (upper - lower);
    const T value = evaluate(f, t);
    if (value == T(0)) return t;
    if ((value > T(0)) == (at_lower > T(0))) {
      lower = t;
      at_lower = value;
      at_upper *= T(0.5);
    } else {
      upper = t;
      at_upper = value;
      at_lower *= T(0.5);
    }
  }
  return lower + T(0.5) * (upper - lower);
}

}  // namespace detail

/// Finds where a polynomial changes its sign inside (0, 1), ascending; returns how many places
/// there are, at most N. By halving, until the coefficients change their sign once, as f then does
/// (Descartes' rule; G. Farin, Curves and Surfaces for CAGD, 5th ed., section 6.4).
///
/// Each place is within 2^-43 of a zero of a polynomial whose coefficients differ by at most
/// 8 N u max|b_k|; two that are closer together than 2^-44 may be left out. Asserted in tests/math.
template <class T, int N>
PELLUCID_HD int sign_change_positions(const BernsteinPolynomial<T, N>& f, T* position) noexcept {
  constexpr int deepest = 44;
  if (detail::sign_changes(f) == 0) return 0;
  BernsteinPolynomial<T, N> open[deepest + 2];
  T begin[deepest + 2], width[deepest + 2];
  open[0] = f;
  begin[0] = T(0);
  width[0] = T(1);
  int count = 0, left = 1;
  while (left > 0 && count < N) {
    const int top = left - 1;
    const int changes = detail::sign_changes(open[top]);
    if (changes == 0) {
      --left;
      continue;
    }
    if (changes == 1) {
      position[count++] = begin[top] + width[top] * detail::narrow_down(open[top], T(0), T(1));
      --left;
      continue;
    }
    if (left > deepest) {
      // An even number of changes so close together is none.
      if (changes % 2 == 1) position[count++] = begin[top] + T(0.5) * width[top];
      --left;
      continue;
    }
    // The back half stays, the front half goes on top of it.
    BernsteinPolynomial<T, N> front = open[top];
    open[top] = detail::split_in_half(front);
    width[top] *= T(0.5);
    begin[top + 1] = begin[top];
    begin[top] += width[top];
    width[top + 1] = width[top];
    // Where both halves end at a zero, the change between them belongs to the back.
    if (front.b[N] == T(0)) {
      T before = T(0);
      for (int i = N; i >= 0 && before == T(0); --i) before = front.b[i];
      open[top].b[0] = copysign(T(smallest_normal<T>), before);
    }
    open[top + 1] = front;
    ++left;
  }
  return count;
}

}  // namespace pellucid
