// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/tetrahedra.h"
#include "pellucid/geometry/ray_view.h"

namespace pellucid {

/// A face of a mesh that a ray goes through.
template <class T>
struct SeenFace {
  index_t<T> point[3];
  SeenPoint<T> seen[3];
  T area[3];     ///< |twice the area| between the ray and the edge opposite to the point
  T carried[3];  ///< what else is wanted of the points
  mask_t<T> left = mask_t<T>(false);  ///< how the points turn around the ray, in their order

  /// A bound on how far a weight may be off where the places of the points across the ray are off
  /// by `blur`.
  PELLUCID_HD T weight_error(T blur) const noexcept {
    T across = T(0);
    for (const SeenPoint<T>& p : seen) across += abs(p.x) + abs(p.y);
    const T moved = T(4) * blur * across, sum = area[0] + area[1] + area[2];
    // An area is off by blur times the sizes of its two points.
    return select(moved < sum, moved / select(moved < sum, sum, T(1)), T(1));
  }

  /// What the points contribute where the ray goes through, in [0, 1], in all 1 to 3 u.
  PELLUCID_HD void weights(T* weight) const noexcept {
    const T sum = area[0] + area[1] + area[2];
    // Areas so small that they vanish: the face is no larger than rounding.
    const auto flat = !(sum > T(0));
    const T inverse = T(1) / select(flat, T(1), sum);
    for (int i = 0; i < 3; ++i) weight[i] = select(flat, T(1.0 / 3), area[i] * inverse);
  }
};

/// The three points of face `code` (4 · tetrahedron + face), seen from `view`: false where the ray
/// does not go through.
PELLUCID_HD inline bool see_face(const Tetrahedra& mesh, const RayView<double>& view,
                                 std::int32_t code, SeenFace<double>& face) noexcept {
  const Tetrahedron& t = mesh.tetrahedron[code >> 2];
  int n = 0;
  for (int k = 0; k < 4; ++k) {
    if (k == (code & 3)) continue;
    face.point[n] = t.corner[k];
    face.seen[n] = view.see(mesh.point[t.corner[k]]);
    face.carried[n] = 0;
    ++n;
  }
  bool left[3];
  for (int i = 0; i < 3; ++i) {
    const Side<double> side = side_of(face.seen[(i + 1) % 3], face.seen[(i + 2) % 3]);
    face.area[i] = abs(side.area);
    left[i] = side.left;
  }
  face.left = left[0];
  return left[0] == left[1] && left[1] == left[2];
}

}  // namespace pellucid
