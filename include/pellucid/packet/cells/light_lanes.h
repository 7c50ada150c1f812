// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/span_gradients.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

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
      : LightLanes(grid, light, direction_to_eye(light, rays)) {}

  /// Begins with what a SpanFinder has found.
  void begin(const SpanWorkspace<N>& spans, const SpanWays<N>& ways) noexcept {
    ahead_.begin(spans, ways);
  }

  /// Begins the next spans of the lanes' rays, of these world lengths. Returns the lanes in which a
  /// point light is too near for nodes.
  M take(M lanes, F length) noexcept {
    ahead_.take(lanes, found_);
    return this->begin_known(lanes, found_.gradient, found_.magnitude, found_.entry, length,
                             found_.kink);
  }

  /// Gives up what is left of the lanes' rays.
  void drop(M lanes) noexcept { ahead_.drop(lanes); }

 private:
  LightLanes(const PacketGrid& grid, const PacketLight& light, const Vec3<F>& to_eye) noexcept
      : SpanLight<N>(light, to_eye), ahead_(grid, light, to_eye) {}

  SpanGradients<N> ahead_;
  typename SpanGradients<N>::Found found_;
};

}  // namespace pellucid
#endif
