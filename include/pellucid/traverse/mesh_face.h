// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/tetrahedra.h"
#include "pellucid/geometry/ray_frame.h"

namespace pellucid {

/// Returns a bound on the error of a number that is interpolated between three seen points, as a
/// share of their numbers' range, or 1: where places across the ray are off by `position_error`,
/// and they and the numbers are rounded to T. `inverse`: of the three areas' sum; `size`: of their
/// products, all in all; `across`: the sum of |x| + |y|.
///
/// Areas that are off by e_i move a value v by Σ e_i (v_i - v) / Σ area_i; products are off by 3 u
/// of their size, what blur does aside, and areas are rounded: r = Σ |e_i| / Σ area_i. The true
/// weights may be below 0 then, by r/(1 - r), so that v is that much outside of the range:
/// r/(1 - r) <= r + 2 r² up to 1/2. Beyond, the face is no larger than rounding, and the value
/// taken for one of those on it. Rounding of weights (4 u of the range), of differences, products
/// and sum, and of the numbers takes 8 u; of these |v_i| <= |v| + range, and u |v| is not counted.
template <class T, class F>
PELLUCID_HD F interpolation_error(F size, F across, F blur, F inverse) noexcept {
  using S = scalar_t<F>;
  constexpr S u = static_cast<S>(rounding_unit<T>);
  const F moved = F(S(4.1) * u) * size + blur * (F(S(2.1)) * across + F(S(6.3)) * blur);
  const F share = moved * inverse + F(S(8.1) * u);
  return min(share + F(2) * (share * share), F(1));
}

/// A face of a mesh that a ray goes through.
template <class T>
struct SeenFace {
  index_t<T> point[3];
  ProjectedPoint<T> seen[3];
  T area[3];     ///< |twice the area| between the ray and the edge opposite to the point
  T size[3];     ///< of the products that it is the difference of (Side)
  T carried[3];  ///< what else is wanted of the points
  mask_t<T> left = mask_t<T>(false);  ///< how the points turn around the ray, in their order

  /// Returns interpolation_error() with weights().
  PELLUCID_HD T error(T blur) const noexcept {
    T across = T(0);
    for (const ProjectedPoint<T>& p : seen) across += abs(p.x) + abs(p.y);
    const T sum = area[0] + area[1] + area[2];
    const auto flat = !(sum > T(0));
    return select(flat, T(1),
                  interpolation_error<T>(size[0] + size[1] + size[2], across, blur,
                                         T(1) / select(flat, T(1), sum)));
  }

  /// Computes the weights of the points where the ray crosses the face, in [0, 1], in all 1 to 3 u.
  PELLUCID_HD void weights(T* weight) const noexcept {
    const T sum = area[0] + area[1] + area[2];
    // Areas so small that they vanish: the face is no larger than rounding.
    const auto flat = !(sum > T(0));
    const T inverse = T(1) / select(flat, T(1), sum);
    for (int i = 0; i < 3; ++i) weight[i] = select(flat, T(1.0 / 3), area[i] * inverse);
  }
};

/// Returns the points of a face, in their order in the tetrahedron.
PELLUCID_HD constexpr int corner_of_face(int face, int i) noexcept {
  return i < face ? i : i + 1;
}

/// Fills in how three seen points turn around the ray; whether it goes through between them.
template <class T>
PELLUCID_HD mask_t<T> turn_around_ray(SeenFace<T>& face) noexcept {
  mask_t<T> left[3];
  for (int i = 0; i < 3; ++i) {
    const Side<T> side = side_of(face.seen[(i + 1) % 3], face.seen[(i + 2) % 3]);
    face.area[i] = abs(side.area);
    face.size[i] = side.size;
    left[i] = side.left;
  }
  face.left = left[0];
  // Three points in one place are on no side of each other.
  const ProjectedPoint<T>* p = face.seen;
  const auto one_place =
      (p[0].x == p[1].x) & (p[0].y == p[1].y) & (p[0].x == p[2].x) & (p[0].y == p[2].y);
  return (left[0] == left[1]) & (left[1] == left[2]) & !one_place;
}

/// Finds the face `code` (4 · tetrahedron + face); returns false where the ray does not go through.
/// see(point): where the ray sees it.
template <class T, class See>
PELLUCID_HD bool see_face(const Tetrahedra& mesh, std::int32_t code, See&& see,
                          SeenFace<T>& face) noexcept {
  const Tetrahedron& t = mesh.tetrahedron[code >> 2];
  for (int i = 0; i < 3; ++i) {
    const std::int32_t point = t.corner[corner_of_face(code & 3, i)];
    face.point[i] = point;
    face.seen[i] = see(point);
    face.carried[i] = T(0);
  }
  return turn_around_ray(face);
}
PELLUCID_HD inline bool see_face(const Tetrahedra& mesh, const RayFrame<double>& view,
                                 std::int32_t code, SeenFace<double>& face) noexcept {
  return see_face(
      mesh, code, [&](std::int32_t point) noexcept { return view.project(mesh.point[point]); },
      face);
}

}  // namespace pellucid
