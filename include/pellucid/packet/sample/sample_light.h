// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/gradient_loads.h"
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

  /// What a point makes of an extinction and of a color.
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
    if (!is_lit_) return;
    for (int c = 0; c < 3; ++c) {
      D sum(0);
      for (int a = 0; a < 3; ++a) sum += D(light_.world_direction[c][a]) * rays.direction()[a];
      to_eye_[c] = -convert<float>(sum);
    }
  }

  bool is_lit() const noexcept { return is_lit_; }
  /// At a world length along the lanes' rays; in other lanes anything.
  [[gnu::noinline]] AtPoint operator()(M lanes, D along) const noexcept {
    D at[3];
    rays_.place(along, at);
    I cell[3];
    Vec3<F> place;
    for (int a = 0; a < 3; ++a) {
      const D inside = clamp(at[a], D(0), D(grid_.cells[a]));
      const D lower = min(floor(inside), D(grid_.cells[a] - 1));
      cell[a] = select(lanes, convert<std::int32_t>(lower), I(0));
      place[a] = convert<float>(inside - lower);
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
    if (light_.points > 0) {
      for (int c = 0; c < 3; ++c) {
        D sum(light_.world_origin[c]);
        for (int a = 0; a < 3; ++a) {
          sum = multiply_add(D(light_.world_direction[c][a]), at[a] - D(grid_.padding[a]), sum);
        }
        position[c] = convert<float>(sum);
      }
    }
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
