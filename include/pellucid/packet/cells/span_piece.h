// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/segment/extinction_piece.h"
#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Returns what rounding does to a segment whose opacity and color are rounded by `unit`, beside
/// the errors of its depth and color: extinction that is elsewhere in it shows another one of its
/// colors, which differ by up to `colors`.
template <class F>
F segment_rounding(const SegmentResult<F>& s, F unit, F largest_color, F depth_error,
                   F color_rounding, F colors) noexcept {
  const F opacity_rounding =
      unit * s.opacity +
      min(select(depth_error <= F(1), F(2) * depth_error * s.transparency, F(1)), F(1));
  return s.opacity * (unit * largest_color + color_rounding) + largest_color * opacity_rounding +
         colors * min(depth_error, F(1));
}

/// The next piece of spans in lanes: what lies in front of the first breakpoint of the extinction,
/// or less.
template <class T, int N>
struct SpanPiece {
  using F = Batch<T, N>;
  using Single = Batch<float, N>;

  PieceEnd<F> end;
  F place;               ///< where the piece ends, of what is left
  BatchMask<N> capped;   ///< whether it is shorter than up to the breakpoint
  BatchMask<N> crosses;  ///< whether it ends at one
  CutCubic<F> parts;     ///< the piece's data, and those behind it
  F length;              ///< world length
  PieceDepth<F> seen;
  ColorSpread<Single> spread;
  BoundedSegment<Single> found;
  Single depth_error;     ///< what rounding moves its depth by, at most
  Single color_rounding;  ///< and its color, if that is not elsewhere in the piece
  Single rounding;        ///< what rounding does to it, as of RayBudget::spend()

  /// Computes `rounding` from these errors.
  void add_up_rounding(Single largest_color) noexcept {
    constexpr float colored = (is_single<F> ? 32 : 12) * rounding_unit<float>;  // and positions
    const CubicBernstein<F>& f = parts.front;
    const Single colors =
        min(spread.slope * convert<float>(f.hull_max() - f.hull_min()), spread.range);
    rounding = segment_rounding(found.segment, Single(colored), largest_color, depth_error,
                                color_rounding, colors);
  }
};

/// Finds the intervals of values in these lanes.
template <class F>
void locate(const BinnedTransfer& transfer, const mask_t<F>& lanes, F value, index_t<F>& interval,
            ExtinctionInterval<F>& extinction) noexcept {
  extinction = find_extinction(transfer, value, lanes, interval);
}
/// Loads these intervals in these lanes.
template <class F>
void reload(const BinnedTransfer& transfer, const mask_t<F>& /*lanes*/, index_t<F> interval,
            ExtinctionInterval<F>& extinction) noexcept {
  extinction = load_extinction<F>(transfer, interval);
}

/// Returns color_kink_error() in these lanes.
template <class F>
in_float_t<F> kink_error(const BinnedTransfer& transfer, const mask_t<F>& /*lanes*/, F lower,
                         F upper) noexcept {
  return color_kink_error(transfer, lower, upper);
}

/// Remainders of the spans that lanes work on: of a cell, the part [from, 1]. T: float or double.
template <class T, int N>
struct SpanLanes {
  using F = Batch<T, N>;

  CubicBernstein<F> data;
  F rounding;                        ///< of the data
  F length;                          ///< world length of what is left
  F from;                            ///< the share of the cell that is done
  F cap;                             ///< where the next piece ends at the latest, of what is left
  BatchMask<N> located{false};       ///< whether `interval` is known
  Batch<std::int32_t, N> interval;   ///< of the extinction, that holds the first of the data
  ExtinctionInterval<F> extinction;  ///< that of `interval`
  Batch<std::int32_t, N> pieces;     ///< that were tried
  ColorInterval<F> color;            ///< of a piece before

  /// Lanes that have got a new span.
  void begin(BatchMask<N> lanes) noexcept {
    located = located & !lanes;
    cap = select(lanes, F(1), cap);
    pieces = select(lanes, Batch<std::int32_t, N>(0), pieces);
  }

  /// The lanes' next piece was taken; where it was halved, its other half comes next.
  template <class Transfer>
  void go_past(BatchMask<N> lanes, const SpanPiece<T, N>& piece,
               const Transfer& transfer) noexcept {
    using I = Batch<std::int32_t, N>;
    const F place = piece.place, left = F(1) - place;
    for (int k = 0; k < 4; ++k) data.b[k] = select(lanes, piece.parts.back.b[k], data.b[k]);
    length = select(lanes, length * left, length);
    from = select(lanes, from + (F(1) - from) * place, from);
    cap = select(lanes, select(piece.capped & (place < left), place / left, F(1)), cap);
    for (BatchMask<N> crossed = lanes & piece.crosses; any(crossed);) {
      interval += select(crossed, select(piece.end.rising, I(1), I(-1)), I(0));
      reload(transfer, crossed, interval, extinction);
      // What comes near a jump does not go in float. Past one, at once.
      if constexpr (is_single<F>) return;
      crossed = crossed & (extinction.upper <= extinction.lower);
    }
  }
};

/// For how much of a piece data that rise at least as a line to `rise` are within `reach` of where
/// they begin, at most; all of it where they do not rise so far.
template <class F>
F share_within(F reach, F rise) noexcept {
  const auto leaves = rise > reach;
  return select(leaves, reach / select(leaves, rise, F(1)), F(1));
}

/// Returns a bound on how much jumps at the ends of its interval can move the mean extinction of a
/// piece, whose data are known to `value_error` (that of the breakpoints' places included); lanes
/// without any: 0.
///
/// Data within some δ of a jump may be on either side. Of a monotone piece that begins there, with
/// the differences d of its coefficients, f(t) - f(0) >= d₀ (1 - (1 - t)³) >= d₀ t: that is a share
/// of at most δ/d₀; and likewise where it ends. δ is six times `value_error`: the data's, twice
/// that for what d₁ and d₂ may fall short of being monotone, as where the piece ends because its
/// data turn, and once more what that comes to.
template <int N>
Batch<float, N> extinction_across_jumps(const SpanLanes<double, N>& span,
                                        const BinnedTransfer& transfer, BatchMask<N> lanes,
                                        const CubicBernstein<Batch<double, N>>& f,
                                        Batch<double, N> value_error) noexcept {
  using D = Batch<double, N>;
  using F = Batch<float, N>;
  using M = BatchMask<N>;
  const F size = gather(transfer.jump, select(lanes, span.interval, Batch<std::int32_t, N>(0)));
  const M beside = lanes & (size > F(0));
  if (none(beside)) return F(0);
  const D reach = D(6) * value_error;
  const D sign = select(f.b[3] > f.b[0], D(1), D(-1));
  const D d0 = sign * (f.b[1] - f.b[0]), d1 = sign * (f.b[2] - f.b[1]),
          d2 = sign * (f.b[3] - f.b[2]);
  const D lower = span.extinction.lower + reach, upper = span.extinction.upper - reach;
  const auto share_at = [&](D end, D rise) noexcept {
    return select((end < lower) | (end > upper), share_within(reach, rise), D(0));
  };
  const M turns = min(d0, min(d1, d2)) < -value_error;
  const M near = (f.hull_min() < lower) | (f.hull_max() > upper);
  const D share = select(turns, select(near, D(1), D(0)),
                         min(share_at(f.b[0], d0) + share_at(f.b[3], d2), D(1)));
  return select(beside, size * convert<float>(share), F(0));
}

/// Finds where the next piece of the lanes' spans ends. Transfer: a BinnedTransfer, or several.
template <class T, int N, class Transfer>
void begin_piece(SpanLanes<T, N>& span, const Transfer& transfer, BatchMask<N> lanes,
                 SpanPiece<T, N>& piece) noexcept {
  using F = Batch<T, N>;
  using M = BatchMask<N>;
  const M lost =
      lanes & !span.located &
      ((span.data.b[0] < span.extinction.lower) | (span.data.b[0] >= span.extinction.upper));
  if (any(lost)) locate(transfer, lost, span.data.b[0], span.interval, span.extinction);
  span.located = span.located | lanes;
  span.pieces += select(lanes, Batch<std::int32_t, N>(1), Batch<std::int32_t, N>(0));
  const F close = F(0.25f) * span.rounding;
  piece.end = piece_end(span.data, span.extinction.lower, span.extinction.upper, close, lanes);
  piece.capped = span.cap < piece.end.place;
  piece.place = min(piece.end.place, span.cap);
  piece.crosses = piece.end.crosses & !piece.capped;
}

/// Integrates the piece that begin_piece() has found. `position_error`: how far a span's ends may
/// be from where they are thought to be, world length. Colors are floats, of values in T; without
/// `colored` there is none, and `found` has its depth and opacity alone.
template <bool colored, class T, int N, class Transfer>
void finish_piece(SpanLanes<T, N>& span, const Transfer& transfer, BatchMask<N> lanes,
                  Batch<float, N> position_error, Batch<float, N> largest_color,
                  SpanPiece<T, N>& piece) noexcept {
  using F = Batch<T, N>;
  using Single = Batch<float, N>;
  using M = BatchMask<N>;
  const ExtinctionInterval<F>& interval = span.extinction;
  const F close = F(0.25f) * span.rounding;
  piece.parts = {span.data, span.data};
  const M cuts = lanes & (piece.place < F(1));
  if (any(cuts)) {
    // At 1 a cut does not give the same to the bit.
    CutCubic<F> parts = cut(span.data, piece.place);
    const F limit = select(piece.end.rising, interval.upper, interval.lower);
    parts.front.b[3] = select(piece.crosses, limit, parts.front.b[3]);
    parts.back.b[0] = select(piece.crosses, limit, parts.back.b[0]);
    for (int k = 0; k < 4; ++k) {
      piece.parts.front.b[k] = select(cuts, parts.front.b[k], span.data.b[k]);
      piece.parts.back.b[k] = select(cuts, parts.back.b[k], span.data.b[k]);
    }
  }
  const CubicBernstein<F>& f = piece.parts.front;
  piece.length = span.length * piece.place;
  piece.seen = piece_depth(f, interval, piece.length);
  piece.spread = {convert<float>(interval.color_range), convert<float>(interval.color_slope),
                  kink_error(transfer, lanes, piece.seen.lower, piece.seen.upper)};
  const F value_error = span.rounding + close;
  F shown_error = value_error;
  if constexpr (!is_single<F>) {
    // Beside a jump is another color: that of a piece is not looked up at its interval's very ends,
    // and so up to 3 u further inside. What lies there altogether is charged for being across.
    const auto within = [](F end) noexcept {
      return F(2 * rounding_unit<F>) * abs(end) + F(std::numeric_limits<T>::min());
    };
    shown_error = F(1.125f) * value_error;  // of 40 u of the data at least
    piece.seen.color_lower = max(piece.seen.lower, interval.lower + within(interval.lower));
    piece.seen.color_upper = min(piece.seen.upper, interval.upper - within(interval.upper));
  }
  if constexpr (colored) {
    piece.found = colored_piece(piece.seen, piece.spread, transfer, lanes, span.color);
  } else {
    piece.found.segment = segment_of_depth(convert<float>(piece.seen.depth), Rgb<Single>{});
  }

  // What rounding can do, as in segment/rounding.h.
  constexpr float u = rounding_unit<float>;
  // The slope of the next interval counts for as much of the piece as is near to it: where the
  // data rise throughout, no more than 2 value_error over their least slope.
  const M touches = (f.hull_min() - value_error < interval.lower) |
                    (f.hull_max() + value_error > interval.upper) | piece.crosses;
  const F slope = abs(interval.slope);
  F steep = slope;
  if (any(touches)) {
    const F near = share_within(F(2) * value_error, least_slope(f));
    steep = select(touches, slope + near * (interval.steepest - slope), slope);
  }
  const Single largest = convert<float>(interval.largest);
  piece.depth_error =
      convert<float>(piece.length * (value_error * steep + F(8 * u) * interval.largest)) +
      position_error * convert<float>((F(1) - span.from) * piece.place) * largest;
  piece.color_rounding = min(convert<float>(shown_error) * piece.spread.slope, largest_color);
  piece.add_up_rounding(largest_color);
  if constexpr (!is_single<F>) {
    // What is on the other side of a jump may be in front of all of the piece, in other colors.
    const Single across = extinction_across_jumps(span, transfer, lanes, f, value_error);
    piece.rounding +=
        Single(2) * largest_color * min(convert<float>(piece.length) * across, Single(1));
  }
}

/// Integrates the next piece of the lanes' spans: begin_piece() and finish_piece().
template <class T, int N>
SpanPiece<T, N> next_piece(SpanLanes<T, N>& span, const BinnedTransfer& transfer,
                           BatchMask<N> lanes, Batch<float, N> position_error,
                           Batch<float, N> largest_color) noexcept {
  SpanPiece<T, N> piece;
  begin_piece(span, transfer, lanes, piece);
  finish_piece<true>(span, transfer, lanes, position_error, largest_color, piece);
  return piece;
}

/// Gives the lanes' pieces, no deeper than largest_panel_depth, a better color where there is one.
template <class T, int N>
void color_in_panel(SpanLanes<T, N>& span, bool proved, const BinnedTransfer& transfer,
                    BatchMask<N> lanes, SpanPiece<T, N>& piece) noexcept {
  using Single = Batch<float, N>;
  const PiecePanel<Batch<T, N>> panel =
      piece_panel(piece.parts.front, span.extinction, piece.length);
  BoundedSegment<Single>& found = piece.found;
  const BoundedSegment<Single> in_panel = panel_piece(piece.seen, panel, piece.spread, proved,
                                                      found.segment, transfer, lanes, span.color);
  const BatchMask<N> better = lanes & (in_panel.color_error < found.color_error);
  Rgb<Single>& radiance = found.segment.radiance;
  const Rgb<Single>& improved = in_panel.segment.radiance;
  radiance = {select(better, improved.r, radiance.r), select(better, improved.g, radiance.g),
              select(better, improved.b, radiance.b)};
  found.color_error = select(better, in_panel.color_error, found.color_error);
  found.proved = found.proved & (in_panel.proved | !better);
  found.panels = found.panels | better;
}

}  // namespace pellucid
#endif
