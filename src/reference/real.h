// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace pellucid::reference {

/// Geometry, data values and crossings are in extended precision where the compiler has it (64 bits
/// of significand on x86-64, 113 on ARM64, in software), so that only the quadrature itself works
/// in double.
using Real = long double;
using Real3 = std::array<Real, 3>;

struct RealRay {
  Real3 origin, direction;
};

}  // namespace pellucid::reference
