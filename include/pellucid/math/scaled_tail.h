// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/w0_minus.h"
#include "pellucid/math/w0_plus.h"
#include "pellucid/math/w1_minus.h"
#include "pellucid/math/w1_plus.h"

/// The scaled tails w0_plus(t), w0_minus(t), w1_plus(t), w1_minus(t) on t in [0, 1]
/// (specification, 3.3 and 4.2). With
///
///     x = extinction · length at one end, q = (x_back - x_front) / 2, σ = √|q|, δ = x / (2 σ),
///     t = 2 / (δ + 2) = 2 σ / (x / 2 + 2 σ),
///
/// the integral of the transmittance to infinity along linearly changing extinction is
/// M(x, q) = W0±(t) / (x / 2 + 2 σ), and its first moment M₁(x, q) = W1±(t) / (x / 2 + 2 σ)², where
/// ± is the sign of q. No formula divides by σ: t = 0 is constant extinction. All four are smooth
/// and bounded on the closed interval.
///
/// Largest absolute error in units of u = 2^-24 (float) or 2^-53 (double) for every exact t in
/// [0, 1]; asserted in tests/math/scaled_tail.cpp:
///
///     function   values          float   double
///     w0_plus    [0.5, 1.78]     2.6     2.2
///     w0_minus   [0, 1.63]       2.2     2.0
///     w1_plus    [0.25, 2]       2.8     2.2
///     w1_minus   [-2.24, 1.83]   4.0     4.4
///
/// NaN gives NaN; t outside of [0, 1] gives a finite number without meaning.
