// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// A node in the middle of a quadrilateral (the first 4 nodes are its corners, 4 more those of its
/// edges) or of a hexahedron (8 and 12), and what it is numbered after in its cell.
struct MidNode {
  int corners = 0;
  std::array<std::int8_t, 20> nodes{};

  int count() const noexcept { return corners == 4 ? 8 : 20; }
  /// Returns the serendipity shape functions there.
  double weight(int i) const noexcept { return i < corners ? -0.25 : corners == 4 ? 0.5 : 0.25; }
};

/// Returns the nodes in the middle that a cell of this shape lacks, to be appended to its own; none
/// of most shapes.
std::span<const MidNode> lacking_nodes(CellShape shape) noexcept;

/// Returns the number of points beside its own with which a cell of this shape is cut: those nodes;
/// of a polyhedron the one that its tetrahedra meet in.
std::size_t lacking_count(CellShape shape) noexcept;

/// A new point: a middle node of a cell, or the mean of the points of a polyhedron.
struct AddedPoint {
  const MidNode* node = nullptr;  ///< null: the mean of `count` points
  /// The points of its cell, in the grid or in AddedPoints::distinct.
  const std::int32_t* cell = nullptr;
  std::int32_t count = 0;

  /// Interpolates the numbers that value(point) gives by the shape functions, or takes their mean.
  template <class Value>
  double interpolated(const Value& value) const {
    double sum = 0;
    if (node == nullptr) {
      for (std::int32_t i = 0; i < count; ++i) sum += value(cell[i]);
      return sum / count;
    }
    for (int i = 0; i < node->count(); ++i) {
      sum += node->weight(i) * value(cell[node->nodes[static_cast<std::size_t>(i)]]);
    }
    return sum;
  }
};

/// The nodes that the quadratic cells of a grid lack, and the points that the tetrahedra of its
/// polyhedra meet in: new ones, the mean of the cell's points, or one of these. Two
/// quadratic cells that share a quadrilateral share the node in its middle, which is found by the
/// corners.
struct AddedPoints {
  /// In the order of their indices, which follow those of the grid's points.
  std::vector<AddedPoint> points;
  /// Points that the cells lack, one cell after the other (lacking_count): indices of points.
  std::vector<std::int32_t> indices;
  /// The points of polyhedra, each once.
  std::vector<std::int32_t> distinct{};
};

/// Returns the position of a new point.
Vec3<double> place_of(const UnstructuredGrid& grid, const AddedPoint& point);

/// Finds the points that the cells of a consistent grid lack. Throws Error where the points are
/// more than an index can count.
AddedPoints find_added_points(const UnstructuredGrid& grid);

}  // namespace pellucid
