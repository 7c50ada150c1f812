// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/random_errors.h"
#include "pellucid/packet/cells/span_light.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// The layers of a piece, taken together.
template <int N>
struct PieceSum {
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  F depth{0}, depth_error{0};
  F color_rounding{0};  ///< the largest one of any layer
  F color_error{0};     ///< likewise, error due to light and to kinks of tables
  Rgb<F> source{F(0), F(0), F(0)};
  Rgb<F> lower{F(1e30f), F(1e30f), F(1e30f)}, upper{F(-1e30f), F(-1e30f), F(-1e30f)};
  F own_range{0};  ///< of a layer that is alone
  I layers{0};
  F turns{1}, sharpness{0};
  M lit{false};
  // Of the depth where there are Gaussians: bounds, and the largest change of an exponent.
  F least{0}, most{0}, exponents{0};

  F range() const noexcept {
    const F apart = max(largest_component(upper - lower), F(0));
    return select(layers == I(1), min(own_range, apart), apart);
  }
  Rgb<F> color() const noexcept {
    const M shines = depth > F(0);
    return select(shines, F(1) / select(shines, depth, F(1)), F(0)) * source;
  }
  typename LikeErrors<F>::Signs signs(F range) const noexcept {
    const F feature[LikeErrors<F>::features] = {F(1) / turns, largest_component(upper),
                                                largest_component(lower), range};
    return LikeErrors<F>::signs(feature);
  }

  /// The colors of a layer's piece.
  struct Colors {
    Rgb<F> lower, upper;
    F range;
    F error;  ///< due to light and to kinks of tables
  };
  /// Adds a layer's piece, whose mean color by its extinction is `mean`, in these lanes.
  void add(M here, const SpanPiece<float, N>& piece, const Rgb<F>& mean,
           const Colors& colors) noexcept {
    // Without extinction there is no color.
    const F own_depth = select(here, piece.seen.depth, F(0));
    depth += own_depth;
    least += own_depth;
    most += own_depth;
    depth_error += select(here, piece.depth_error, F(0));
    const M shines = here & ((own_depth > F(0)) | (piece.depth_error > F(0)));
    add(shines, colors);
    color_rounding = select(here, max(color_rounding, piece.color_rounding), color_rounding);
    source.r += select(here, own_depth * mean.r, F(0));
    source.g += select(here, own_depth * mean.g, F(0));
    source.b += select(here, own_depth * mean.b, F(0));
  }
  /// Adds a layer of Gaussians in these lanes; `measure`: bounds on its depth.
  template <class Measure>
  void add_mixture(M here, const Measure& measure, const Colors& colors) noexcept {
    least += select(here, measure.least, F(0));
    most += select(here, measure.most, F(0));
    depth += select(here, measure.most, F(0));
    depth_error += select(here, measure.off, F(0));
    exponents = select(here, max(exponents, measure.exponents), exponents);
    add(here & (measure.most > F(0)), colors);
  }
  /// Takes in the light of a layer.
  void light_up(M here, const LightOfPiece<N>& of) noexcept {
    turns = select(here, max(turns, of.turns), turns);
    sharpness = select(here, max(sharpness, of.sharpness), sharpness);
    lit = lit | here;
  }

 private:
  void add(M shines, const Colors& colors) noexcept {
    const auto extend = [&](F& low, F& high, F below, F above) noexcept {
      low = select(shines, min(low, below), low);
      high = select(shines, max(high, above), high);
    };
    extend(lower.r, upper.r, colors.lower.r, colors.upper.r);
    extend(lower.g, upper.g, colors.lower.g, colors.upper.g);
    extend(lower.b, upper.b, colors.lower.b, colors.upper.b);
    layers += select(shines, I(1), I(0));
    own_range = select(shines, max(own_range, colors.range), own_range);
    color_error = select(shines, max(color_error, colors.error), color_error);
  }
};

}  // namespace pellucid
#endif
