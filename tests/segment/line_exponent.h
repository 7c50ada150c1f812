// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "pellucid/transfer/gaussian.h"

namespace pellucid::test {

/// |K (v - c)|² of a primitive along data that go straight from `front` to `back`, in long double.
template <class S>
struct LineExponent {
  const Gaussian<S>& primitive;
  const S *front, *back;  ///< by channel

  long double operator()(long double u) const {
    long double sum = 0;
    for (int i = 0; i < primitive.rows; ++i) {
      long double p = 0;
      for (int c = 0; c < primitive.channels; ++c) {
        const long double v =
            (1 - u) * static_cast<long double>(front[c]) + u * static_cast<long double>(back[c]);
        p += static_cast<long double>(primitive.matrix[i][c]) *
             (v - static_cast<long double>(primitive.center[c]));
      }
      sum += p * p;
    }
    return sum;
  }
  /// The least for u in [0, 1]: it is convex, so thirds can be left out.
  long double least() const {
    long double lower = 0, upper = 1;
    for (int i = 0; i < 120; ++i) {
      const long double a = lower + (upper - lower) / 3, b = upper - (upper - lower) / 3;
      const bool rises = (*this)(a) < (*this)(b);
      (rises ? upper : lower) = rises ? b : a;
    }
    return std::min({(*this)(0), (*this)(1), (*this)(lower)});
  }
};

}  // namespace pellucid::test
