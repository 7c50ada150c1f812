// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "pellucid/geometry/vec3.h"
#include "real.h"

namespace pellucid::reference {

inline Real3 real(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}
inline Real3 sum(const Real3& p, const Real3& q) {
  return {p[0] + q[0], p[1] + q[1], p[2] + q[2]};
}
inline Real3 difference(const Real3& p, const Real3& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
inline Real3 scaled(const Real3& p, Real factor) {
  return {p[0] * factor, p[1] * factor, p[2] * factor};
}
inline Real dot(const Real3& p, const Real3& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
inline Real3 cross(const Real3& p, const Real3& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
inline Real length(const Real3& p) {
  return std::hypot(p[0], p[1], p[2]);
}
/// Returns the vector of length 1; (0, 0, 0) for itself.
inline Real3 unit(const Real3& p) {
  const Real norm = length(p);
  return norm > 0 ? Real3{p[0] / norm, p[1] / norm, p[2] / norm} : Real3{};
}

}  // namespace pellucid::reference
