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

/// One variable of a mesh: values at points, linear in each tetrahedron, or one value per
/// tetrahedron.
struct MeshChannel {
  std::string name;
  std::string unit;  ///< shown to the user; may be empty
  Centering centering = Centering::point;
  VolumeData values = DataArray<float>();  ///< one per point or per tetrahedron
};

/// One to eight variables on one mesh, each in its own type. Immutable; copies share the data.
///
/// A tetrahedron with a NaN in any channel, at one of its points or as its own value, is vacuum.
class MeshChannels {
 public:
  /// Throws Error if there is no channel or more than eight, a name is empty or a duplicate, the
  /// number of a channel's values differs from the number of points or tetrahedra, or a value that
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
  /// Returns the index of the channel of this name, or none.
  std::optional<int> find(std::string_view name) const noexcept;

  /// Returns the statistics of a channel, over the values that tetrahedra use.
  const VolumeStatistics& statistics(int channel) const noexcept {
    return statistics_[static_cast<std::size_t>(channel)];
  }
  /// Returns the number of tetrahedra that are vacuum because of NaN.
  std::size_t vacuum_count() const noexcept { return vacuum_; }

  /// Returns the value of a channel at a point, or in a tetrahedron if the channel is cell-centred.
  double value(int channel, std::size_t index) const;

 private:
  std::shared_ptr<const TetrahedralMesh> mesh_;
  std::vector<MeshChannel> channels_;
  std::vector<VolumeStatistics> statistics_;
  std::size_t vacuum_ = 0;
};

}  // namespace pellucid
