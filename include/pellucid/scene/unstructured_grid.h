// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// The shape of a cell, with its points in VTK's order. Quadratic cells have nodes in the middle of
/// their edges. Triquadratic and similar cells are quadratic ones with additional nodes.
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
  biquadratic_wedge,        ///< 18: with the centers of the quadrilaterals
  triquadratic_hexahedron,  ///< 27: with the centers of the faces and of the cell
};

/// Returns the number of points of a cell of this shape.
int point_count(CellShape shape) noexcept;

/// A variable of a mesh, as read from a file.
struct MeshArray {
  std::string name;
  Centering centering = Centering::point;
  /// Number of components per point or cell; they are stored next to each other.
  int components = 1;
  VolumeData values = DataArray<float>();
};

/// Cells of any shape, as a file or a program provides them. Plain data; cut_into_tetrahedra()
/// checks it.
struct UnstructuredGrid {
  std::vector<Vec3<double>> points;   ///< world
  std::vector<CellShape> shapes;      ///< per cell
  std::vector<std::int32_t> corners;  ///< points of the cells, cell after cell
  std::vector<MeshArray> arrays;
  std::string name;  ///< used in messages
};

/// Returns the corners of the hexahedra of a curvilinear grid with `points` points along each axis.
/// Points and cells are numbered x fastest. Throws Error if an axis has fewer than two points, or
/// there are more points than an index can count.
std::vector<std::int32_t> grid_hexahedra(const std::array<int, 3>& points);

}  // namespace pellucid
