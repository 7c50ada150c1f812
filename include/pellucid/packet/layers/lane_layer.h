// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/span_light.h"
#include "pellucid/packet/layered_interface.h"
#include "pellucid/packet/layers/cell_loads.h"
#include "pellucid/packet/layers/cell_walk.h"
#include "pellucid/packet/layers/lane_mixture.h"
#include "pellucid/packet/layers/lane_transfers.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// A step of the rows of lanes: the share [from, to] of each row.
template <int N>
struct LaneStep {
  Batch<std::int32_t, N> at;  ///< number of the row among those of all lanes
  BatchMask<N> partial;       ///< lanes whose step may be less than the row
  Batch<float, N> from, to;
  Vec3<Batch<float, N>> entry;  ///< where it begins in the world, from PacketLight's origin
  Batch<float, N> length;       ///< world length
};

/// A layer on the steps of lanes: its data there, its function and its light.
template <int N>
struct LaneLayer {
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Row = PellucidLayerRow;

  M present{false};
  LaneTransfers<N> transfers;
  SpanLanes<float, N> span;
  SpanPiece<float, N> piece;
  const LaneMixture* mixture;  ///< null: one variable
  MixtureLanes<N> gaussians;
  bool has_light;
  SpanLight<N> light;
  LightOfPiece<N> lit;
  bool has_cells;
  union {
    CellLoads<N> cells;
  };
  M runs{false};  ///< lanes whose parts are runs of cells
  CellWalk<N> walk;
  typename CellLoads<N>::Ways way;  ///< through cells

  LaneLayer(const PellucidLayeredJob& job, int number, const Vec3<F>& to_eye) noexcept
      : transfers(job.functions),
        mixture(seen(job.mixture[number])),
        has_light(seen(job.light[number]) != nullptr),
        light(has_light ? *seen(job.light[number]) : no_light(), to_eye),
        has_cells(job.grid[number] != nullptr) {
    transfers.largest_color = static_cast<float>(job.largest_color);
    if (has_cells) {
      new (&cells) CellLoads<N>(job.grid[number], job.lit_grid[number],
                                has_light ? *seen(job.light[number]) : no_light());
      walk.take(job.walk[number], PacketGrid(job.grid[number][0]).cells);
    }
  }

  /// Begins steps of these lanes, in which the layer is present unless its cells do not absorb.
  /// `parts`, `curves`: of its rows. Adds lanes that are not for packets to `waits`.
  void begin(M here, const LaneStep<N>& step, const float* parts, const float* curves,
             M& waits) noexcept {
    const M in_run = here & runs;
    F part[Row::part_fields];
    if (has_light && !has_cells) {
      load_records<Row::part_fields>(parts, step.at, part);
    } else if (all(in_run | !here)) {
      load_fields<Row::run_fields>(parts, step.at, part);
    } else {
      load_fields<Row::cell_fields>(parts, step.at, part);
    }
    const M in_cell = has_cells ? here & (part[Row::part_kind] == F(Row::cell)) : M(false);
    const M in_cells = in_cell | in_run, cut = here & step.partial & !in_run;
    M shown = here;
    if (any(in_cells)) {
      if (any(in_cell)) take_cell(in_cell, cut, step, part);
      shown = (mixture != nullptr ? load_mixture(in_cells) : load_cells(in_cells, part, waits)) |
              (here & !in_cells);
      present = present & !(here & !shown);
      if (none(shown)) return;
    }
    const M cut_curves = shown & !in_cells & cut;
    if (mixture != nullptr) {
      begin_mixture(shown, shown & !in_cells, step.at, parts, curves);
      for (int c = 0; c < mixture->channels && any(cut_curves); ++c) {
        restrict(cut_curves, step, gaussians.data[c]);
      }
    } else {
      if (any(cut_curves)) {
        CubicBernstein<F> data{part[Row::data], part[Row::data + 1], part[Row::data + 2],
                               part[Row::data + 3]};
        restrict(cut_curves & (part[Row::part_kind] == F(Row::curve)), step, data);
        for (int b = 0; b < 4; ++b) part[Row::data + b] = data.b[b];
      }
      begin_span(shown, part, step.length);
    }
    if (!has_light) return;
    CubicBernstein<F> gradient[3], magnitude;
    if (any(here & !in_cells)) {
      if (has_cells) load_records<Row::part_fields>(parts, step.at, part);
      for (int b = 0; b < 4; ++b) {
        for (int c = 0; c < 3; ++c) gradient[c].b[b] = part[Row::gradient + 4 * c + b];
        magnitude.b[b] = part[Row::magnitude + b];
      }
      if (any(cut_curves)) {
        for (CubicBernstein<F>& g : gradient) restrict(cut_curves, step, g);
        restrict(cut_curves, step, magnitude);
      }
    }
    const M lit_cells = shown & in_cells;
    if (any(lit_cells)) cells.gradients(lit_cells, way, gradient, magnitude);
    waits = waits | light.begin(shown, gradient, magnitude, step.entry, step.length);
  }

  /// Returns extinction and color at u of the pieces.
  Material<F> material(M here, F u) noexcept {
    if (mixture != nullptr) {
      Material<F> found = gaussians.material(*mixture, here, u);
      if (has_light) found.color = light.lit_at(lit, u).apply(found.color);
      return found;
    }
    if (has_light) {
      return light.material(lit, piece, span, u, here, transfers, span.color);
    }
    const ExtinctionInterval<F>& interval = span.extinction;
    const F value = evaluate(piece.parts.front, u);
    const F extinction = interval.at_lower + interval.slope * (value - interval.lower);
    return {max(extinction, F(0)),
            color_at(transfers, clamp(value, piece.seen.color_lower, piece.seen.color_upper), here,
                     span.color)};
  }

 private:
  static const PacketLight& no_light() noexcept {
    static constexpr PacketLight none{};
    return none;
  }

  /// Sets the cell, its entry and its exit in lanes whose part is one cell. A step that is a share
  /// of the cell gets that share of the way through it.
  void take_cell(M in_cell, M cut, const LaneStep<N>& step, const F* part) noexcept {
    for (int a = 0; a < 3; ++a) {
      const F begin = part[Row::entry_in_cell + a], end = part[Row::exit_in_cell + a];
      const F length = end - begin;
      way.cell[a] = select(in_cell, convert<std::int32_t>(part[Row::place + a]), way.cell[a]);
      way.entry[a] = select(in_cell, select(cut, begin + step.from * length, begin), way.entry[a]);
      way.exit[a] = select(in_cell, select(cut, begin + step.to * length, end), way.exit[a]);
    }
  }

  /// Restricts a cubic of these lanes' rows to their step.
  static void restrict(M lanes, const LaneStep<N>& step, CubicBernstein<F>& f) noexcept {
    const CubicBernstein<F> there = restrict_to(f, step.from, step.to);
    for (int b = 0; b < 4; ++b) f.b[b] = select(lanes, there.b[b], f.b[b]);
  }

  /// Loads data of cells into their parts. Returns the lanes in which they may absorb; adds those
  /// that are not for lanes to `waits`.
  [[gnu::noinline]] M load_cells(M lanes, F* part, M& waits) noexcept {
    const CellCubic<F> cubic = cells.data(lanes, way);
    const CubicBernstein<F>& data = cubic.data;
    const F rounding = cubic.rounding;
    const M filled = lanes & !is_nan(data.b[0] + data.b[3]);
    for (int b = 0; b < 4; ++b) {
      part[Row::data + b] = select(lanes, select(filled, data.b[b], F(0)), part[Row::data + b]);
    }
    part[Row::rounding] = select(lanes, rounding, part[Row::rounding]);
    const F least = data.hull_min() - rounding, most = data.hull_max() + rounding;
    M found(false);
    transfers.begin(lanes, convert<std::int32_t>(part[Row::function]), M(false));
    transfers.for_each(filled, [&](const BinnedTransfer& transfer, M same) noexcept {
      M jumps;
      const M absorbs = may_absorb(transfer, same, least, most, jumps);
      found = found | absorbs;
      waits = waits | jumps | (absorbs & !(F(2) * rounding < F(transfer.narrowest)));
    });
    return found;
  }

  /// Loads the data of cells in a layer of several variables. Returns the lanes that have any.
  [[gnu::noinline]] M load_mixture(M lanes) noexcept {
    MixtureLanes<N>& to = gaussians;
    M filled = lanes;
    for (int c = 0; c < mixture->channels; ++c) {
      const CellCubic<F> cubic = cells.data(lanes, way, c);
      filled = filled & !is_nan(cubic.data.b[0] + cubic.data.b[3]);
      for (int b = 0; b < 4; ++b) {
        to.data[c].b[b] = select(lanes, cubic.data.b[b], to.data[c].b[b]);
      }
      to.rounding[c] = select(lanes, cubic.rounding, to.rounding[c]);
    }
    return filled;
  }

  /// Begins a layer of several variables; `curves`: the lanes whose parts are no cells, `data`: of
  /// those.
  [[gnu::noinline]] void begin_mixture(M lanes, M curves, I at, const float* parts,
                                       const float* data) noexcept {
    MixtureLanes<N>& to = gaussians;
    // Bits in the place of floats, in records of four.
    const auto* const words = reinterpret_cast<const std::int32_t*>(parts);
    const I field = select(curves, I(Row::primitives_of_curve), I(Row::primitives_of_cell));
    const I word = at * I(Row::part_fields) + field;
    to.set.low = select(lanes, gather(words, word), to.set.low);
    to.set.high = select(lanes, gather(words, word + I(1)), to.set.high);
    if (none(curves)) return;
    const int variables = mixture->channels;
    const I first = at * I(Row::curve_fields(variables) / 4);
    for (int c = 0; c < variables; ++c) {
      F b[4], off[4];
      load_records<4>(data, first + I(c), b);
      load_records<4>(data, first + I(variables + c / 4), off);
      for (int k = 0; k < 4; ++k) to.data[c].b[k] = select(curves, b[k], to.data[c].b[k]);
      to.rounding[c] = select(curves, off[c % 4], to.rounding[c]);
    }
  }

  /// Loads the first fields of parts.
  template <int Fields>
  static void load_fields(const float* parts, I at, F* part) noexcept {
    static_assert(Fields % 4 == 0 && Row::part_fields % 4 == 0);
    // Records of four floats.
    const I first = at * I(Row::part_fields / 4);
    for (int f = 0; f < Fields; f += 4) load_records<4>(parts, first + I(f / 4), part + f);
  }

  /// Begins spans of this length.
  void begin_span(M lanes, const F* part, F length) noexcept {
    const M constant = lanes & (part[Row::part_kind] == F(Row::constant));
    for (int b = 0; b < 4; ++b) {
      span.data.b[b] = select(lanes, select(constant, F(0), part[Row::data + b]), span.data.b[b]);
    }
    span.rounding = select(lanes, part[Row::rounding], span.rounding);
    span.length = select(lanes, length, span.length);
    span.from = select(lanes, F(0), span.from);
    span.begin(lanes);
    transfers.begin(lanes, convert<std::int32_t>(part[Row::function]), constant);
    // What was known is of another function.
    const F far(BinnedTransfer::far), nothing(0);
    const M changing = lanes & !constant;
    span.extinction.lower = select(changing, far, span.extinction.lower);
    span.extinction.upper = select(changing, -far, span.extinction.upper);
    span.color.lower = select(changing, far, span.color.lower);
    span.color.upper = select(changing, -far, span.color.upper);
    if (none(constant)) return;
    const F extinction = part[Row::data];
    const ExtinctionInterval<F> of_material{-far,       far,     extinction, nothing,
                                            extinction, nothing, nothing,    nothing};
    span.extinction = select(constant, of_material, span.extinction);
    const Rgb<F> color{part[Row::data + 1], part[Row::data + 2], part[Row::data + 3]};
    span.color = select(constant, ColorInterval<F>{-far, far, color, {nothing, nothing, nothing}},
                        span.color);
  }
};

}  // namespace pellucid
#endif
