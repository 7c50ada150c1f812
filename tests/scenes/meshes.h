// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pellucid/scene/mesh_channels.h"

/// Meshes of tetrahedra for tests, and what is on them.
namespace pellucid::scenes {

using MeshPointer = std::shared_ptr<const TetrahedralMesh>;
using MeshChannelsPointer = std::shared_ptr<const MeshChannels>;

/// Cubes in rows and columns, six tetrahedra in each around the same diagonal (H. W. Kuhn 1960), so
/// that all faces match.
struct Lattice {
  std::array<int, 3> cubes{1, 1, 1};
  /// Where the point (i, j, k), 0 <= i <= cubes, goes.
  std::function<Vec3<double>(int i, int j, int k)> place;
  bool closed = false;  ///< the last layer of points along i is the first: a ring
  std::function<bool(int i, int j, int k)> keep{};  ///< which cubes are there; empty: all
};
TetrahedralMesh::Description tetrahedralize(const Lattice& lattice);

/// Delaunay's tetrahedra of points at random in [-1,1]³ (A. Bowyer, D. F. Watson 1981), with all
/// the slivers that they have. The boundary is not quite convex.
TetrahedralMesh::Description random_delaunay(int points, unsigned seed);

/// [-1,1]³, cut into cubes³ cubes.
TetrahedralMesh::Description box_of_cubes(int cubes);

/// The tetrahedra with both descriptions' points.
TetrahedralMesh::Description joined(TetrahedralMesh::Description first,
                                    const TetrahedralMesh::Description& second);

MeshPointer make_mesh(TetrahedralMesh::Description description);

using PlaceFunction = std::function<double(const Vec3<double>& place)>;
/// f at the points, as double.
MeshChannel at_points(const TetrahedralMesh& mesh, const std::string& name, const PlaceFunction& f);
/// f at the centres of the tetrahedra, as float.
MeshChannel at_cells(const TetrahedralMesh& mesh, const std::string& name, const PlaceFunction& f);

MeshChannelsPointer on_mesh(const MeshPointer& mesh, std::vector<MeshChannel> channels);

}  // namespace pellucid::scenes
