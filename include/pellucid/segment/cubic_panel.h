// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/math/gauss_legendre.h"

namespace pellucid {

/// At the nodes of the Gauss-Legendre rule with N nodes on [0,1]: the weight ω_j, the four
/// Bernstein polynomials of degree 3, and their integrals from 0 to the node. A cubic and its
/// antiderivative at a node are then four products each.
template <class S, int N>
struct CubicNodes {
  S weight[N]{}, position[N]{};
  S basis[N][4]{}, integral[N][4]{};

  PELLUCID_HD constexpr CubicNodes() noexcept {
    constexpr auto rule = gauss_legendre<double, N>();
    for (int j = 0; j < N; ++j) {
      const double u = rule.node[j], v = 1 - u;
      const double b3[4] = {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
      const double b4[5] = {v * v * v * v, 4 * u * v * v * v, 6 * u * u * v * v, 4 * u * u * u * v,
                            u * u * u * u};
      double tail = 0;
      for (int k = 3; k >= 0; --k) {
        tail += b4[k + 1];
        basis[j][k] = static_cast<S>(b3[k]);
        integral[j][k] = static_cast<S>(0.25 * tail);
      }
      weight[j] = static_cast<S>(rule.weight[j]);
      position[j] = static_cast<S>(u);
    }
  }
};

/// The mean of a cubic share s(t), weighted by extinction · transparency, where the rate
/// (extinction · length) is rate_near + rate_change · s: the N-node Gauss rule with the exact
/// optical depth at each node, normalised (specification, 3.7, 3.8). Within the hull of s at the
/// nodes. 0 where nothing absorbs at the nodes.
template <int N, class T>
PELLUCID_HD T cubic_panel_mean(const CubicBernstein<T>& s, T rate_near, T rate_change) noexcept {
  using S = scalar_t<T>;
  static constexpr CubicNodes<S, N> nodes;
  T sum = T(0), sum_s = T(0);
  for (int j = 0; j < N; ++j) {
    const auto& b = nodes.basis[j];
    const auto& a = nodes.integral[j];
    const T share = (T(b[0]) * s.b[0] + T(b[3]) * s.b[3]) + (T(b[1]) * s.b[1] + T(b[2]) * s.b[2]);
    const T integral =
        (T(a[0]) * s.b[0] + T(a[3]) * s.b[3]) + (T(a[1]) * s.b[1] + T(a[2]) * s.b[2]);
    const T rate = max(rate_near + rate_change * share, T(0));
    const T depth = rate_near * T(nodes.position[j]) + rate_change * integral;
    const T weight = T(nodes.weight[j]) * rate * exp(-depth);
    sum += weight;
    sum_s += weight * share;
  }
  return select(sum > T(0), sum_s / sum, T(0));
}

}  // namespace pellucid
