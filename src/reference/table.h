// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/transfer_function.h"
#include "real.h"

namespace pellucid::reference {

/// A stretch of the transfer function between neighbouring control points, or one of its constant
/// outsides, where the two ends are the same point.
struct TableInterval {
  const TransferFunction::Point* left;
  const TransferFunction::Point* right;

  bool constant() const { return left == right; }
};

/// The lookups that quadrature needs, straight from the list of control points.
class Table {
 public:
  explicit Table(const std::vector<TransferFunction::Point>& points);

  /// Returns the interval that holds v; at a control value the one on its right.
  TableInterval interval(Real v) const;
  Real extinction(Real v) const;
  /// Returns whether the extinction is 0 for all values in [lower, upper].
  bool is_clear(Real lower, Real upper) const;
  /// Returns the control values, ascending, each once.
  const std::vector<Real>& values() const { return values_; }

 private:
  const std::vector<TransferFunction::Point>& points_;
  std::vector<Real> values_;
};

}  // namespace pellucid::reference
