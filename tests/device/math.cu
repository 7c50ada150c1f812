// SPDX-License-Identifier: Apache-2.0
#include "pellucid/math/bernstein.h"
#include "pellucid/math/cubic_extremes.h"
#include "pellucid/math/cubic_roots.h"
#include "pellucid/math/dawson.h"
#include "pellucid/math/erf_over_x.h"
#include "pellucid/math/error_function.h"
#include "pellucid/math/expm1_quotient_to_4.h"
#include "pellucid/math/exponential.h"
#include "pellucid/math/scaled_tail.h"
#include "tests/device/kernel.h"

namespace pellucid {

template <class T>
PELLUCID_HD void scalar_functions(const T* in, T* out) noexcept {
  const T x = in[0], y = in[1], z = in[2];
  out[0] = select(any(x < y) && all(y < z), exp(x), log(y));
  out[1] = log1p(x) + sqrt(y) + floor(z) + abs(x) + fma(x, y, z);
  out[2] = min(x, y) + max(y, z) + clamp(x, y, z) + copysign(x, y);
  out[3] = is_nan(x) ? T(1) : T(0);
}
PELLUCID_DEVICE_KERNEL(scalar_functions)

template <class T>
PELLUCID_HD void special_functions(const T* in, T* out) noexcept {
  const T x = in[0];
  out[0] = sinh_over_x(x) + cosh_minus_sinh_over_x(x);
  out[1] = expm1_quotient(x) + expm1_quotient_derivative(x);
  out[2] = one_minus_exp_neg(x) + exp_minus_square(x) + exp_square(x);
  const auto square = exact_square(x);
  out[3] = square.square + square.residual;
  out[4] = erf(x) + erfc(x) + erfcx(x) + erfcx_nonnegative(x);
  out[5] = dawson(x) + erf_over_x(x) + expm1_quotient_to_4(x);
  out[6] = w0_plus(x) + w0_minus(x) + w1_plus(x) + w1_minus(x);
}
PELLUCID_DEVICE_KERNEL(special_functions)

template <class T>
PELLUCID_HD void cubics(const T* in, T* out) noexcept {
  const CubicBernstein<T> f{{in[0], in[1], in[2], in[3]}};
  const CubicBernstein<T> part = restrict_to(f, in[4], in[5]);
  out[0] = evaluate(part, in[6]) + f.mean() + f.hull_min() + f.hull_max();
  out[1] = interpolate(in[0], in[1], in[2]);
  const CriticalPoints<T> turns = critical_points(f);
  out[2] = static_cast<T>(turns.count);
  out[3] = find_crossing(f, in[4], in[5], in[6], in[5] < in[6]);
  out[4] = largest_value(f) - smallest_value(f);
}
PELLUCID_DEVICE_KERNEL(cubics)

}  // namespace pellucid
