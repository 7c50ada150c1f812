// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/gradient_loads.h"
#include "pellucid/packet/cells/span_light.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Returns places in the world, from the middle of the grid, of plane coordinates.
template <int N>
Vec3<Batch<float, N>> place_in_world(const PacketGrid& grid, const PacketLight& light,
                                     const Batch<std::int32_t, N> (&cell)[3],
                                     const Vec3<Batch<double, N>>& in_cell) noexcept {
  using D = Batch<double, N>;
  Vec3<Batch<float, N>> result;
  for (int c = 0; c < 3; ++c) {
    D sum(light.world_origin[c]);
    for (int a = 0; a < 3; ++a) {
      const D at = convert<double>(cell[a]) + in_cell[a] - D(static_cast<double>(grid.padding[a]));
      sum = multiply_add(D(light.world_direction[c][a]), at, sum);
    }
    result[c] = convert<float>(sum);
  }
  return result;
}

/// Returns the directions in the world from which rays with these in the grid come, of length 1.
template <int N>
Vec3<Batch<float, N>> direction_to_eye(const PacketLight& light,
                                       const Batch<double, N>* direction) noexcept {
  using D = Batch<double, N>;
  Vec3<Batch<float, N>> result;
  for (int c = 0; c < 3; ++c) {
    D sum(0);
    for (int a = 0; a < 3; ++a) sum += D(light.world_direction[c][a]) * direction[a];
    result[c] = -convert<float>(sum);
  }
  return result;
}
template <int N>
Vec3<Batch<float, N>> direction_to_eye(const PacketLight& light,
                                       const BlockMarch<N>& rays) noexcept {
  using D = Batch<double, N>;
  const D direction[3] = {D::load(rays.direction[0]), D::load(rays.direction[1]),
                          D::load(rays.direction[2])};
  return direction_to_eye(light, direction);
}

/// The light of the spans that lanes work on, of cells of a grid.
template <int N>
class LightLanes : public SpanLight<N> {
 public:
  using F = Batch<float, N>;
  using M = BatchMask<N>;

  LightLanes(const PacketGrid& grid, const PacketLight& light, const BlockMarch<N>& rays) noexcept
      : SpanLight<N>(light, direction_to_eye(light, rays)),
        grid_(grid),
        light_(light),
        loads_(grid, light) {}

  /// Begins spans. Returns the lanes in which a point light is too near for nodes.
  [[gnu::noinline]] M begin(M lanes, const CellPositions<N>& places) noexcept {
    loads_(lanes, places, this->gradient_, this->magnitude_);
    Vec3<F> entry{F(0), F(0), F(0)};
    if (light_.points > 0) entry = place_in_world(grid_, light_, places.cell, places.entry);
    return this->begin_loaded(lanes, entry, convert<float>(places.length));
  }

 private:
  const PacketGrid& grid_;
  const PacketLight& light_;
  GradientLoads<N> loads_;
};

}  // namespace pellucid
#endif
