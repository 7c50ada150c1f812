// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "real.h"

namespace pellucid::reference {

/// Data along a straight chord of a cell, u in [0, 1] from entry to exit: trilinear data, or linear
/// ones, which are the trilinear ones along an edge.
class Chord {
 public:
  /// Corners x fastest; entry and exit in the cell's coordinates, [0, 1]³.
  Chord(const std::array<Real, 8>& corner, const Real3& entry, const Real3& exit);

  static Chord linear(Real at_entry, Real at_exit);

  /// Returns the part [u_begin, u_end], as a chord of its own.
  Chord part(Real u_begin, Real u_end) const;

  /// Returns the sum of the eight corners, each times the product of its three weights.
  Real operator()(Real u) const;

  /// Returns the same as a polynomial in u, lowest power first: the product of the weights
  /// multiplied out.
  const std::array<Real, 4>& monomial() const { return monomial_; }
  /// Returns the data on the part [u_begin, u_end], as a polynomial in w from 0 to 1 there.
  std::array<Real, 4> monomial(Real u_begin, Real u_end) const;

  /// Returns the range of the corners that have a weight anywhere on the chord; encloses the data
  /// on it.
  Real lower() const { return lower_; }
  Real upper() const { return upper_; }

  /// Returns the zeros of the derivative inside (0, 1), ascending; at most two.
  std::vector<Real> stationary_points() const;

  /// Returns the parameters in (0, 1) at which the data passes through one of the values
  /// (ascending, no two equal), together with its stationary points, ascending. Between neighbours
  /// the data stays on one side of every value.
  std::vector<Real> cuts(const std::vector<Real>& values) const;

 private:
  std::array<Real, 8> corner_;
  Real3 entry_, exit_;
  std::array<Real, 4> monomial_{};
  Real lower_, upper_;
};

}  // namespace pellucid::reference
