// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "real.h"

namespace pellucid::reference {

/// Coefficients, lowest power first.
using Polynomial = std::vector<Real>;

Real value(const Polynomial& p, Real x);
Polynomial sum(const Polynomial& p, const Polynomial& q);
Polynomial product(const Polynomial& p, const Polynomial& q);
Polynomial derivative(const Polynomial& p);

/// Returns the zeros in [lower, upper], ascending, unless the polynomial is constant. Zeros without
/// a change of sign may be missing.
std::vector<Real> zeros(Polynomial p, Real lower, Real upper);

}  // namespace pellucid::reference
