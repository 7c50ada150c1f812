// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
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
  biquadratic_wedge,        ///< 18: and the middles of the quadrilaterals
  triquadratic_hexahedron,  ///< 27: and the middles of the faces and of the cell
  // Those whose layout says how many points they have (UnstructuredGrid::layouts):
  lagrange_tetrahedron,  ///< of any order, in the order of nodes of VTK 9
  lagrange_wedge,
  lagrange_hexahedron,
  polyhedron,  ///< the points of its faces, one face after the other, each in a circle
};

/// How many points a cell of this shape has; 0 where its layout says it.
int point_count(CellShape shape) noexcept;

/// How many nodes a Lagrange cell has: of a tetrahedron `orders[0]` counts, of a wedge that and
/// `orders[2]`, along it. 0 where an order is below 1 or the nodes are more than an int counts.
int lagrange_points(CellShape shape, const std::array<int, 3>& orders) noexcept;

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
  std::vector<std::int32_t> corners;  ///< points of the cells, one cell after the other
  /// What some shapes do not say, one such cell after the other. Each begins with its number of
  /// points. Behind it Lagrange cells have their order along three axes; polyhedra the number of
  /// their faces, and of each face its number of points. Quadratic tetrahedra of 15 nodes and
  /// wedges of 21, which have further ones in the middle of triangles and of the cell, are Lagrange
  /// cells of order 2.
  std::vector<std::int32_t> layouts{};
  /// The numbers by which messages call the cells; empty: as they stand.
  std::vector<std::int32_t> cell_numbers{};
  std::vector<MeshArray> arrays;
  std::string name;  ///< used in messages
};

/// A cell of a grid. Views into it.
struct GridCell {
  CellShape shape;
  std::span<const std::int32_t> points;
  std::span<const std::int32_t> layout;  ///< empty where the shape says all
};

/// Goes through the cells of a grid in their order. The grid agrees with itself, and outlives this.
class CellWalk {
 public:
  explicit CellWalk(const UnstructuredGrid& grid) noexcept : grid_(&grid) {}
  /// From a place in the middle: the numbers that places() gave there.
  CellWalk(const UnstructuredGrid& grid, const std::array<std::size_t, 3>& places) noexcept
      : grid_(&grid), cell_(places[0]), point_(places[1]), layout_(places[2]) {}

  bool done() const noexcept { return cell_ == grid_->shapes.size(); }
  /// Where the next cell begins: among the shapes, the corners and the layouts.
  std::array<std::size_t, 3> places() const noexcept { return {cell_, point_, layout_}; }
  /// The next cell, while not done().
  GridCell next() noexcept;

 private:
  const UnstructuredGrid* grid_;
  std::size_t cell_ = 0, point_ = 0, layout_ = 0;
};

/// The corners of the hexahedra of a curvilinear grid with so many points along each axis, which
/// are numbered x fastest; cells are too. Throws Error where an axis has fewer than two points, or
/// they are more than an index can count.
std::vector<std::int32_t> grid_hexahedra(const std::array<int, 3>& points);

}  // namespace pellucid
