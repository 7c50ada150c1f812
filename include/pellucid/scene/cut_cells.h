// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pellucid/scene/mesh_channels.h"
#include "pellucid/scene/unstructured_grid.h"

namespace pellucid {

/// An array of a grid, or one component of it, or the length of its vectors, as a channel.
struct MeshArrayChoice {
  std::string array;  ///< of points, where points and cells have one of this name
  /// From 0; none: the only one, or of several the length of the vector.
  std::optional<int> component;
  std::string name;  ///< of the channel; empty: the array's
};

/// The mesh of a grid's cells, cut into tetrahedra, with the chosen arrays as channels.
///
/// A quadrilateral is cut by the diagonal at its point of the smallest index, whatever cell it is a
/// face of: cells that share it are cut alike, and there are no cracks (J. Dompierre, P. Labbé,
/// M.-G. Vallet, R. Camarero: How to Subdivide Pyramids, Prisms and Hexahedra into Tetrahedra,
/// 1999). Quadratic cells are first cut into linear ones at their nodes; nodes that they lack, in
/// the middle of quadrilaterals and of hexahedra, get place and value of the cell's own shape
/// functions. Linear cells with collapsed edges are what is left of them. (Quadratic ones too, but
/// their collapsed quadrilaterals do not meet the triangles of other quadratic cells alike.)
///
/// Lagrange cells of any order are cut at their nodes in the same way. A polyhedron becomes a
/// tetrahedron for each triangle of its faces, with the mean of its points, or with one of these
/// where the mean does not see all faces; faces of more than four points are cut by their shape,
/// whatever cell they are a face of.
///
/// That the data are linear in each of these tetrahedra is the reconstruction that the tolerance
/// speaks of.
///
/// Points and tetrahedra stand in the order of a Morton curve, so that what lies together does in
/// memory; TetrahedralMesh::point_number() is the grid's, and goes on with the new points.
///
/// Throws Error where an array is not there (naming those that are), or has no such component, the
/// sizes do not agree, a point's index is out of range, the faces of a polyhedron do not close,
/// there is no cell, or as TetrahedralMesh and MeshChannels do.
std::shared_ptr<const MeshChannels> cut_into_tetrahedra(const UnstructuredGrid& grid,
                                                        std::span<const MeshArrayChoice> choices,
                                                        const ParallelFor& parallel = {});

/// The same tetrahedra as a grid, with all its arrays and all their components.
UnstructuredGrid tetrahedralize(const UnstructuredGrid& grid, const ParallelFor& parallel = {});

/// The cells of a volume's grid as hexahedra, their corners as they stand in the world, with its
/// values in the array "value": of points, or of cells where the volume is centred there. Throws
/// Error where the points are more than an index can count.
UnstructuredGrid to_unstructured(const Volume& volume);

}  // namespace pellucid
