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

/// What is known of a mesh before it is rendered.
struct MeshStatistics {
  std::size_t points = 0;         ///< that tetrahedra use
  std::size_t unused_points = 0;  ///< that none uses
  std::size_t tetrahedra = 0;
  std::size_t boundary_faces = 0;
  std::size_t degenerate = 0;  ///< tetrahedra without volume
  /// Pairs of tetrahedra on the same side of the face that they share.
  std::size_t folded_faces = 0;
  std::size_t cells = 0;  ///< that the tetrahedra were cut from
  /// Cells with a tetrahedron at such a face: they overlap themselves or a neighbour.
  std::size_t overlapping_cells = 0;
  std::int32_t first_overlapping_cell = -1;  ///< its number; -1: none
  double volume = 0;                         ///< of all tetrahedra, world units cubed
  double mean_edge = 0;                      ///< length of an edge, the mean over the tetrahedra's
};

/// Tetrahedra that share points, and who lies beside whom: what rays walk through. Immutable once
/// made; copies are not, share it.
///
/// Where points fall on a ray or faces along it, a ray is in exactly one of the cells that touch
/// there: it is thought of as moved aside by less than any number (traverse/mesh_walk.h). Meshes
/// need not be convex nor connected. Tetrahedra may be given in either orientation.
///
/// Rays are fastest where tetrahedra, and points, that lie together stand together, as those of
/// cut_into_tetrahedra() do; their order changes nothing else beyond rounding.
class TetrahedralMesh {
 public:
  struct Description {
    std::vector<Vec3<double>> points;                     ///< world
    std::vector<std::array<std::int32_t, 4>> tetrahedra;  ///< indices of points
    std::string name;                                     ///< for messages
    /// The numbers by which messages and point_number() call the points; empty: as they stand.
    std::vector<std::int32_t> point_numbers{};
    /// The cell that each tetrahedron was cut from, from 0 on, for the statistics; empty: each is
    /// one itself.
    std::vector<std::int32_t> cells{};
    /// The numbers of these cells; empty: as they are counted.
    std::vector<std::int32_t> cell_numbers{};
  };

  /// Throws Error where there is no tetrahedron, an index is out of range or twice in one
  /// tetrahedron, the numbers of points are not one for each, a cell is out of range, a point that
  /// is used is not finite or beyond ±2.1e37, there are more than 2^28 tetrahedra, a face belongs
  /// to more than two of them, one stands twice, or none is at the boundary. Tetrahedra that
  /// overlap are counted where they share a face (MeshStatistics::folded_faces); rays that find
  /// themselves in two of them say that they do not know.
  explicit TetrahedralMesh(Description description, const ParallelFor& parallel = {});
  TetrahedralMesh(const TetrahedralMesh&) = delete;
  TetrahedralMesh& operator=(const TetrahedralMesh&) = delete;

  const std::string& name() const noexcept { return name_; }
  const std::vector<Vec3<double>>& points() const noexcept { return points_; }
  /// In the order in which they were given, the points of each in ascending order.
  const std::vector<Tetrahedron>& tetrahedra() const noexcept { return tetrahedra_; }
  /// What a point is called where it comes from.
  std::int32_t point_number(std::size_t point) const noexcept;
  /// "the tetrahedron of points 3, 7, 8 and 12", by those numbers.
  std::string describe(std::size_t tetrahedron) const;
  const MeshStatistics& statistics() const noexcept { return statistics_; }
  const Box<double>& bounds() const noexcept { return bounds_; }
  /// What rays need, and the numbers of points, in memory: bytes.
  std::size_t memory_bytes() const noexcept;

  /// The view that rays walk through. Valid while this object lives.
  Tetrahedra view() const noexcept;

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
