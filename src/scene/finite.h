// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "pellucid/geometry/vec3.h"

namespace pellucid {

inline bool is_finite(const Vec3<double>& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace pellucid
