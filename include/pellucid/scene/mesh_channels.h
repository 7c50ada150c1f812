// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/tetrahedral_mesh.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// One variable of a mesh: linear in each tetrahedron between the values at its points, or constant
/// in it.
struct MeshChannel {
  std::string name;
  std::string unit;  ///< for people; may be empty
  Centering centering = Centering::point;
  VolumeData values = DataArray<float>();  ///< one per point or per tetrahedron
};

/// One to eight variables on one mesh, each in its own type: what a scene shows of it. Immutable;
/// copies share the data.
///
/// NaN is vacuum: a tetrahedron with a NaN in any channel, at one of its points or its own, is
/// empty.
class MeshChannels {
 public:
  /// Throws Error where there is no channel or more than eight, a name is empty or stands twice, a
  /// channel has another number of values than the mesh has points or tetrahedra, or a value that
  /// is used is infinite or beyond ±2.1e37.
  MeshChannels(std::shared_ptr<const TetrahedralMesh> mesh, std::vector<MeshChannel> channels);

  const TetrahedralMesh& mesh() const noexcept { return *mesh_; }
  const std::shared_ptr<const TetrahedralMesh>& shared_mesh() const noexcept { return mesh_; }
  int count() const noexcept { return static_cast<int>(channels_.size()); }
  const MeshChannel& operator[](int i) const noexcept {
    return channels_[static_cast<std::size_t>(i)];
  }
  std::vector<MeshChannel>::const_iterator begin() const noexcept { return channels_.begin(); }
  std::vector<MeshChannel>::const_iterator end() const noexcept { return channels_.end(); }
  std::optional<int> find(std::string_view name) const noexcept;

  /// Over the values that tetrahedra use.
  const VolumeStatistics& statistics(int channel) const noexcept {
    return statistics_[static_cast<std::size_t>(channel)];
  }
  /// Tetrahedra that are vacuum because of NaN.
  std::size_t vacuum_count() const noexcept { return vacuum_; }

  /// The value of a channel at a point, or in a tetrahedron where it is centred there, in double.
  double value(int channel, std::size_t index) const;

 private:
  std::shared_ptr<const TetrahedralMesh> mesh_;
  std::vector<MeshChannel> channels_;
  std::vector<VolumeStatistics> statistics_;
  std::size_t vacuum_ = 0;
};

}  // namespace pellucid
