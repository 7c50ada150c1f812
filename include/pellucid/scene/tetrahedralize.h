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

/// Selects an array of a grid, one of its components, or the length of its vectors, as a channel.
struct MeshArrayChoice {
  std::string array;  ///< an array of points takes precedence over an array of cells of the same
  /// Component, from 0. None: the only component, or the length of the vector if there are several.
  std::optional<int> component;
  std::string name;  ///< of the channel; empty: the array's name
};

/// Cuts the cells of a grid into tetrahedra and returns the mesh with the chosen arrays as
/// channels.
///
/// Each quadrilateral is cut along the diagonal at its point of the smallest index. Cells that
/// share a quadrilateral therefore cut it the same way, and no cracks appear (J. Dompierre, P.
/// Labbé, M.-G. Vallet, R. Camarero: How to Subdivide Pyramids, Prisms and Hexahedra into
/// Tetrahedra, 1999). Quadratic cells are first cut into linear cells at their nodes; missing
/// nodes, in the middle of quadrilaterals and of hexahedra, get position and value from the cell's
/// own shape functions. Linear cells with collapsed edges are cut into the tetrahedra that remain.
/// Limitation: collapsed quadrilaterals of quadratic cells do not match the triangles of
/// neighboring quadratic cells.
///
/// Lagrange cells of any order are cut at their nodes in the same way. The faces of a polyhedron
/// are cut into triangles; each triangle and the mean of the cell's points make a tetrahedron. If
/// the mean does not see all faces, one of the points that does takes its place. The cut of a face
/// of more than four points depends on its shape alone, so two neighbors cut it the same way.
///
/// The reconstruction that the tolerance refers to is linear in each of these tetrahedra.
///
/// Points and tetrahedra are sorted along a Morton curve, so that neighbors in space are neighbors
/// in memory. TetrahedralMesh::point_number() returns the grid's own indices; new points continue
/// the numbering.
///
/// Throws Error if an array does not exist (the message names those that do) or lacks the
/// component, sizes do not agree, a point index is out of range, the faces of a polyhedron do not
/// close, there is no cell, or as TetrahedralMesh and MeshChannels do.
std::shared_ptr<const MeshChannels> cut_into_tetrahedra(const UnstructuredGrid& grid,
                                                        std::span<const MeshArrayChoice> choices,
                                                        const ParallelFor& parallel = {});

/// Returns the same tetrahedra as a grid, with all arrays and all their components. Throws Error
/// like cut_into_tetrahedra().
UnstructuredGrid tetrahedralize(const UnstructuredGrid& grid, const ParallelFor& parallel = {});

/// Returns the cells of a volume's grid as hexahedra with corners in world space and the values in
/// the array "value", per point or, if the volume is cell-centred, per cell. Throws Error if there
/// are more points than an index can count.
UnstructuredGrid to_unstructured(const Volume& volume);

}  // namespace pellucid
