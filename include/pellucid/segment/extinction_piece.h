// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/bounds.h"
#include "pellucid/math/bernstein.h"
#include "pellucid/segment/bounded.h"
#include "pellucid/segment/constant.h"
#include "pellucid/segment/cubic_panel.h"
#include "pellucid/transfer/binned.h"

namespace pellucid {

/// The end of the first piece of a cubic on [0,1]: where it leaves [lower, upper], or an earlier
/// extremum, or 1.
template <class F>
struct PieceEnd {
  F place;
  mask_t<F> crosses;  ///< whether the piece ends at lower or upper
  mask_t<F> rising;   ///< whether it is upper
  mask_t<F> found;    ///< false: the position was not found to within `close`
};

namespace detail {

/// Returns the first extremum of the cubic f(0) + t (c1 + t (c2 + t c3)) in (0,1) with a value
/// further than `close` from f(0), or 1. Like critical_points() in math/cubic_roots.h, but without
/// the fused radicand: rounding may produce an extremum that is not there.
template <class F>
F first_turn(F c1, F c2, F c3, F close) noexcept {
  // f' = c1 + 2 c2 t + 3 c3 t².
  const F radicand = max(c2 * c2 - F(3) * (c1 * c3), F(0));
  const F w = -(c2 + copysign(sqrt(radicand), c2));
  const auto turn = [&](F t) noexcept {  // NaN and infinite: none
    const auto turns = (t > F(0)) & (t < F(1)) & (abs(t * (c1 + t * (c2 + t * c3))) > close);
    return select(turns, t, F(1));
  };
  return min(turn(w / (F(3) * c3)), turn(c1 / w));
}

}  // namespace detail

/// The first monotone piece of a cubic: f(0) + t (c1 + t (c2 + t c3)), in differences of
/// neighboring coefficients.
template <class F>
struct MonotonePiece {
  F c1, c2, c3;
  F place;  ///< where it ends: at an extremum, or at 1
  F reach;  ///< f there
};

/// Returns the first monotone piece in the lanes of `wanted`. An extremum that is not further than
/// `close` from f(0) does not count as one.
template <class F>
MonotonePiece<F> monotone_piece(const CubicBernstein<F>& f, F close,
                                const mask_t<F>& wanted) noexcept {
  const F d0 = f.b[1] - f.b[0], d1 = f.b[2] - f.b[1], d2 = f.b[3] - f.b[2];
  const auto turns = wanted & !(((d0 >= F(0)) & (d1 >= F(0)) & (d2 >= F(0))) |
                                ((d0 <= F(0)) & (d1 <= F(0)) & (d2 <= F(0))));
  MonotonePiece<F> piece{F(3) * d0, F(3) * (d1 - d0), (d2 - d1) - (d1 - d0), F(1), f.b[3]};
  if (!any(turns)) return piece;
  const F c1 = piece.c1, c2 = piece.c2, c3 = piece.c3;
  const F t = detail::first_turn(c1, c2, c3, close);
  piece.place = select(turns, t, F(1));
  piece.reach = select(turns, f.b[0] + t * (c1 + t * (c2 + t * c3)), piece.reach);
  return piece;
}

/// Returns where the piece crosses `value`, to within `close` of it, in the lanes of `crosses`:
/// those where it reaches beyond. `open`: the lanes where it was not found so well.
///
/// Halley's method from the secant of a monotone stretch, in a bracket that always contains the
/// crossing; a step out of the bracket becomes a bisection. Finished lanes wait for the others.
template <class F>
F find_crossing(const CubicBernstein<F>& f, const MonotonePiece<F>& piece, F value,
                const mask_t<F>& rising, F close, const mask_t<F>& crosses,
                mask_t<F>& open) noexcept {
  const F sign = select(rising, F(1), F(-1));
  const F g0 = sign * (f.b[0] - value), g1 = sign * piece.c1, g2 = sign * piece.c2,
          g3 = sign * piece.c3;
  // Rises from g0 <= 0.
  const F rise = sign * (piece.reach - f.b[0]);
  F lo = F(0), hi = piece.place;
  F place = hi * clamp(-g0 / rise, F(0), F(1));
  open = crosses & (g0 < F(0));
  place = select(crosses & !open, F(0), place);
  for (int i = 0; i < 32; ++i) {
    const F here = g0 + place * (g1 + place * (g2 + place * g3));
    open = open & (abs(here) > close);
    if (!any(open)) break;
    const F bend = g2 + place * (F(3) * g3);  // half of the second derivative
    const F slope = g1 + place * (g2 + bend);
    const auto below = here < F(0);
    lo = select(open & below, place, lo);
    hi = select(open & !below, place, hi);
    const F next = place - here * slope / (slope * slope - here * bend);
    const auto kept = (next > lo) & (next < hi);
    place = select(open, select(kept, next, F(0.5f) * (lo + hi)), place);
  }
  return place;
}

/// Returns the end of the first piece. f(0) lies in [lower, upper] to within `close`, which is also
/// the distance outside that does not yet count as left, and the accuracy of crossings.
template <class F>
PieceEnd<F> piece_end(const CubicBernstein<F>& f, F lower, F upper, F close,
                      const mask_t<F>& wanted) noexcept {
  PieceEnd<F> end{F(1), mask_t<F>(false), mask_t<F>(false), mask_t<F>(true)};
  const auto leaves = wanted & ((f.hull_min() < lower - close) | (f.hull_max() > upper + close));
  if (!any(leaves)) return end;
  const MonotonePiece<F> piece = monotone_piece(f, close, leaves);
  end.place = piece.place;
  end.rising = piece.reach > f.b[0];
  end.crosses =
      leaves & select(end.rising, piece.reach > upper + close, piece.reach < lower - close);
  if (!any(end.crosses)) return end;
  mask_t<F> open;
  const F place = find_crossing(f, piece, select(end.rising, upper, lower), end.rising, close,
                                end.crosses, open);
  end.found = !open;
  end.place = select(end.crosses, place, end.place);
  return end;
}

/// The two parts of a cubic cut at a position, both on [0,1].
template <class F>
struct CutCubic {
  CubicBernstein<F> front, back;
};
/// Cuts a cubic at t, by de Casteljau.
template <class F>
CutCubic<F> cut(const CubicBernstein<F>& f, F t) noexcept {
  const F p0 = f.b[0] + t * (f.b[1] - f.b[0]), p1 = f.b[1] + t * (f.b[2] - f.b[1]),
          p2 = f.b[2] + t * (f.b[3] - f.b[2]);
  const F q0 = p0 + t * (p1 - p0), q1 = p1 + t * (p2 - p1);
  const F r = q0 + t * (q1 - q0);
  return {{{f.b[0], p0, q0, r}}, {{r, q1, p2, f.b[3]}}};
}

/// Optical depth and data of a piece: cubic data in one interval of the extinction.
template <class F>
struct PieceDepth {
  F depth;         ///< exact up to rounding: the mean of a linear function is its value at the mean
  F value;         ///< the mean of the data weighted by extinction, also exact up to rounding
  F lower, upper;  ///< bounds of the data
  /// Bounds to which values for color look-ups are clamped: those of the piece's own interval,
  /// despite rounding.
  F color_lower, color_upper;
};

/// Computes the depth, and mean + slope · variance / mean extinction, which is the mean weighted by
/// extinction.
template <class F>
PieceDepth<F> piece_depth(const CubicBernstein<F>& data, const ExtinctionInterval<F>& interval,
                          F length) noexcept {
  using S = scalar_t<F>;
  PieceDepth<F> piece;
  piece.lower = max(data.hull_min(), interval.lower);
  piece.upper = min(data.hull_max(), interval.upper);
  const F d1 = data.b[1] - data.b[0], d2 = data.b[2] - data.b[0], d3 = data.b[3] - data.b[0],
          inner = data.b[2] - data.b[1];
  const F mean = data.b[0] + F(S(0.25)) * ((d1 + d2) + d3);
  const F p1 = F(S(0.15)) * (F(3) * d3 + inner), p2 = F(S(0.25)) * (d3 - (d1 + d2)),
          p3 = F(S(0.05)) * (d3 - F(3) * inner);
  const F variance = F(S(1.0 / 3)) * (p1 * p1) + F(S(0.2)) * (p2 * p2) + F(S(1.0 / 7)) * (p3 * p3);
  const F extinction = max(interval.at_lower + interval.slope * (mean - interval.lower), F(0));
  piece.depth = length * extinction;
  const F shift = select(extinction > F(0), interval.slope * variance / extinction, F(0));
  piece.value = clamp(mean + shift, piece.lower, piece.upper);
  piece.color_lower = piece.lower;
  piece.color_upper = piece.upper;
  return piece;
}

/// Returns the range of a piece's data.
template <class F>
in_float_t<F> range_of(const PieceDepth<F>& piece) noexcept {
  return convert<float>(max(piece.upper - piece.lower, F(0)));
}

/// Returns an upper bound on |E c(v) - c(E v)| for the color c and data between `lower` and
/// `upper`, whatever their distribution: (total change of the slope of c) · (range of the values) /
/// 4, because a kink at k on a range [a, b] contributes at most (k - a)(b - k)/(b - a).
template <class F>
in_float_t<F> color_kink_error(const BinnedTransfer& transfer, F lower, F upper) noexcept {
  using Single = in_float_t<F>;
  if (!transfer.has_color_breakpoints) return Single(0);
  // The bins' bounds hold for rounded values; their difference does not.
  const Single slope_change =
      color_slope_change(transfer, convert<float>(lower), convert<float>(upper));
  return Single(0.25f) * (slope_change * convert<float>(max(upper - lower, F(0))));
}

/// Bounds on the differences between the colors of a piece.
template <class F>
struct ColorSpread {
  F range, slope;  ///< of its interval of the extinction: see ExtinctionInterval
  F kinks;         ///< color_kink_error()
};

/// Returns the segment of a piece, with the color at the mean of the data weighted by extinction.
///
/// color_error is proved: by (5), range of the colors · opacity · κ(depth) for the weighting by
/// transparency, plus color_kink_error() if the color has kinks. Neither includes rounding.
/// `wanted` and `known` are those of color_at(). Transfer: a BinnedTransfer, or several.
template <class F, class Transfer>
BoundedSegment<in_float_t<F>> colored_piece(const PieceDepth<F>& piece,
                                            const ColorSpread<in_float_t<F>>& spread,
                                            const Transfer& transfer, const mask_t<F>& wanted,
                                            ColorInterval<F>& known) noexcept {
  using Single = in_float_t<F>;
  BoundedSegment<Single> result;
  const F value = clamp(piece.value, piece.color_lower, piece.color_upper);
  const Single depth = convert<float>(piece.depth);
  result.segment = segment_of_depth(depth, color_at(transfer, value, wanted, known));
  const Single colors = min(spread.range, spread.slope * range_of(piece));
  const Single moves = colors * mean_color_bound(depth) + spread.kinks;
  result.color_error = result.segment.opacity * min(moves, spread.range);
  return result;
}

/// The data of a piece for a Gauss panel, which needs only the digits of their differences.
template <class F>
struct PiecePanel {
  using Single = in_float_t<F>;

  CubicBernstein<Single> rise;      ///< data minus their first value
  F first;                          ///< that value
  Single rate_first, rate_by_rise;  ///< extinction · length there, and its derivative by the data
};

template <class F>
PiecePanel<F> piece_panel(const CubicBernstein<F>& data, const ExtinctionInterval<F>& interval,
                          F length) noexcept {
  PiecePanel<F> panel;
  const F first = data.b[0];
  for (int k = 0; k < 4; ++k) panel.rise.b[k] = convert<float>(data.b[k] - first);
  panel.first = first;
  panel.rate_first = convert<float>(
      length * max(interval.at_lower + interval.slope * (first - interval.lower), F(0)));
  panel.rate_by_rise = convert<float>(length * interval.slope);
  return panel;
}

/// Number of nodes of a Gauss panel on a piece.
inline constexpr int piece_nodes = 6;

/// Returns the error, on a Gauss panel, of a color with a kink over cubic data: its mean weighted
/// by extinction · transparency minus the sum over the nodes, for a change of slope of 1 over a
/// range of 1, in units of color_kink_error(). An estimate, not a bound: twice the largest error
/// that search found, up to largest_panel_depth; asserted in packet/test_extinction_piece.
template <class F>
F panel_kink_factor(F depth) noexcept {
  return F(0.3f) + F(0.03f) * depth;
}

/// Returns the largest color error of panel_piece(), relative to the opacity.
template <class F>
in_float_t<F> panel_piece_error(const PieceDepth<F>& piece,
                                const ColorSpread<in_float_t<F>>& spread, bool proved) noexcept {
  using Single = in_float_t<F>;
  const Single depth = convert<float>(piece.depth);
  const Single of_range =
      proved ? panel_error_bound<piece_nodes>(depth) : panel_error_estimate<piece_nodes>(depth);
  const Single of_kinks = proved ? Single(1) : panel_kink_factor(depth);
  return min(min(spread.range, spread.slope * range_of(piece)) * of_range + spread.kinks * of_kinks,
             spread.range);
}

/// Returns the segment of colored_piece() with a more accurate color, for pieces no deeper than
/// largest_panel_depth: weighted by extinction · transparency at the nodes of a Gauss panel
/// (specification, 3.8). If `proved`, it is the color at the mean of the data with these weights,
/// with panel_error_bound(); else the mean of the nodes' colors, with estimates. color_error is
/// panel_piece_error().
template <class F>
BoundedSegment<in_float_t<F>> panel_piece(const PieceDepth<F>& piece, const PiecePanel<F>& panel,
                                          const ColorSpread<in_float_t<F>>& spread, bool proved,
                                          const SegmentResult<in_float_t<F>>& found,
                                          const BinnedTransfer& transfer, const mask_t<F>& wanted,
                                          ColorInterval<F>& known) noexcept {
  using Single = in_float_t<F>;
  const Single lower = convert<float>(piece.lower - panel.first),
               upper = convert<float>(piece.upper - panel.first);
  const Single middle = Single(0.5f) * lower + Single(0.5f) * upper;
  const auto mean_of = [](const auto& sum, Single weight) noexcept {
    const auto shines = weight > Single(0);
    return select(shines, Single(1) / select(shines, weight, Single(1)), Single(0)) * sum;
  };
  const auto color_at_rise = [&](Single rise) noexcept {
    const F value = panel.first + convert<scalar_t<F>>(rise);
    return color_at(transfer, clamp(value, piece.color_lower, piece.color_upper), wanted, known);
  };
  Rgb<Single> color{};
  if (proved || !transfer.has_color_breakpoints) {
    const PanelSums<Single> sums =
        cubic_panel_sums<piece_nodes>(panel.rise, panel.rate_first, panel.rate_by_rise, middle);
    const Single off = mean_of(sums.share, proved ? found.opacity : sums.weight);
    color = color_at_rise(clamp(middle + off, lower, upper));
  } else {
    Single weights(0);
    for_each_panel_node<piece_nodes>(panel.rise, panel.rate_first, panel.rate_by_rise,
                                     [&](Single rise, Single weight) noexcept {
                                       weights += weight;
                                       color += weight * color_at_rise(rise);
                                     });
    color = mean_of(color, weights);
  }
  BoundedSegment<Single> result;
  result.segment = found;
  result.segment.radiance = found.opacity * color;
  result.color_error = found.opacity * panel_piece_error(piece, spread, proved);
  result.proved = mask_t<F>(proved);
  result.panels = mask_t<F>(true);
  return result;
}

}  // namespace pellucid
