// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// Returns an upper bound on κ(m) of the specification's (5), m >= 0. Replacing the color along a
/// span of optical depth m by its depth-weighted mean changes the radiance by at most (oscillation
/// of the color) · opacity · κ(m). The bound is between κ and min(1, m/8), and at most 1.25 κ.
///
/// Proof. Let λ be the maximum of (1 - e^(-λm))/(1 - e^(-m)) - λ, μ = λm and ν = m - μ. Integrating
/// the derivative e^(μ - λm) - 1 from either end, m κ = e^μ - 1 - μ = ν - 1 + e^(-ν). Hence
/// dm/d(mκ) = 1/(e^μ - 1) + 1/(1 - e^(-ν)) = (coth(μ/2) + coth(ν/2))/2 >= coth(m/4), because coth
/// is convex. With coth² x >= 1/x² + 2/3, d(mκ)/dm <= tanh(x) <= x/√(1 + 2x²/3), x = m/4;
/// integrated, κ <= x/(1 + √(1 + 2x²/3)).
template <class T>
PELLUCID_HD T mean_color_bound(T depth) noexcept {
  // The square must not overflow; there the bound is 1 already.
  const T x = min(T(0.25) * depth, T(1e4));
  return min(x / (T(1) + sqrt(T(1) + T(2.0 / 3) * (x * x))), T(1));
}

/// Returns an upper bound on the error, divided by (oscillation of the color) · opacity, of an
/// N-node Gauss panel (N >= 6) over cubic data: unnormalised weights, color measured from the
/// middle of its range (specification, 3.8). With x = m/2, k = ⌊(2N-7)/4⌋ and e^-x I_j(x) <=
/// (x/2)^j / j!:
///
///   m ε_k / (1 - e^-m),
///   ε_k = 2 e^-x Σ_{j>k} I_j(x) <= 2 (x/2)^(k+1) / (k+1)! · 1/(1 - x/(2(k+2)))
///
/// Proved for 0 <= m <= 4. Approaches 2 (m/4)^(k+1) / (k+1)! for small m.
template <int N, class T>
PELLUCID_HD constexpr T panel_error_bound(T depth) noexcept {
  static_assert(N >= 6);
  constexpr int k = (2 * N - 7) / 4;
  const T quarter = T(0.25) * depth;
  T power = T(2);
  for (int j = 1; j <= k + 1; ++j) power *= quarter * (T(1) / T(j));
  // m / (1 - e^-m) <= 1 + m.
  return power * (T(1) + depth) / (T(1) - quarter * (T(1) / T(k + 2)));
}

}  // namespace pellucid
