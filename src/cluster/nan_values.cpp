// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <type_traits>

#include "pellucid/cluster/sub_scene.h"

namespace pellucid {
namespace {

/// Counts the NaN among the values whose positions are in a brick's part of the world.
std::size_t nan_in_region(const Volume& volume, const Affine<double>& transform,
                          const RayRegion& region) {
  if (volume.statistics().nan == 0) return 0;
  return volume.visit([&](const auto& grid) {
    std::size_t count = 0;
    using Value = std::decay_t<decltype(*grid.data)>;
    if constexpr (std::is_floating_point_v<Value>) {
      const auto place = [&](int a, int i) {
        return double{grid.axis[a].plane(i + grid.axis[a].padding)};
      };
      for (int k = 0; k < grid.axis[2].values; ++k) {
        for (int j = 0; j < grid.axis[1].values; ++j) {
          for (int i = 0; i < grid.axis[0].values; ++i) {
            if (!std::isnan(grid.data[grid.offset(i, j, k)])) continue;
            const Vec3<double> world = transform.point(
                volume.world_from_grid().point({place(0, i), place(1, j), place(2, k)}));
            count += std::ranges::all_of(region.half_spaces, [&](const RayRegion::HalfSpace& half) {
              return (dot(half.normal, world) >= half.offset) == half.above;
            });
          }
        }
      }
    }
    return count;
  });
}

std::size_t nan_of_layer(const Layer& layer, const RayRegion& region, bool is_first) {
  if (const auto* const mesh = std::get_if<MeshContent>(&layer.content)) {
    std::size_t count = 0;
    for (int c = 0; is_first && c < mesh->mesh->count(); ++c) {
      count += mesh->mesh->statistics(c).nan;
    }
    return count;
  }
  if (const auto* const channels = std::get_if<ChannelsContent>(&layer.content)) {
    std::size_t count = 0;
    for (const Channel& channel : *channels->channels) {
      count += nan_in_region(*channel.volume, layer.transform, region);
    }
    return count;
  }
  if (grid_of(layer) == nullptr) return 0;
  return nan_in_region(*grid_of(layer), layer.transform, region);
}

}  // namespace

std::vector<std::size_t> nan_values(Communicator& ranks, const BrickTree& tree, const Scene& own) {
  const RayRegion region = tree.region(ranks.rank());
  std::vector<double> counts;
  for (const Layer& layer : own.layers) {
    counts.push_back(static_cast<double>(nan_of_layer(layer, region, ranks.rank() == 0)));
  }
  ranks.reduce_all(counts, Communicator::Reduction::sum);
  return {counts.begin(), counts.end()};
}

}  // namespace pellucid
