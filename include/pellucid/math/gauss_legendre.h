// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/config.h"
#include "pellucid/math/gauss_legendre_rules.h"

namespace pellucid {

/// Returns the Gauss-Legendre rule with N = 1 … 12 nodes on [0, 1] in the number type S:
///
///     node[j] = u_j, ascending and symmetric about 1/2,
///     weight[j] = ω_j: Σ ω_j p(u_j) = ∫ p over [0, 1] for polynomials p of degree < 2 N,
///     collocation[j][k] = B_jk = ∫ l_k over [0, u_j], l_k the Lagrange polynomials on the nodes:
///     Σ_k B_jk p(u_k) = ∫ p over [0, u_j] for polynomials p of degree < N.
///
/// With rates r_k at the nodes, Σ_k B_jk r_k is the optical depth from the front of a panel to node
/// j (specification, 3.7). The relative error of nodes and weights and the absolute error of
/// collocation entries is at most 1 u; asserted in tests/math/gauss_legendre.cpp.
///
/// Inside a kernel:  static constexpr auto rule = gauss_legendre<S, N>(); The compiler evaluates
/// it; it is in constant memory on the host and on the device.
template <class S, int N>
consteval GaussLegendre<S, N> gauss_legendre() noexcept {
  GaussLegendre<S, N> rule{};
  for (int j = 0; j < N; ++j) {
    rule.node[j] = static_cast<S>(gauss_legendre_rule<N>.node[j]);
    rule.weight[j] = static_cast<S>(gauss_legendre_rule<N>.weight[j]);
    for (int k = 0; k < N; ++k) {
      rule.collocation[j][k] = static_cast<S>(gauss_legendre_rule<N>.collocation[j][k]);
    }
  }
  return rule;
}

}  // namespace pellucid
