// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/bundle/lane_primitive_sets.h"
#include "pellucid/segment/gaussian_cubic.h"
#include "pellucid/segment/gaussian_mixture.h"

namespace pellucid {

/// A sum of Gaussians of several variables as lanes see it. Plain numbers, the same for every
/// instruction set.
struct LaneMixture {
  GaussianMixture<float> gaussians;
  int channels = 0;
};

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
/// The data of lanes' rows in a layer of several variables, and what its Gaussians make of them.
template <int N>
struct MixtureLanes {
  using F = Batch<float, N>;
  using M = BatchMask<N>;

  CubicBernstein<F> data[max_channels];  ///< of the rows
  F rounding[max_channels];              ///< what these may be off by
  CubicBernstein<F> part[max_channels];  ///< of the pieces
  LanePrimitiveSets<N> set, near;        ///< primitives that may matter in a row, in a piece

  /// Bounds on a piece.
  struct Measure {
    F least{0}, most{0};  ///< on its depth
    F off{0};             ///< what rounding and what is ignored move the depth by
    F exponents{0};       ///< largest change of an exponent
    ColorRange<F> colors;
  };

  /// Measures the share [from, to] of rows, of this world length.
  [[gnu::noinline]] Measure measure(const LaneMixture& of, M here, F from, F to,
                                    F length) noexcept {
    constexpr float unit = rounding_unit<float>;
    for (int c = 0; c < of.channels; ++c) part[c] = restrict_to(data[c], from, to);
    Measure result;
    near = {};
    for (int i = 0; i < of.gaussians.count; ++i) {
      const M held = here & set.contains(i);
      if (none(held)) continue;
      const Gaussian<float>& g = of.gaussians.primitive[i];
      const auto along = gaussian_along(g, part + g.first);
      const F peak = F(g.peak) * length;
      const F bound = peak * exp(-min(along.lower(), F(80)));
      // The error of the place, p = K (v - c).
      F place(0);
      for (int row = 0; row < g.rows; ++row) {
        for (int c = 0; c < g.channels; ++c) {
          const float k = max(g.matrix[row][c], -g.matrix[row][c]);
          const float center = max(g.center[c], -g.center[c]);
          place += F(k) * (rounding[g.first + c] + F(2 * unit * center));
        }
      }
      // Where that is no small part of a width, no bound here holds.
      const M known = place < F(1.0f / 64);
      result.off += select(held & !known, F(1e30f), F(0));
      const M matters = held & known & (bound > F(negligible));
      result.off += select(held & known & !matters, bound, F(0));
      if (none(matters)) continue;
      near.add(matters, i);
      // Charge |p|² with 2 |p| times that and its rounding, and a quarter more for the second
      // order.
      const F upper = min(along.upper(), F(80));
      const F moved = F(2.5f) * (sqrt(upper) + place) * place + F(32 * unit) * (F(1) + upper);
      result.off += select(matters, bound * moved, F(0));
      result.most += select(matters, bound, F(0));
      result.least += select(matters, peak * exp(-upper), F(0));
      result.exponents =
          select(matters, max(result.exponents, along.upper() - along.lower()), result.exponents);
      result.colors.add(matters, Rgb<F>{F(g.color.r), F(g.color.g), F(g.color.b)});
    }
    return result;
  }

  /// Returns extinction and color at u of the pieces.
  Material<F> material(const LaneMixture& of, M here, F u) const noexcept {
    F v[max_channels];
    for (int c = 0; c < of.channels; ++c) v[c] = evaluate(part[c], u);
    F extinction(0);
    Rgb<F> emission{F(0), F(0), F(0)};
    for (int i = 0; i < of.gaussians.count; ++i) {
      const M held = here & near.contains(i);
      if (none(held)) continue;
      const Gaussian<float>& g = of.gaussians.primitive[i];
      const F density = F(g.peak) * g.density(v + g.first);
      const F own = select(held, density, F(0));
      extinction += own;
      emission += own * Rgb<F>{F(g.color.r), F(g.color.g), F(g.color.b)};
    }
    const M shines = extinction >= F(smallest_normal<float>);
    return {extinction, select(shines, F(1) / select(shines, extinction, F(1)), F(0)) * emission};
  }

 private:
  /// The largest depth that is charged and not looked at.
  static constexpr float negligible = 0x1p-40f;
};
#endif

}  // namespace pellucid
