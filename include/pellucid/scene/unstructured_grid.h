// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// The shape of a cell, its points in VTK's order. Quadratic ones have nodes in the middle of their
/// edges; triquadratic and the like, which have more, are quadratic ones with the further nodes
/// given.
enum class CellShape : std::uint8_t {
  tetrahedron,
  pyramid,
  wedge,
  hexahedron,
  voxel,                    ///< a hexahedron whose points are numbered x fastest
  quadratic_tetrahedron,    ///< 10 points
  quadratic_pyramid,        ///< 13
  quadratic_wedge,          ///< 15
  quadratic_hexahedron,     ///< 20
  biquadratic_wedge,        ///< 18: and the middles of the quadrilaterals
  triquadratic_hexahedron,  ///< 27: and the middles of the faces and of the cell
};

/// How many points a cell of this shape has.
int point_count(CellShape shape) noexcept;

/// A variable of a mesh as it was read.
struct MeshArray {
  std::string name;
  Centering centering = Centering::point;
  /// Per point or per cell, its components one after the other.
  int components = 1;
  VolumeData values = DataArray<float>();
};

/// Cells of any shape, as a file or a program gives them. Plain data; cut_into_tetrahedra() checks.
struct UnstructuredGrid {
  std::vector<Vec3<double>> points;   ///< world
  std::vector<CellShape> shapes;      ///< per cell
  std::vector<std::int32_t> corners;  ///< points of the cells, one cell after the other
  std::vector<MeshArray> arrays;
  std::string name;  ///< for messages
};

/// The corners of the hexahedra of a curvilinear grid with so many points along each axis, which
/// are numbered x fastest; cells are too. Throws Error where an axis has fewer than two points, or
/// they are more than an index can count.
std::vector<std::int32_t> grid_hexahedra(const std::array<int, 3>& points);

}  // namespace pellucid
