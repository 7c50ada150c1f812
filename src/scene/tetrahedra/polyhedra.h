// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pellucid/geometry/vec3.h"
#include "pellucid/scene/unstructured_grid.h"

// Polyhedra cut into tetrahedra: their faces into triangles, and from each triangle a tetrahedron
// to the mean of the cell's points, or to one of these. How a face is cut depends on the face
// alone, not on the cell nor on where its list of points begins and which way it runs.
// Quadrilaterals are cut as those of all other cells are, unless that diagonal lies outside of
// them.

namespace pellucid {

/// Cuts faces of any number of points into triangles. It keeps memory between them.
class PolygonTriangulation {
 public:
  explicit PolygonTriangulation(const Vec3<double>* points) noexcept : points_(points) {}

  /// Returns the triangles of a face, two less than its points; valid until the next call.
  ///
  /// Five and more points lose ears, the best shaped one first, as seen along the mean normal; the
  /// face may be concave there. An ear holds no other point, not even on its sides, so that points
  /// in the middle of straight edges get triangles with area. Faces that cross themselves, and
  /// those of more than 64 points, are cut by the diagonals at their point of the smallest index.
  const std::vector<std::array<std::int32_t, 3>>& operator()(std::span<const std::int32_t> face);
  /// Returns whether the last triangles run the other way than their face.
  bool reversed() const noexcept { return reversed_; }

 private:
  struct Place {
    double x, y;
  };

  void fan_from_smallest();
  void project();
  /// Returns the quality of the triangle at a point of the remaining face as an ear; 0: it is none.
  double quality(std::size_t ear) const;

  const Vec3<double>* points_;
  bool reversed_ = false;
  std::vector<std::int32_t> loop_;  ///< what is left of the face, the smallest index first
  std::vector<Place> place_;        ///< of the points in the plane across the normal
  std::vector<std::array<std::int32_t, 3>> triangles_;
};

/// Finds the points from which polyhedra are cut. It keeps memory between them.
class PolyhedronApex {
 public:
  explicit PolyhedronApex(const Vec3<double>* points) noexcept
      : points_(points), triangulation_(points) {}

  /// Returns -1 where all tetrahedra to `mean` lie on the same side of their triangles, as they
  /// should; else the first of the cell's points of which that is true; -1 if there is none.
  /// `distinct` are these points, ascending.
  std::int32_t operator()(const GridCell& cell, std::span<const std::int32_t> distinct,
                          const Vec3<double>& mean);

 private:
  struct Edge {
    std::int32_t low, high;
    std::size_t face;
    bool forward;
  };

  void orient_faces(const GridCell& cell);
  double six_volumes(const std::array<std::int32_t, 3>& triangle, const Vec3<double>& apex) const;

  const Vec3<double>* points_;
  PolygonTriangulation triangulation_;
  std::vector<Edge> edges_;
  std::vector<signed char> turned_;  ///< of each face: 1 where it has to be turned, -1: not known
  std::vector<std::array<std::int32_t, 3>> triangles_;
};

/// Calls emit(middle, a, b, c) for the tetrahedra of a polyhedron.
template <class Emit>
void tetrahedralize_polyhedron(const GridCell& cell, std::int32_t middle,
                               PolygonTriangulation& triangles_of, const Emit& emit) {
  const std::int32_t* face = cell.points.data();
  for (const std::int32_t count : cell.layout.subspan(2)) {
    for (const auto& t : triangles_of({face, static_cast<std::size_t>(count)})) {
      emit(middle, t[0], t[1], t[2]);
    }
    face += count;
  }
}

/// Returns the fault of the faces of a polyhedron, "its faces do not close: …"; empty: nothing.
/// `points` and `layout` as in UnstructuredGrid, of the right lengths.
std::string polyhedron_fault(std::span<const std::int32_t> points,
                             std::span<const std::int32_t> layout);

}  // namespace pellucid
