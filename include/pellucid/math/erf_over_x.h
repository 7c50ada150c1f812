// SPDX-License-Identifier: Apache-2.0
// Written by tools/reference/write_headers.py from approximation_coefficients.csv.
#pragma once

#include "pellucid/math/polynomial.h"

namespace pellucid {

// clang-format off
/// Returns erf(x) / x as a function of x² in [0, 1].
template <class T>
PELLUCID_HD inline T erf_over_x(T x_squared) noexcept {
  if constexpr (is_single<T>) {
    static constexpr float c[1][7] = {
        {0.965468764f, -0.1405361f, 0.0198524985f, -0.0022854195f, 0.000217511988f,
         -1.7669081e-05f, 1.23164023e-06f},
    };
    return interval_polynomial<T>(c, x_squared);
  } else {
    static constexpr double c[1][14] = {
        {0.9654687386698673, -0.1405360890227171, 0.019852496688983708, -0.0022854855611440673,
         0.00021751715604160108, -1.75371694414921e-05, 1.223382738352401e-06,
         -7.511569160678138e-08, 4.11580059766496e-09, -2.0352493920247854e-10,
         9.167606746069445e-12, -3.7910930392717217e-13, 1.454817075960679e-14,
         -5.166061616805983e-16},
    };
    return interval_polynomial<T>(c, x_squared);
  }
}
// clang-format on

}  // namespace pellucid
