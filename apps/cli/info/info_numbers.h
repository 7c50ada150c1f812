// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <string>

#include "pellucid/geometry/vec3.h"

namespace pellucid::cli {

/// Returns a number in at most six digits. The sum turns -0 into 0.
inline std::string number(double x) {
  return fmt::format("{:.6g}", x + 0.0);
}

inline std::string triple(const Vec3<double>& v) {
  return fmt::format("{} {} {}", number(v.x), number(v.y), number(v.z));
}

}  // namespace pellucid::cli
