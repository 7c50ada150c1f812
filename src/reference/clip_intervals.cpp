// SPDX-License-Identifier: Apache-2.0
#include "clip_intervals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

namespace pellucid::reference {
namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();

Real3 real(const Vec3<double>& v) {
  return {v.x, v.y, v.z};
}
Real dot(const Real3& a, const Real3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Real3 difference(const Real3& a, const Real3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Real3 cross(const Real3& a, const Real3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

RayPart both(const RayPart& a, const RayPart& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

/// Where a + b t >= 0.
RayPart not_negative(Real a, Real b) {
  if (b > 0) return {-a / b, infinity};
  if (b < 0) return {-infinity, -a / b};
  return a >= 0 ? RayPart{-infinity, infinity} : RayPart{infinity, -infinity};
}

/// Where a t² + 2 b t + c <= 0, a >= 0. The root of larger magnitude first, the other from their
/// product.
RayPart not_positive(Real a, Real b, Real c) {
  if (a == 0) return not_negative(-c, -2 * b);
  const Real discriminant = b * b - a * c;
  if (discriminant < 0) return {infinity, -infinity};
  const Real q = -(b + std::copysign(std::sqrt(discriminant), b));
  const Real first = q / a, second = q != 0 ? c / q : first;
  return {std::min(first, second), std::max(first, second)};
}

/// The part of a ray inside of a shape.
struct Inside {
  const RealRay& ray;

  RayPart operator()(const ClipPlane& plane) const {
    const Real3 normal = real(plane.normal);
    return not_negative(dot(normal, difference(ray.origin, real(plane.point))),
                        dot(normal, ray.direction));
  }
  RayPart operator()(const ClipBox& box) const {
    RayPart part{-infinity, infinity};
    const Real3 lower = real(box.lower), upper = real(box.upper);
    for (std::size_t a = 0; a < 3; ++a) {
      part = both(part, not_negative(ray.origin[a] - lower[a], ray.direction[a]));
      part = both(part, not_negative(upper[a] - ray.origin[a], -ray.direction[a]));
    }
    return part;
  }
  RayPart operator()(const ClipSphere& sphere) const {
    const Real3 from = difference(ray.origin, real(sphere.center));
    const Real radius = sphere.radius;
    return not_positive(dot(ray.direction, ray.direction), dot(from, ray.direction),
                        dot(from, from) - radius * radius);
  }
  /// |(p - start) × axis| <= radius |axis|, between the planes of the ends.
  RayPart operator()(const ClipCylinder& cylinder) const {
    const Real3 start = real(cylinder.start), axis = difference(real(cylinder.end), start);
    const Real3 from = difference(ray.origin, start);
    const Real3 a = cross(ray.direction, axis), b = cross(from, axis);
    const Real radius = cylinder.radius, square = dot(axis, axis);
    RayPart part = not_positive(dot(a, a), dot(a, b), dot(b, b) - radius * radius * square);
    const Real height = dot(from, axis), slope = dot(ray.direction, axis);
    part = both(part, not_negative(height, slope));
    return both(part, not_negative(square - height, -slope));
  }
};

}  // namespace

std::vector<RayPart> kept_parts(const RealRay& ray, const std::vector<const Clip*>& clips) {
  std::vector<RayPart> kept{{0, infinity}};
  for (const Clip* const clip : clips) {
    const RayPart inside = std::visit(Inside{ray}, clip->shape);
    const bool meets = inside.begin < inside.end;
    std::vector<RayPart> left;
    for (const RayPart& part : kept) {
      if (clip->keep_inside) {
        if (meets) left.push_back(both(part, inside));
      } else if (meets) {
        left.push_back(both(part, {-infinity, inside.begin}));
        left.push_back(both(part, {inside.end, infinity}));
      } else {
        left.push_back(part);
      }
    }
    std::erase_if(left, [](const RayPart& part) { return !(part.begin < part.end); });
    kept = std::move(left);
  }
  return kept;
}

}  // namespace pellucid::reference
