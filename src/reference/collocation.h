// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace pellucid::reference {

/// Functions on [-1, 1] known at the 20 nodes of Gauß and Legendre's rule, and the polynomial of
/// degree 19 through them, as a sum of Legendre polynomials P_k.
class Collocation {
 public:
  static constexpr std::size_t nodes = 20;
  using Values = std::array<double, nodes>;

  static const Collocation& rule();

  /// Returns the nodes, ascending.
  const Values& node() const { return node_; }
  /// Integrates over [-1, 1]; exact to degree 39.
  double integral(const Values& f) const;
  /// Integrates from -1 to each node: exact to degree 19.
  Values running_integral(const Values& f) const;
  /// Integrates from -1 to x in [-1, 1].
  double running_integral(const Values& f, double x) const;
  /// Returns the sum of the magnitudes of the last three coefficients: small where the polynomial
  /// is the function.
  double tail(const Values& f) const;

 private:
  Collocation();

  Values node_{}, weight_{};
  std::array<Values, nodes> transform_{};  ///< coefficient of P_k: row k times the values
  std::array<Values, nodes> running_{};    ///< integral to node i: row i times the values
};

}  // namespace pellucid::reference
