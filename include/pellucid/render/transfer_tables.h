// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "pellucid/transfer/antiderivative.h"

namespace pellucid {

/// A transfer function as rays use it, in both number types. A view; owns nothing.
struct TransferTables {
  PiecewiseLinear<float> single;
  PiecewiseLinear<double> wide;
  PiecewiseLinearAntiderivative<float> single_antiderivative;
  PiecewiseLinearAntiderivative<double> wide_antiderivative;
  double largest_extinction = 0;
  /// Values, ascending, at which different control points of `wide` are equal in `single`.
  const double* merged = nullptr;
  int merged_count = 0;

  /// Returns whether `single` differs from the function somewhere in [lower, upper].
  PELLUCID_HD bool single_is_inexact(double lower, double upper) const noexcept {
    int lo = 0, hi = merged_count;
    while (lo < hi) {
      const int mid = (lo + hi) / 2;
      if (merged[mid] < lower) {
        lo = mid + 1;
      } else {
        hi = mid;
      }
    }
    return lo < merged_count && merged[lo] <= upper;
  }

  /// Returns the function in the number type T.
  template <class T>
  PELLUCID_HD const PiecewiseLinear<T>& table() const noexcept {
    if constexpr (std::is_same_v<T, float>) {
      return single;
    } else {
      return wide;
    }
  }
  /// Returns the antiderivative in the number type T.
  template <class T>
  PELLUCID_HD const PiecewiseLinearAntiderivative<T>& antiderivative() const noexcept {
    if constexpr (std::is_same_v<T, float>) {
      return single_antiderivative;
    } else {
      return wide_antiderivative;
    }
  }
};

}  // namespace pellucid
