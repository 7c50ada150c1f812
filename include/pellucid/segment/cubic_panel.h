// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/bernstein.h"
#include "pellucid/math/gauss_legendre.h"

namespace pellucid {

/// Data of the Gauss-Legendre rule with N nodes on [0,1]: at each node the weight ω_j, the four
/// Bernstein polynomials of degree 3, and their integrals from 0 to the node. A cubic and its
/// antiderivative at a node then take four products each.
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

/// Sums over the nodes of a Gauss panel.
template <class T>
struct PanelSums {
  T weight{};  ///< of extinction · transparency: nearly the opacity
  T share{};   ///< of (share - middle), with the same weights
};

/// Calls visit(share, weight) for each node of the N-node Gauss rule with the exact optical depth
/// at each node (specification, 3.7, 3.8), for a cubic share s(t) and the rate (extinction ·
/// length) rate_near + rate_change · s.
template <int N, class T, class Visit>
PELLUCID_HD void for_each_panel_node(const CubicBernstein<T>& s, T rate_near, T rate_change,
                                     Visit&& visit) noexcept {
  using S = scalar_t<T>;
  static constexpr CubicNodes<S, N> nodes;
  for (int j = 0; j < N; ++j) {
    const auto& b = nodes.basis[j];
    const auto& a = nodes.integral[j];
    const T share = (T(b[0]) * s.b[0] + T(b[3]) * s.b[3]) + (T(b[1]) * s.b[1] + T(b[2]) * s.b[2]);
    const T integral =
        (T(a[0]) * s.b[0] + T(a[3]) * s.b[3]) + (T(a[1]) * s.b[1] + T(a[2]) * s.b[2]);
    const T rate = max(rate_near + rate_change * share, T(0));
    const T depth = rate_near * T(nodes.position[j]) + rate_change * integral;
    visit(share, T(nodes.weight[j]) * rate * exp(-depth));
  }
}

/// Returns the sums over these nodes.
template <int N, class T>
PELLUCID_HD PanelSums<T> cubic_panel_sums(const CubicBernstein<T>& s, T rate_near, T rate_change,
                                          T middle) noexcept {
  PanelSums<T> sums;
  for_each_panel_node<N>(s, rate_near, rate_change, [&](T share, T weight) noexcept {
    sums.weight += weight;
    sums.share += weight * (share - middle);
  });
  return sums;
}

/// Returns the normalised mean of the share weighted by extinction · transparency: within the hull
/// of s at the nodes, 0 if nothing absorbs at the nodes. Its error is panel_error_estimate().
template <int N, class T>
PELLUCID_HD T cubic_panel_mean(const CubicBernstein<T>& s, T rate_near, T rate_change) noexcept {
  const PanelSums<T> sums = cubic_panel_sums<N>(s, rate_near, rate_change, T(0));
  return select(sums.weight > T(0), sums.share / sums.weight, T(0));
}

/// Returns the same mean without normalisation, measured from the middle of the share's range and
/// with the exact opacity: the form for which panel_error_bound() is proved. May leave the hull.
template <int N, class T>
PELLUCID_HD T cubic_panel_proved_mean(const CubicBernstein<T>& s, T rate_near, T rate_change,
                                      T opacity) noexcept {
  const T middle = T(0.5) * s.hull_min() + T(0.5) * s.hull_max();
  const PanelSums<T> sums = cubic_panel_sums<N>(s, rate_near, rate_change, middle);
  return select(opacity > T(0), middle + sums.share / opacity, middle);
}

/// The largest optical depth for which panel_error_estimate() was measured.
template <class T>
inline constexpr scalar_t<T> largest_panel_depth = scalar_t<T>(4);

/// Returns an estimate of the error of cubic_panel_mean<N>, N = 5, 6, 7, 8, 10 or 12, on a panel of
/// the given optical depth, relative to the range of the share. Not a bound: twice the largest
/// error that random search and hill climbing found (docs/notes/accuracy-segments.md).
/// tests/segment repeats the search and asserts that it stays below 1/1.7 of this. The exponents
/// follow from theory: the rule is exact to degree 2N-1, and the first term that it misses in the
/// exponential's series in the depth is j = ⌊(2N-7)/4⌋ + 1, of degree 6 + 4j.
template <int N, class T>
PELLUCID_HD T panel_error_estimate(T depth) noexcept {
  static_assert((N >= 5 && N <= 8) || N == 10 || N == 12);
  const T square = depth * depth;
  if constexpr (N == 5) return T(2.8e-2) * depth;
  if constexpr (N == 6) return T(2.8e-3) * square;
  if constexpr (N == 7) return T(9.4e-4) * square;
  if constexpr (N == 8) return T(7.2e-5) * square * depth;
  if constexpr (N == 10) return T(1.3e-6) * square * square;
  if constexpr (N == 12) return T(1.8e-8) * square * square * depth;
}

}  // namespace pellucid
