// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/ray.h"
#include "pellucid/math/determinant.h"

namespace pellucid {

/// A point as a ray sees it: its place across the ray, which is at (0, 0), and along it.
template <class T>
struct ProjectedPoint {
  T x{}, y{};
  T t{};  ///< the ray's parameter where it is level with the point
};

/// A ray's own coordinates: sheared along the axis in which the ray is fastest, so that points on a
/// grid stay exactly on lines where the ray is parallel to an axis (S. Woop, C. Benthin, I. Wald:
/// Watertight Ray/Triangle Intersection, 2013). A point is seen in the same place by whoever looks,
/// so that triangles that share an edge share it for the ray too.
template <class T>
struct RayFrame {
  Vec3<T> origin;      ///< a point of the ray close to what is seen
  T t_origin{};        ///< its parameter
  Vec3<T> x, y;        ///< rows: a point p is at (x·(p - origin), y·(p - origin))
  Vec3<T> t;           ///< and its parameter is t_origin + t·(p - origin)
  T position_error{};  ///< how far what is seen may be from its true place, in x and in y; t
                       ///< likewise

  PELLUCID_HD ProjectedPoint<T> project(const Vec3<T>& point) const noexcept {
    const Vec3<T> p = point - origin;
    return {dot(x, p), dot(y, p), t_origin + dot(t, p)};
  }
};

/// `near`: what is to be seen, of which the ray's closest point becomes the origin; `reach`: a
/// bound on the coordinates of all that will be. The ray's direction has length 1.
PELLUCID_HD inline RayFrame<double> make_ray_frame(const Ray<double>& ray, const Vec3<double>& near,
                                                   double reach) noexcept {
  const Vec3<double>& d = ray.direction;
  RayFrame<double> view;
  view.t_origin = dot(near - ray.origin, d);
  view.origin = ray.at(view.t_origin);
  int z = 0;
  for (int a = 1; a < 3; ++a) {
    if (abs(d[a]) > abs(d[z])) z = a;
  }
  const int x = z == 2 ? 0 : z + 1, y = x == 2 ? 0 : x + 1;
  view.x[x] = 1;
  view.x[z] = -(d[x] / d[z]);
  view.y[y] = 1;
  view.y[z] = -(d[y] / d[z]);
  view.t[z] = 1 / d[z];
  // The origin is off by 2 u of the way to it and of where it began, as is the ray's direction by
  // the time that it is there; differences and shears add 6 u of what is seen.
  const Vec3<double>& o = ray.origin;
  view.position_error = 16 * rounding_unit<double> *
                        (abs(view.t_origin) + max(abs(o.x), max(abs(o.y), abs(o.z))) + reach);
  return view;
}

/// On which side of the ray the line from a to b passes: twice the signed area of the triangle of
/// ray, a and b, and its sign. Where the ray meets the line it is thought of as moved from it, by
/// ε along x and ε² along y, with ε less than any number (H. Edelsbrunner, E. Mücke: Simulation of
/// Simplicity, 1990): so it never meets an edge or a point, and whoever asks is told the same. From
/// b to a the answer is the opposite one; only where a and b are in one place it is neither.
template <class T>
struct Side {
  T area{};
  T size{};  ///< of both products that it is the difference of, without their signs
  mask_t<T> left = mask_t<T>(false);  ///< whether the sign is positive
};
template <class T>
PELLUCID_HD Side<T> side_of(const ProjectedPoint<T>& a, const ProjectedPoint<T>& b) noexcept {
  const T area = determinant(a.x, a.y, b.x, b.y), size = abs(a.x * b.y) + abs(a.y * b.x);
  const auto met = area == T(0);
  auto left = area > T(0);
  if (any(met)) left = left | (met & ((a.y > b.y) | ((a.y == b.y) & (b.x > a.x))));
  return {area, size, left};
}

}  // namespace pellucid
