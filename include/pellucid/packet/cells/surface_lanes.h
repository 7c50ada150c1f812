// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/light_lanes.h"
#include "pellucid/packet/surfaces.h"
#include "pellucid/segment/surface.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Between which isosurfaces the data of the lanes' rays are. The data are continuous and vacuum
/// nowhere, so that a ray knows that across what is skipped, too. Where binary32 cannot tell on
/// which side of a value the data are, the ray is for the general path: that is the caller's.
template <int N>
class SurfaceLanes {
 public:
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  /// Least distance of data from a value for their side to count, in what they may be off by.
  static constexpr float margin = 3;

  /// `surfaces`: null where there are none.
  SurfaceLanes(const PacketSurfaces* surfaces, const PacketLight& light,
               double largest_color) noexcept
      : surfaces_(surfaces), light_(light), largest_color_(static_cast<float>(largest_color)) {}

  bool exist() const noexcept { return surfaces_ != nullptr; }

  /// Returns what the data of cells may be off by, with this rounding and such ends.
  F close(const CubicBernstein<F>& data, F rounding, F place_error, F length) const noexcept {
    const F rise = max(max(abs(data.b[1] - data.b[0]), abs(data.b[2] - data.b[1])),
                       abs(data.b[3] - data.b[2]));
    return (rounding + F(surfaces_->value_error)) +
           F(3) * rise * min(place_error / max(length, F(1e-30f)), F(1));
  }

  /// The lanes come to a cell that begins with this value. Returns those in which it is not known
  /// to be in the range that the ray is in.
  M come_to(M lanes, F value, F close) noexcept {
    const M first = lanes & (range_ < I(0));
    if (any(first)) {
      I range(0);
      for (int i = 1; i <= surfaces_->count; ++i) {
        range += select(value > F(surfaces_->bound[i]), I(1), I(0));
      }
      range_ = select(first, range, range_);
    }
    return lanes & !is_inside(value, value, close);
  }

  F lower() const noexcept { return lookup(surfaces_->bound, max(range_, I(0))); }
  F upper() const noexcept { return lookup(surfaces_->bound, max(range_, I(0)) + I(1)); }
  /// Returns whether these data are in the ray's range, and known to be.
  M is_inside(F least, F most, F close) const noexcept {
    return (least > lower() + F(margin) * close) & (most < upper() - F(margin) * close);
  }
  /// Returns whether these data are outside of the ray's range, and known to be.
  M is_beyond(F value, F close) const noexcept {
    return (value > upper() + F(margin) * close) | (value < lower() - F(margin) * close);
  }
  /// Returns whether the range is so wide that data which leave it are known to have been in it.
  M is_wide(F close) const noexcept { return upper() - lower() > F(4 * margin) * close; }
  /// The lanes go through the upper end of their range, or through the lower one.
  void cross(M lanes, M rising) noexcept {
    range_ += select(lanes, select(rising, I(1), I(-1)), I(0));
  }

  bool is_lit() const noexcept { return surfaces_->is_lit != 0; }

  /// A surface that a ray meets.
  struct Met {
    F opacity;
    F depth;  ///< -ln(1 - opacity)
    Rgb<F> color;
    F error;  ///< of the color
  };
  /// Returns the surface at the end of the range, lit if there is light. `along`: the gradient in
  /// its cell, of this world length, with the surface at u as its middle; u off by u_error.
  Met meet(M rising, const GradientStretch<F>& along, F u, F u_error, F length) const noexcept {
    const I surface = max(range_, I(0)) + select(rising, I(1), I(0));
    Met met{lookup(surfaces_->opacity, surface),
            lookup(surfaces_->depth, surface),
            {lookup(surfaces_->color[0], surface), lookup(surfaces_->color[1], surface),
             lookup(surfaces_->color[2], surface)},
            F(4 * rounding_unit<float> * largest_color_)};
    if (!is_lit()) return met;
    met.color = light_surface(surfaces_->reflection, light_.light, light_.lights, along, u, u_error,
                              length, met.color, F(largest_color_), met.error);
    met.error += F(surfaces_->color_rounding);
    if (light_.points > 0) {
      met.error += place_doubt(surfaces_->reflection, light_.light, light_.lights, along,
                               F(largest_color_), F(place_rounding(light_)));
    }
    return met;
  }

 private:
  const PacketSurfaces* surfaces_;
  const PacketLight& light_;
  float largest_color_;
  I range_{-1};  ///< how many values are below the ray's data; -1: not known yet
};

}  // namespace pellucid
#endif
