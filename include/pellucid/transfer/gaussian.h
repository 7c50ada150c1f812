// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/limits.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// A Gaussian primitive over the n channels of the data, 1 <= n <= 8:
///
///   extinction(v) = peak · e^(-|K (v - c)|²),   K with r rows and n columns, 1 <= r <= 8,
///
/// and one color. There is no factor 1/2: for a covariance Σ, K^T K = Σ^-1 / 2. K may have any
/// rank; the primitive ignores its null space. Plain numbers of the scalar type S, the same for
/// every lane of a packet. The owner has checked that they are finite and the extinction is not
/// negative.
template <class S>
struct Gaussian {
  S center[max_channels]{};
  S matrix[max_channels][max_channels]{};  ///< K by rows; rows × channels entries are used
  int channels = 1, rows = 1;
  int first = 0;  ///< its first channel among those of a span (segment/multivariate_span.h)
  S peak{};       ///< the largest extinction, 1/length
  Rgb<S> color{};

  /// Computes p = K (v - c): `rows` numbers from `channels` numbers. The differences are taken
  /// first.
  template <class T>
  PELLUCID_HD void transform(const T* v, T* p) const noexcept {
    for (int i = 0; i < rows; ++i) {
      p[i] = T(0);
      for (int k = 0; k < channels; ++k) {
        p[i] = multiply_add(T(matrix[i][k]), v[k] - T(center[k]), p[i]);
      }
    }
  }

  /// Computes d = K (v2 - v1) from the data, because the difference of two distant transformed
  /// positions has lost its digits.
  template <class T>
  PELLUCID_HD void displacement(const T* v1, const T* v2, T* d) const noexcept {
    for (int i = 0; i < rows; ++i) {
      d[i] = T(0);
      for (int k = 0; k < channels; ++k) {
        d[i] = multiply_add(T(matrix[i][k]), v2[k] - v1[k], d[i]);
      }
    }
  }

  /// Returns e^(-|K (v - c)|²), in [0, 1].
  template <class T>
  PELLUCID_HD T density(const T* v) const noexcept {
    T p[max_channels];
    transform(v, p);
    T square = T(0);
    for (int i = 0; i < rows; ++i) square = multiply_add(p[i], p[i], square);
    return exp(-square);
  }
};

/// A set of the primitives of a mixture that may matter; bit i mod 64 represents primitive i.
struct PrimitiveSet {
  unsigned long long bits = ~0ULL;

  PELLUCID_HD constexpr bool contains(int primitive) const noexcept {
    return ((bits >> (primitive & 63)) & 1) != 0;
  }
};

/// A sum of Gaussian primitives with the same channels. A view; owns nothing.
template <class S>
struct GaussianMixture {
  const Gaussian<S>* primitive = nullptr;
  int count = 0;

  /// Returns Σ extinction_i, and the color whose product with it is the sum of color_i ·
  /// extinction_i; black if nothing absorbs.
  template <class T>
  PELLUCID_HD Material<T> evaluate(const T* v) const noexcept {
    T extinction = T(0);
    Rgb<T> emission{};
    for (int i = 0; i < count; ++i) {
      const T here = T(primitive[i].peak) * primitive[i].density(v);
      const Rgb<S>& c = primitive[i].color;
      extinction += here;
      emission += here * Rgb<T>{T(c.r), T(c.g), T(c.b)};
    }
    const auto absorbs = extinction > T(0);
    return {extinction,
            (select(absorbs, T(1), T(0)) / select(absorbs, extinction, T(1))) * emission};
  }
};

}  // namespace pellucid
