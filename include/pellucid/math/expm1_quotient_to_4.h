// SPDX-License-Identifier: Apache-2.0
// Written by tools/reference/write_headers.py from approximation_coefficients.csv.
#pragma once

#include "pellucid/math/polynomial.h"

namespace pellucid {

// clang-format off
/// Returns (1 - e^(-x)) / x, x = 4 t, as a function of t in [0, 1]: expm1_quotient(x) for optical
/// depths of at most 4, without an exponential, whose difference from 1 would cancel for small x. A
/// Chebyshev series, truncated where the remainder is 0.6 u (float), 0.1 u (double).
///
/// Largest relative error 4.2 u (float), 3.6 u (double), near t = 0.98; not valid outside of
/// [0, 1]. Asserted in tests/math/exponential.cpp and, in lanes, tests/simd.
template <class T>
PELLUCID_HD inline T expm1_quotient_to_4(T t) noexcept {
  if constexpr (is_single<T>) {
    static constexpr float c[1][10] = {
        {0.432332367f, -0.29699707f, 0.161661357f, -0.0714381114f, 0.0263299607f, -0.00828267355f,
         0.00225730194f, -0.000546385301f, 0.000129547814f, -2.51985512e-05f},
    };
    return interval_polynomial<T>(c, t);
  } else {
    static constexpr double c[1][18] = {
        {0.43233235838169365, -0.29699707514508095, 0.16166179190846786, -0.07143826975072633,
         0.026326508671866727, -0.00828180424030979, 0.0022669027630100704,
         -0.0005483594839088057, 0.00011872366471804057, -2.324903759756307e-05,
         4.15411048993102e-06, -6.823073537926605e-07, 1.0367634716545138e-07,
         -1.4653195082691347e-08, 1.9327902853402424e-09, -2.3966821776655475e-10,
         2.952449621367659e-11, -3.2512265535306045e-12},
    };
    return interval_polynomial<T>(c, t);
  }
}
// clang-format on

}  // namespace pellucid
