// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/geometry/ray.h"
#include "pellucid/math/determinant.h"

namespace pellucid {

/// A point in a ray's frame: its coordinates across the ray, which is at (0, 0), and along it.
template <class T>
struct ProjectedPoint {
  T x{}, y{};
  T t{};  ///< the ray's parameter at which the point is projected
};

/// A ray's coordinate frame. It is sheared along the axis in which the ray is fastest, so that grid
/// points stay exactly on lines if the ray is parallel to an axis (S. Woop, C. Benthin, I. Wald:
/// Watertight Ray/Triangle Intersection, 2013). A point has the same coordinates in every
/// computation, so that triangles with a common edge have it in common for the ray, too.
template <class T>
struct RayFrame {
  Vec3<T> origin;      ///< a point of the ray near the data
  T t_origin{};        ///< its parameter
  Vec3<T> x, y;        ///< rows: a point p is at (x·(p - origin), y·(p - origin))
  Vec3<T> t;           ///< its parameter is t_origin + t·(p - origin)
  T position_error{};  ///< largest error of the coordinates x, y and t

  /// Returns the coordinates of a point.
  PELLUCID_HD ProjectedPoint<T> project(const Vec3<T>& point) const noexcept {
    const Vec3<T> p = point - origin;
    return {dot(x, p), dot(y, p), t_origin + dot(t, p)};
  }
};

/// Returns the frame of a ray whose direction has length 1. Its origin is the ray's point closest
/// to `near`; `reach` is an upper bound on the coordinates of all points to be projected.
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
  // The origin has an error of 2 u of the distance to it and of the ray's origin, and so has the
  // effect of the ray's direction there; differences and shears add 6 u of the point's coordinates.
  const Vec3<double>& o = ray.origin;
  view.position_error = 16 * rounding_unit<double> *
                        (abs(view.t_origin) + max(abs(o.x), max(abs(o.y), abs(o.z))) + reach);
  return view;
}

/// The side of the ray on which the line from a to b passes: twice the signed area of the triangle
/// of ray, a and b, and its sign.
///
/// If the ray meets the line, it is treated as displaced by ε along x and ε² along y, with
/// infinitesimal ε (H. Edelsbrunner, E. Mücke: Simulation of Simplicity, 1990). A ray therefore
/// never meets an edge or a point, and every computation gets the same answer. The answer from b to
/// a is the opposite one; if a and b coincide, `left` is false.
template <class T>
struct Side {
  T area{};
  T size{};  ///< sum of the absolute values of the products whose difference it is
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
