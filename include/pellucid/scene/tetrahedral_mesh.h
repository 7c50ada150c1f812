// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/field/tetrahedra.h"
#include "pellucid/geometry/box.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Properties of a mesh that are known before it is rendered.
struct MeshStatistics {
  std::size_t points = 0;         ///< used by tetrahedra
  std::size_t unused_points = 0;  ///< used by none
  std::size_t tetrahedra = 0;
  std::size_t boundary_faces = 0;
  std::size_t degenerate = 0;  ///< tetrahedra without volume
  /// Pairs of tetrahedra on the same side of their shared face.
  std::size_t folded_faces = 0;
  std::size_t cells = 0;  ///< cells of the source that the tetrahedra were cut from
  /// Cells that overlap themselves or a neighbor: cells with a tetrahedron at such a face.
  std::size_t overlapping_cells = 0;
  std::int32_t first_overlapping_cell = -1;  ///< number of the first of them; -1: none
  double volume = 0;                         ///< sum over all tetrahedra, world units cubed
  double mean_edge = 0;                      ///< mean edge length over the tetrahedra
};

/// Tetrahedra that share points, with their neighbors: the mesh that rays walk through. Immutable
/// once made; not copied, but shared.
///
/// Where points lie on a ray or faces along it, the ray is in exactly one of the cells that touch
/// there: it is treated as displaced by an infinitesimal amount (traverse/mesh_walk.h). Meshes need
/// not be convex nor connected. Tetrahedra may be given in either orientation.
///
/// Rays are fastest if tetrahedra and points that are neighbors in space are neighbors in memory,
/// as after cut_into_tetrahedra(). Their order changes nothing else beyond rounding.
class TetrahedralMesh {
 public:
  struct Description {
    std::vector<Vec3<double>> points;                     ///< world
    std::vector<std::array<std::int32_t, 4>> tetrahedra;  ///< indices of points
    std::string name;                                     ///< for messages
    /// Numbers by which messages and point_number() refer to the points; empty: their indices.
    std::vector<std::int32_t> point_numbers{};
    /// Cell that each tetrahedron was cut from, counted from 0, for the statistics; empty: each
    /// tetrahedron is a cell.
    std::vector<std::int32_t> cells{};
    /// Numbers by which messages refer to the cells; empty: their indices.
    std::vector<std::int32_t> cell_numbers{};
  };

  /// Throws Error if there is no tetrahedron, an index is out of range or twice in one tetrahedron,
  /// there is not one number per point, a cell is out of range, a used point is not finite or
  /// beyond ±2.1e37, there are more than 2^28 tetrahedra, a face belongs to more than two of them,
  /// a tetrahedron is a duplicate, or none is at the boundary.
  ///
  /// Overlapping tetrahedra are counted if they share a face (MeshStatistics::folded_faces). Rays
  /// that are in two tetrahedra at once report that their error is unknown.
  explicit TetrahedralMesh(Description description, const ParallelFor& parallel = {});
  TetrahedralMesh(const TetrahedralMesh&) = delete;
  TetrahedralMesh& operator=(const TetrahedralMesh&) = delete;

  const std::string& name() const noexcept { return name_; }
  const std::vector<Vec3<double>>& points() const noexcept { return points_; }
  /// Returns the tetrahedra in the order in which they were given, the points of each in ascending
  /// order.
  const std::vector<Tetrahedron>& tetrahedra() const noexcept { return tetrahedra_; }
  /// Returns the number of a point in its source.
  std::int32_t point_number(std::size_t point) const noexcept;
  /// Returns "the tetrahedron of points 3, 7, 8 and 12", with the points' numbers in the source.
  std::string describe(std::size_t tetrahedron) const;
  const MeshStatistics& statistics() const noexcept { return statistics_; }
  const Box<double>& bounds() const noexcept { return bounds_; }
  /// Returns the bytes of memory that the rays' view and the point numbers take.
  std::size_t memory_bytes() const noexcept;

  /// Returns the view that rays walk through. Valid while this object lives.
  Tetrahedra view() const noexcept;
  /// Return the numbers of nodes and faces that the view's tree and boundary have.
  std::size_t tree_size() const noexcept { return tree_.size(); }
  std::size_t boundary_size() const noexcept { return boundary_.size(); }

 private:
  void measure(const ParallelFor& parallel);
  void count_overlapping_cells(const Description& description);
  double six_volumes_of(std::size_t tetrahedron) const;

  std::string name_;
  std::vector<Vec3<double>> points_;
  std::vector<Tetrahedron> tetrahedra_;
  std::vector<std::int32_t> point_numbers_;
  std::vector<BoundaryNode> tree_;
  std::vector<std::int32_t> boundary_;
  MeshStatistics statistics_;
  Box<double> bounds_;
};

}  // namespace pellucid
