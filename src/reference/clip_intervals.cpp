// SPDX-License-Identifier: Apache-2.0
#include "clip_intervals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include "vectors.h"

namespace pellucid::reference {
namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();

RayPart both(const RayPart& a, const RayPart& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

/// Returns the part of the ray in which a + b t >= 0.
RayPart not_negative(Real a, Real b) {
  if (b > 0) return {-a / b, infinity};
  if (b < 0) return {-infinity, -a / b};
  return a >= 0 ? RayPart{-infinity, infinity} : RayPart{infinity, -infinity};
}

/// Returns the part of the ray in which |from + t · along| <= radius. By bisection from the place
/// nearest to the origin, for the roots of a quadratic equation lose all digits where `from` is
/// far.
RayPart within(const Real3& from, const Real3& along, Real radius) {
  const Real square = dot(along, along);
  const auto distance = [](const Real3& p) { return std::hypot(p[0], p[1], p[2]); };
  if (square == 0) {
    return distance(from) <= radius ? RayPart{-infinity, infinity} : RayPart{infinity, -infinity};
  }
  const Real nearest = -dot(from, along) / square;
  const Real3 place{from[0] + nearest * along[0], from[1] + nearest * along[1],
                    from[2] + nearest * along[2]};
  if (distance(place) > radius) return {infinity, -infinity};
  Real inside = 0, outside = 2 * (radius + distance(place)) / std::sqrt(square);
  for (int i = 0; i < 140; ++i) {
    const Real middle = (inside + outside) / 2;
    const Real3 p{place[0] + middle * along[0], place[1] + middle * along[1],
                  place[2] + middle * along[2]};
    (distance(p) <= radius ? inside : outside) = middle;
  }
  // The other end is as far: but for rounding, `place` is perpendicular to the ray.
  const Real lean = dot(place, along) / square;
  return {nearest - 2 * lean - inside, nearest + inside};
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
    return within(from, ray.direction, radius);
  }
  /// Returns the part where |(p - start) × axis| <= radius |axis|, between the planes of the ends.
  RayPart operator()(const ClipCylinder& cylinder) const {
    const Real3 start = real(cylinder.start), axis = difference(real(cylinder.end), start);
    const Real3 from = difference(ray.origin, start);
    const Real square = dot(axis, axis);
    RayPart part = within(cross(from, axis), cross(ray.direction, axis),
                          Real(cylinder.radius) * std::sqrt(square));
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
