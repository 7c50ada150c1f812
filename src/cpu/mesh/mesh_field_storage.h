// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include "pellucid/field/tetrahedra.h"
#include "pellucid/scene/mesh_channels.h"

namespace pellucid {

/// The channels' values in double, as rays see them.
class MeshFieldStorage {
 public:
  explicit MeshFieldStorage(const MeshChannels& channels)
      : values_(static_cast<std::size_t>(channels.count())) {
    fields_.channels = channels.count();
    for (int c = 0; c < channels.count(); ++c) {
      std::vector<double>& values = values_[static_cast<std::size_t>(c)];
      std::visit([&](const auto& own) { values.assign(own.begin(), own.end()); },
                 channels[c].values);
      fields_.channel[c] = {values.data(), channels[c].centering == Centering::cell};
    }
  }
  const MeshFields& view() const noexcept { return fields_; }

  /// PellucidMeshJob::values of all channels.
  std::vector<double> values_by_point(std::size_t points) const {
    const auto groups = static_cast<std::size_t>((fields_.channels + 3) / 4);
    std::vector<double> result(4 * points * groups, 0.0);
    for (int c = 0; c < fields_.channels; ++c) {
      const MeshField& field = fields_.channel[c];
      if (field.per_cell) continue;
      const std::size_t first = 4 * points * static_cast<std::size_t>(c / 4);
      for (std::size_t i = 0; i < points; ++i) {
        result[first + 4 * i + static_cast<std::size_t>(c % 4)] = field.value[i];
      }
    }
    return result;
  }

  /// Returns the mesh's points with the values of the first channel.
  std::vector<MeshPoint> points(const std::vector<Vec3<double>>& positions) const {
    std::vector<MeshPoint> points(positions.size());
    const MeshField& first = fields_.channel[0];
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = {positions[i], first.per_cell ? 0 : first.value[i]};
    }
    return points;
  }

 private:
  std::vector<std::vector<double>> values_;
  MeshFields fields_;
};

}  // namespace pellucid
