// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/mesh_face.h"

namespace pellucid {

/// Walks along a ray from tetrahedron to neighbouring tetrahedron, one or one in each lane.
///
/// Seen along the ray a tetrahedron is four triangles, of which the ray is in none or in two. Given
/// the one by which it comes, three signs tell the other: those of the areas between the ray and
/// the lines from the fourth point to the three others. Signs are exact, and the same for all who
/// share an edge (side_of()), so the ray always leaves, and by one face only; whichever boundary
/// face it comes in by, it comes out of the mesh by another, after each tetrahedron in between
/// once, whatever rounding says of places along the ray. No orientation is wanted of the mesh.
template <class T>
class MeshWalk {
 public:
  using Index = index_t<T>;
  using Mask = mask_t<T>;

  /// Makes a walk through the mesh, which must outlive it.
  PELLUCID_HD explicit MeshWalk(const Tetrahedra& mesh) noexcept : mesh_(mesh) {}

  /// Begins behind `face`, which the ray goes through, in the lanes of `begun`: code = 4 ·
  /// tetrahedron + face. `load` as of step().
  template <class Load>
  PELLUCID_HD void enter(Mask begun, const SeenFace<T>& face, Index code, Load&& load) noexcept {
    for (int i = 0; i < 3; ++i) {
      assign(begun, face_.point[i], face.point[i]);
      assign(begun, face_.seen[i].x, face.seen[i].x);
      assign(begun, face_.seen[i].y, face.seen[i].y);
      assign(begun, face_.seen[i].t, face.seen[i].t);
      assign(begun, face_.area[i], face.area[i]);
      assign(begun, face_.size[i], face.size[i]);
      assign(begun, face_.carried[i], face.carried[i]);
    }
    assign(begun, face_.left, face.left);
    assign(begun, code_, code);
    load_ahead();
    see_ahead(load);
  }

  /// Returns the face that was reached last.
  PELLUCID_HD const SeenFace<T>& face() const noexcept { return face_; }
  /// Returns the tetrahedron that lies ahead of it, as its face there; `outside`: none does.
  PELLUCID_HD Index ahead() const noexcept { return code_; }
  /// Returns the face as the tetrahedron gone through last has it.
  PELLUCID_HD Index left_by() const noexcept { return left_by_; }
  /// Returns which corner of the face before has given way to the new point: drop[i], corner i.
  const Mask* dropped() const noexcept { return drop_; }

  /// Goes through the tetrahedron ahead in the lanes of `on`, where there is one. load(point, seen,
  /// carried) tells where the ray sees a point, and what is to be carried of it.
  template <class Load>
  PELLUCID_HD void step(Mask on, Load&& load) noexcept {
    cross(on);
    load_ahead();
    see_ahead(load);
  }

  // The same in parts, for those who have something else to do until what each loads is there.

  /// Finds the face by which the ray leaves the tetrahedron ahead, and which one lies behind it.
  PELLUCID_HD void cross(Mask on) noexcept {
    const Index point = point_;
    const ProjectedPoint<T> seen = seen_;
    const T carried = carried_;
    const ProjectedPoint<T>* corner = face_.seen;
    Side<T> side[3];
    Mask certain = Mask(true);
    for (int i = 0; i < 3; ++i) {
      const RoundedDeterminant<T> area =
          rounded_determinant(seen.x, seen.y, corner[i].x, corner[i].y);
      side[i] = {area.value, area.size, area.value > T(0)};
      certain = certain & area.certain;
    }
    if (any(on & !certain)) {
      for (int i = 0; i < 3; ++i) side[i] = side_of(seen, corner[i]);
    }
    Mask forward[3];
    for (int i = 0; i < 3; ++i) forward[i] = side[i].left == face_.left;
    // With points a, b, c of the face and the new one d: through (b, c, d) if d sees b ahead of the
    // ray and not c; a is left behind then. And so on around.
    Mask drop[3];
    for (int i = 0; i < 3; ++i) {
      drop[i] = on & forward[(i + 1) % 3] & !forward[(i + 2) % 3];
      drop_[i] = drop[i];
    }

    const Index before =
        select(drop[0], face_.point[0], select(drop[1], face_.point[1], face_.point[2]));
    Index place(0), behind = words_[4];
    for (int i = 1; i < 4; ++i) {
      const auto is_it = before == words_[i];
      place = select(is_it, Index(i), place);
      behind = select(is_it, words_[4 + i], behind);
    }
    for (int i = 0; i < 3; ++i) {
      // The areas between the new point and those that stay.
      const int next = (i + 1) % 3, last = (i + 2) % 3;
      assign(drop[i], face_.point[i], point);
      assign(drop[i], face_.seen[i].x, seen.x);
      assign(drop[i], face_.seen[i].y, seen.y);
      assign(drop[i], face_.seen[i].t, seen.t);
      assign(drop[i], face_.carried[i], carried);
      assign(drop[i], face_.area[next], abs(side[last].area));
      assign(drop[i], face_.area[last], abs(side[next].area));
      assign(drop[i], face_.size[next], side[last].size);
      assign(drop[i], face_.size[last], side[next].size);
    }
    const Index here = (code_ >> 2) << 2;
    left_by_ = select(on, here + place, left_by_);
    code_ = select(on, behind, code_);
  }
  /// Loads the tetrahedron ahead.
  PELLUCID_HD void load_ahead() noexcept {
    const Index code = select(code_ < Index(0), Index(0), code_);
    load_records<8>(mesh_.tetrahedron->corner, code >> 2, words_);
    point_ = of_four(words_, code & Index(3));
  }
  /// Loads its point on the other side.
  template <class Load>
  PELLUCID_HD void see_ahead(Load&& load) noexcept {
    load(point_, seen_, carried_);
  }

 private:
  PELLUCID_HD static Index of_four(const Index* word, Index which) noexcept {
    const Index low = select(which < Index(1), word[0], word[1]),
                high = select(which < Index(3), word[2], word[3]);
    return select(which < Index(2), low, high);
  }

  const Tetrahedra& mesh_;
  SeenFace<T> face_;
  Index code_{}, left_by_{};
  Mask drop_[3]{Mask(false), Mask(false), Mask(false)};
  Index words_[8];  ///< the tetrahedron ahead
  Index point_{};   ///< that is not on the face
  ProjectedPoint<T> seen_;
  T carried_{};
};

}  // namespace pellucid
