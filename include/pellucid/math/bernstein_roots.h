// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// A polynomial of degree N on [0, 1] by its Bernstein coefficients.
template <class T, int N>
struct BernsteinPolynomial {
  T b[N + 1]{};
};

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

}  // namespace detail

/// Finds where a polynomial changes its sign inside (0, 1), ascending; returns how many places
/// there are, at most N. By halving, with the sign changes of the coefficients as an upper bound
/// (Descartes' rule; G. Farin, Curves and Surfaces for CAGD, 5th ed., section 6.4). Each place is
/// within 2^-44 of a zero of a polynomial whose coefficients differ by (2 N + 2) u max|b_k|; two
/// that are closer together may be left out. Asserted in tests/math.
template <class T, int N>
PELLUCID_HD int sign_change_positions(const BernsteinPolynomial<T, N>& f, T* position) noexcept {
  constexpr int deepest = 44;
  BernsteinPolynomial<T, N> open[deepest + 1];
  T begin[deepest + 1], width[deepest + 1];
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
    if (width[top] <= T(1) / T(1LL << deepest) || left > deepest) {
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
    open[top + 1] = front;
    // Where the two meet at a zero, neither half has the change.
    if (front.b[N] == T(0)) {
      T before = T(0), behind = T(0);
      for (int i = N; i >= 0 && before == T(0); --i) before = front.b[i];
      for (int i = 0; i <= N && behind == T(0); ++i) behind = open[top].b[i];
      if (before != T(0) && behind != T(0) && (before > T(0)) != (behind > T(0))) {
        // Moved by less than a rounding of the coefficients.
        open[top].b[0] = before * T(1e-300);
      }
    }
    ++left;
  }
  return count;
}

}  // namespace pellucid
