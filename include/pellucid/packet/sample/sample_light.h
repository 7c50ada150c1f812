// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/light_lanes.h"
#include "pellucid/packet/sample/sampler_steps.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Light and gradient opacity at points of rays in lanes.
template <int N>
class SampleLight {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// Factors of an extinction and of a color at a point.
  struct AtPoint {
    F factor;
    Lit<F> lit;
  };

  /// All must outlive the object. `light`: null where there is none.
  SampleLight(const PacketGrid& grid, const PacketLight* light,
              const RaysInBlocks<N>& rays) noexcept
      : grid_(grid),
        is_lit_(light != nullptr),
        light_(is_lit_ ? *light : none),
        rays_(rays),
        loads_(grid, light_) {
    if (is_lit_) to_eye_ = direction_to_eye(light_, rays.direction());
  }

  bool is_lit() const noexcept { return is_lit_; }
  /// At a world length along the lanes' rays; in other lanes anything.
  [[gnu::noinline]] AtPoint operator()(M lanes, D along) const noexcept {
    D at[3];
    rays_.place(along, at);
    I cell[3];
    Vec3<D> in_cell;
    Vec3<F> place;
    for (int a = 0; a < 3; ++a) {
      const D inside = clamp(at[a], D(0), D(grid_.cells[a]));
      const D lower = min(floor(inside), D(grid_.cells[a] - 1));
      cell[a] = select(lanes, convert<std::int32_t>(lower), I(0));
      in_cell[a] = inside - lower;
      place[a] = convert<float>(in_cell[a]);
    }
    Vec3<F> gradient, position;
    F magnitude(0);
    loads_.at(lanes, cell, place, gradient, magnitude);
    AtPoint result;
    result.factor = F(1);
    if (light_.factor != nullptr) {
      I interval(0);
      const ExtinctionInterval<F> found =
          find_extinction(*light_.factor, magnitude, lanes, interval);
      result.factor = found.bounded(magnitude);
    }
    if (light_.points > 0) position = place_in_world(grid_, light_, cell, in_cell);
    result.lit =
        light_up(light_.reflection, light_.light, light_.lights, gradient, position, to_eye_);
    return result;
  }

 private:
  static constexpr PacketLight none{};

  const PacketGrid& grid_;
  bool is_lit_;
  const PacketLight& light_;
  const RaysInBlocks<N>& rays_;
  GradientLoads<N> loads_;
  Vec3<F> to_eye_;
};

}  // namespace pellucid
#endif
