// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/transfer/gaussian.h"

namespace pellucid {

/// Returns a lower bound on the exponent |K (v - c)|² of a primitive over the box lower <= v <=
/// upper, both of `channels` numbers. The primitive's extinction in the box is at most peak ·
/// e^(-bound).
///
/// f(v) = |K (v - c)|² is convex, so that for any v of the box, with g = ∇f(v),
///
///   f >= f(v) + Σ_k min(g_k (lower_k - v_k), g_k (upper_k - v_k))   everywhere in the box:
///
/// a proof for every v, and tight at the minimum. v is found by coordinate descent, which ends
/// after one round if the columns of K are orthogonal. It stops when the bound is within a
/// hundredth of f(v), or above `enough`, or after 32 rounds. The result is never more than f at any
/// corner: 64 u of the largest terms are subtracted. For blocks; least_exponent_by_rows() is
/// faster, for cells.
template <class T>
PELLUCID_HD T least_exponent(const Gaussian<T>& g, const T* lower, const T* upper,
                             T enough) noexcept {
  T gram[max_channels][max_channels];  // K^T K
  T v[max_channels];                   // measured from the center
  T scale = T(0);
  for (int k = 0; k < g.channels; ++k) {
    for (int l = 0; l <= k; ++l) {
      T sum = T(0);
      for (int i = 0; i < g.rows; ++i) sum = multiply_add(g.matrix[i][k], g.matrix[i][l], sum);
      gram[k][l] = gram[l][k] = sum;
    }
    v[k] = clamp(T(0), lower[k] - g.center[k], upper[k] - g.center[k]);
    const T away = max(abs(lower[k] - g.center[k]), abs(upper[k] - g.center[k])) +
                   T(4) * abs(g.center[k]) * T(rounding_unit<T>);
    scale += gram[k][k] * (away * away);
  }
  // |K x|² <= channels · Σ gram_kk x_k².
  const T rounding = T(64 * rounding_unit<T>) * T(g.channels) * scale;
  T best = T(0);
  for (int round = 0; round < 32; ++round) {
    T value = T(0), bound = T(0);
    for (int k = 0; k < g.channels; ++k) {
      T half = T(0);  // of the gradient
      for (int l = 0; l < g.channels; ++l) half = multiply_add(gram[k][l], v[l], half);
      value += half * v[k];
      const T to_lower = lower[k] - g.center[k] - v[k], to_upper = upper[k] - g.center[k] - v[k];
      bound += T(2) * min(half * to_lower, half * to_upper);
    }
    bound += value;
    best = max(best, bound - rounding);
    if (best >= enough || best >= T(0.99) * value) break;
    for (int k = 0; k < g.channels; ++k) {
      if (!(gram[k][k] > T(0))) continue;
      T rest = T(0);
      for (int l = 0; l < g.channels; ++l) {
        if (l != k) rest = multiply_add(gram[k][l], v[l], rest);
      }
      v[k] = clamp(-rest / gram[k][k], lower[k] - g.center[k], upper[k] - g.center[k]);
    }
  }
  return best;
}

}  // namespace pellucid
