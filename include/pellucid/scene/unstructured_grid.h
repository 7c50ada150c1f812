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
  biquadratic_wedge,        ///< 18: with the centers of the quadrilaterals
  triquadratic_hexahedron,  ///< 27: with the centers of the faces and of the cell
  // Shapes with a number of points in UnstructuredGrid::layouts:
  lagrange_tetrahedron,  ///< any order; nodes in the order of VTK 9
  lagrange_wedge,
  lagrange_hexahedron,
  polyhedron,  ///< points of its faces, face after face, each in order around the face
};

/// Returns the number of points of a cell of this shape, or 0 if the layout of the cell gives it.
int point_count(CellShape shape) noexcept;

/// Returns the number of nodes of a Lagrange cell with these orders along its axes, or 0 if an
/// order is below 1 or the number exceeds an int. A tetrahedron uses `orders[0]` only; a wedge uses
/// `orders[0]` in its triangles and `orders[2]` along its axis.
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
  std::vector<std::int32_t> corners;  ///< points of the cells, cell after cell
  /// Layouts of Lagrange cells and polyhedra, cell after cell. A layout begins with the number of
  /// points. It continues with the orders along three axes (Lagrange cells), or with the number of
  /// faces and the number of points of each face (polyhedra). Quadratic tetrahedra of 15 nodes and
  /// wedges of 21, with nodes in the middle of triangles and of the cell, are Lagrange cells of
  /// order 2.
  std::vector<std::int32_t> layouts{};
  /// Numbers by which messages refer to the cells; empty: their indices.
  std::vector<std::int32_t> cell_numbers{};
  std::vector<MeshArray> arrays;
  std::string name;  ///< used in messages
};

/// A cell of a grid, as views into the grid.
struct GridCell {
  CellShape shape;
  std::span<const std::int32_t> points;
  std::span<const std::int32_t> layout;  ///< empty for shapes with a fixed number of points
};

/// Iterates over the cells of a grid in order. The grid must be consistent and outlive this object.
class CellWalk {
 public:
  explicit CellWalk(const UnstructuredGrid& grid) noexcept : grid_(&grid) {}
  /// Starts at a cell for which places() returned these numbers.
  CellWalk(const UnstructuredGrid& grid, const std::array<std::size_t, 3>& places) noexcept
      : grid_(&grid), cell_(places[0]), point_(places[1]), layout_(places[2]) {}

  bool done() const noexcept { return cell_ == grid_->shapes.size(); }
  /// Returns the indices of the next cell's first entries in shapes, corners and layouts.
  std::array<std::size_t, 3> places() const noexcept { return {cell_, point_, layout_}; }
  /// Returns the next cell. Requires !done().
  GridCell next() noexcept;

 private:
  const UnstructuredGrid* grid_;
  std::size_t cell_ = 0, point_ = 0, layout_ = 0;
};

/// Returns the corners of the hexahedra of a curvilinear grid with `points` points along each axis.
/// Points and cells are numbered x fastest. Throws Error if an axis has fewer than two points, or
/// there are more points than an index can count.
std::vector<std::int32_t> grid_hexahedra(const std::array<int, 3>& points);

}  // namespace pellucid
