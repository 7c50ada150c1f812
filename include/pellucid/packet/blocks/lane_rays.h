// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/blocks/packet_grid.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes, from where they enter a grid, in plane coordinates.
template <int N>
struct LaneRays {
  using D = Batch<double, N>;
  using M = BatchMask<N>;

  D begin, end;  ///< world length from the eye to the entry; from there to where they leave
  D origin[3], direction[3], inverse[3];  ///< the entry; by world length; world length by it
  M forward[3], still[3];

  /// Rays of lanes beyond `count` end where they begin.
  LaneRays(const PacketGrid& grid, const PellucidRay* rays, int count) noexcept {
    double o[3][N], d[3][N], b[N], e[N];
    constexpr PellucidRay none{};
    for (int l = 0; l < N; ++l) {
      const PellucidRay& ray = count > 0 ? rays[l < count ? l : 0] : none;
      for (int a = 0; a < 3; ++a) {
        d[a][l] = ray.direction[a];
        o[a][l] = ray.origin[a] + ray.begin * ray.direction[a] + grid.padding[a];
      }
      b[l] = ray.begin;
      e[l] = l < count ? ray.end - ray.begin : 0;
    }
    begin = D::load(b);
    end = D::load(e);
    for (int a = 0; a < 3; ++a) {
      origin[a] = D::load(o[a]);
      direction[a] = D::load(d[a]);
      inverse[a] = D(1) / direction[a];
      forward[a] = direction[a] > D(0);
      still[a] = direction[a] == D(0);
    }
  }
};

/// Returns the widths of the cubes of these levels, in blocks.
template <int N>
Batch<std::int32_t, N> side_of_cube(Batch<std::int32_t, N> level) noexcept {
  static constexpr std::int32_t sides[8] = {1, 2, 4, 8, 16, 32, 64, 128};
  return gather(sides, level);
}

}  // namespace pellucid
#endif
