// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/random_errors.h"
#include "pellucid/packet/cells/span_light.h"
#include "pellucid/packet/lane_compositor.h"
#include "pellucid/packet/layered_interface.h"
#include "pellucid/packet/layers/lane_layer.h"
#include "pellucid/packet/layers/piece_sum.h"
#include "pellucid/packet/opacity_trace.h"
#include "pellucid/segment/lit_panel.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Integrates N rays through several layers at once, each in a lane of its own and within its own
/// tolerance; what a ray becomes depends on no other lane. What lies ahead of the rays comes in
/// rows (layered_interface.h), and these in steps: where a layer's part is a run of cells, a step
/// ends where a cell does; else it is the row. Of a step each lane takes piece by piece: up to
/// where the extinction of a layer has a breakpoint, or light has a kink, and halved where the
/// budget cannot pay for its color. The depth of a piece is the sum of the layers', its color
///
///   Σ τ_l C_l / Σ τ_l,
///
/// of means weighted by extinction where no layer has light and that suffices, else by Gauss nodes
/// (span_light.h). Where a layer has Gaussians of several variables, depth and color are those of
/// seven Gauss nodes, and what four of them make of it says how far they are off, as
/// integrate_lit_panel() has it. In binary32; what that is not good enough for waits for the
/// caller.
template <int N>
class LayeredPacket {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Row = PellucidLayerRow;
  using Layer = LaneLayer<N>;

  explicit LayeredPacket(const PellucidLayeredJob& job) noexcept
      : layers_(job.layers),
        to_eye_{loaded(job.to_eye[0]), loaded(job.to_eye[1]), loaded(job.to_eye[2])},
        largest_color_(static_cast<float>(job.largest_color)),
        compositor_(loaded(job.tolerance), job.largest_extinction, job.largest_color,
                    loaded(job.length)),
        trace_(job.depth != 0) {
    for (int k = 0; k < layers_; ++k) {
      new (&layer_[k]) Layer(job, k, to_eye_);
    }
    alive_ = M::from_bits((1u << job.count) - 1u);
  }

  /// Goes on until most of the lanes whose rays are not through wait for rows, or for the caller.
  void run(PellucidLayeredJob& job) noexcept {
    job_ = &job;
    next_ = loaded(job.next);
    end_ = loaded(job.end);
    const M given_up = loaded(job.gives_up) > I(0);
    alive_ = alive_ & !given_up;
    pending_ = pending_ & !given_up;
    waits_ = waits_ & !given_up;
    in_row_ = in_row_ & !given_up;
    take_handed();
    for (;;) {
      take_rows();
      if (none(pending_)) break;
      if (2 * count(alive_ & !pending_) > count(alive_)) break;
      integrate(pending_);
    }
    next_.store(job.next);
    const M done = !alive_;
    for (int l = 0; l < N; ++l) {
      job.done[l] = done[l] ? 1 : 0;
      job.waits[l] = waits_[l] ? 1 : 0;
    }
    if (any(waits_)) ask_caller();
  }

  void store(const PellucidLayeredJob& job) const noexcept {
    const SegmentResult<D> all = compositor_.result();
    const D error = compositor_.error(convert<double>(pieces_ + by_caller_ + I(1)));
    for (int l = 0; l < job.count; ++l) {
      PellucidRayResult& r = job.results[l];
      r = light_of_lane(all, l);
      r.error = error[l];
      r.evaluations = r.cells = rows_[l];
      r.closed = pieces_[l] - panels_[l];
      r.panels = panels_[l];
      r.in_double = by_caller_[l];
      r.proved = bits(proved_) >> l & 1;
      trace_.find_half(l, 0, static_cast<double>(job.length[l]), r);
    }
  }

 private:
  /// Limits behind which a row is left to the caller: the least share of a piece, and the number of
  /// pieces.
  static constexpr float narrowest = 1.0f / 512;
  static constexpr int max_pieces = 40;

  template <class T>
  static Batch<T, N> loaded(const T (&of_lane)[Row::max_lanes]) noexcept {
    return Batch<T, N>::load(of_lane);
  }

  /// Gives the lanes that work on nothing the next step of their row, or the next row of their ray,
  /// if there is any.
  [[gnu::flatten]] void take_rows() noexcept {
    for (;;) {
      const M idle = alive_ & !pending_ & !waits_;
      const M going_on = idle & in_row_, lanes = idle & !in_row_ & (next_ < end_);
      if (none(going_on | lanes)) return;
      if (any(lanes)) take_rows(lanes);
      const M medium = (going_on | lanes) & in_row_;
      if (any(medium)) begin_step(medium);
    }
  }

  void take_rows(M lanes) noexcept {
    std::int32_t lane[N];
    for (int l = 0; l < N; ++l) lane[l] = l * Row::of_a_ray;
    const I at = select(lanes, I::load(lane) + (next_ & I(Row::of_a_ray - 1)), I(0));
    F head[Row::head_fields];
    load_records<Row::head_fields>(job_->head, at, head);
    next_ += select(lanes, I(1), I(0));
    const I kind = convert<std::int32_t>(head[Row::kind]);
    const auto is = [&](int one) noexcept { return lanes & (kind == I(one)); };
    length_ = select(lanes, head[Row::length], length_);
    left_ = select(lanes, head[Row::left], left_);
    place_error_ = select(lanes, head[Row::position_error], place_error_);
    left_out_ = select(lanes, head[Row::left_out], left_out_);
    from_ = select(lanes, F(0), from_);
    step_begin_ = select(lanes, D(0), step_begin_);
    step_end_ = select(lanes, D(1), step_end_);
    compositor_.budget.set_remaining_length(
        select(lanes, left_, compositor_.budget.remaining_length()));
    const M medium = is(Row::medium);
    if (any(medium)) begin_row(medium, at, head);
    if (all(medium | !lanes)) return;
    waits_ = waits_ | is(Row::by_host);
    const M ends = is(Row::end), others = lanes & !medium & !waits_ & !ends;
    rows_ += select(lanes & !medium, I(1), I(0));
    alive_ = alive_ & !ends;
    meet(others, kind, head);
  }

  /// Begins rows with a medium.
  void begin_row(M lanes, I at, const F (&head)[Row::head_fields]) noexcept {
    in_row_ = in_row_ | lanes;
    row_.at = select(lanes, at, row_.at);
    row_.present = select(lanes, convert<std::int32_t>(head[Row::present]), row_.present);
    for (int a = 0; a < 3; ++a) {
      row_.entry[a] = select(lanes, head[Row::entry + a], row_.entry[a]);
    }
    row_.left = select(lanes, head[Row::left], row_.left);
    row_.has_runs = row_.has_runs & !lanes;
    for (int k = 0; k < layers_; ++k) {
      Layer& layer = layer_[k];
      if (!layer.has_cells || layer.mixture != nullptr) continue;
      const M here = lanes & ((row_.present & I(1 << k)) != I(0));
      const M runs = any(here) ? here & (gather(parts_of(k), at * I(Row::part_fields) +
                                                                 I(Row::part_kind)) == F(Row::run))
                               : here;
      layer.runs = (layer.runs & !lanes) | runs;
      if (none(runs)) continue;
      const M first = runs & !row_.has_runs;
      if (any(first)) {
        row_.begin = select(first, gather(job_->range, at * I(2)), row_.begin);
        row_.end = select(first, gather(job_->range, at * I(2) + I(1)), row_.end);
        row_.reached = select(first, row_.begin, row_.reached);
        row_.has_runs = row_.has_runs | first;
      }
      layer.walk.begin(runs, row_.begin);
    }
  }

  /// Goes on by a step of the lanes' rows: as far as all layers stay in their cells.
  void begin_step(M lanes) noexcept {
    const M stepping = lanes & row_.has_runs;
    M empty(false);
    Vec3<F> entry = row_.entry;
    if (any(stepping)) {
      const D begin = row_.reached;
      D end = row_.end;
      for (int k = 0; k < layers_; ++k) {
        const M runs = stepping & layer_[k].runs;
        if (any(runs)) end = select(runs, min(end, layer_[k].walk.exit()), end);
      }
      end = max(end, begin);
      for (int k = 0; k < layers_; ++k) {
        const M runs = stepping & layer_[k].runs;
        if (any(runs)) layer_[k].walk.pass(runs, begin, end, layer_[k].way);
      }
      // What is no longer than a plane is known to: the next cell begins there.
      empty = stepping & !(end - begin > D(8 * rounding_unit<double>) * end);
      row_.reached = select(stepping & !empty, end, row_.reached);
      const F offset = convert<float>(begin - row_.begin), length = convert<float>(end - begin);
      length_ = select(stepping, length, length_);
      left_ = select(stepping, row_.left - offset, left_);
      compositor_.budget.set_remaining_length(
          select(stepping, left_, compositor_.budget.remaining_length()));
      from_ = select(stepping, F(0), from_);
      const D whole = row_.end - row_.begin;
      step_begin_ = select(stepping, (begin - row_.begin) / whole, step_begin_);
      step_end_ = select(stepping, (end - row_.begin) / whole, step_end_);
      for (int a = 0; a < 3; ++a) {
        entry[a] = select(stepping, multiply_add(offset, -to_eye_[a], entry[a]), entry[a]);
      }
      const M ends = stepping & !(end < row_.end);
      row_.has_runs = row_.has_runs & !ends;
      in_row_ = in_row_ & !(lanes & (ends | !stepping));
    } else {
      in_row_ = in_row_ & !lanes;
    }
    lanes = lanes & !empty;
    rows_ += select(lanes, I(1), I(0));
    if (any(lanes)) begin(lanes, stepping, entry);
  }

  /// Begins steps; `partial`: those that may be less than their rows.
  void begin(M lanes, M partial, const Vec3<F>& entry) noexcept {
    pending_ = pending_ | lanes;
    cap_ = select(lanes, F(1), cap_);
    tried_ = select(lanes, I(0), tried_);
    const LaneStep<N> step{select(lanes, row_.at, I(0)), partial, convert<float>(step_begin_),
                           convert<float>(step_end_),    entry,   length_};
    M waits(false), absent = lanes;
    for (int k = 0; k < layers_; ++k) {
      Layer& layer = layer_[k];
      const M here = lanes & ((row_.present & I(1 << k)) != I(0));
      layer.present = (layer.present & !lanes) | here;
      if (any(here)) layer.begin(here, step, parts_of(k), job_->curves[k], waits);
      absent = absent & !layer.present;
    }
    absent = absent & !waits;
    if (any(absent)) leave_out(absent);
    if (any(waits)) wait_for_caller(waits & lanes);
  }

  /// Returns the parts of a layer's rows.
  const float* parts_of(int layer) const noexcept {
    return job_->part + layer * Row::max_lanes * Row::of_a_ray * Row::part_fields;
  }

  /// Nothing of the lanes' rows absorbs after all.
  void leave_out(M lanes) noexcept {
    pending_ = pending_ & !lanes;
    const F error = largest_color_ * min(left_out_ * length_, F(1));
    compositor_.budget.spend(select(lanes, length_, F(0)), F(0), compositor_.transparency(),
                             select(lanes, error * F(1 + 8 * rounding_unit<float>), F(0)));
  }

  /// Meets what has no length, or is not seen.
  [[gnu::noinline]] void meet(M lanes, I kind, const F (&head)[Row::head_fields]) noexcept {
    if (none(lanes)) return;
    const auto is = [&](int one) noexcept { return lanes & (kind == I(one)); };
    const F opacity = head[Row::opacity], transparency = compositor_.transparency();
    const M absent = is(Row::absent), surface = is(Row::surface), marks = is(Row::mark),
            doubts = is(Row::doubt);
    const I mark = convert<std::int32_t>(head[Row::mark_number]);
    F seen = transparency;
    for (unsigned left = bits(marks | doubts); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      float& at_mark = at_mark_[mark[l]][l];
      if (marks[l]) {
        at_mark = transparency[l];
      } else {
        seen = select(M::from_bits(1u << l), F(at_mark), seen);
      }
    }
    F error = min(opacity, F(1));
    error = select(absent, min(left_out_ * length_, F(1)), error);
    error = select(surface, min(head[Row::error] + F(8 * rounding_unit<float>), F(1)), error);
    error = select(marks, F(0), error);
    const F through = select(surface, opacity, F(0));
    compositor_.budget.spend(
        select(absent, length_, F(0)), through, seen,
        select(lanes, largest_color_ * error * F(1 + 8 * rounding_unit<float>), F(0)));
    if (any(surface)) {
      // Of an opaque one everything is seen.
      const F depth = -log(max(F(1) - opacity, F(smallest_normal<float>)));
      compositor_.add(surface,
                      SegmentResult<F>{depth,
                                       opacity,
                                       F(1) - opacity,
                                       {opacity * head[Row::color], opacity * head[Row::color + 1],
                                        opacity * head[Row::color + 2]}});
      pieces_ += select(surface, I(1), I(0));
    }
    retire(lanes);
  }

  /// The next pieces of the lanes' rows.
  [[gnu::flatten]] void integrate(M on) noexcept {
    const F ahead = F(1) - from_;
    F place = min(cap_, F(1));
    M found = on, mixed(false);
    for (int k = 0; k < layers_; ++k) {
      Layer& layer = layer_[k];
      const M here = on & layer.present;
      if (none(here)) continue;
      if (layer.mixture != nullptr) {
        mixed = mixed | here;
      } else {
        layer.span.cap = F(1);
        begin_piece(layer.span, layer.transfers, here, layer.piece);
        found = found & (layer.piece.end.found | !here);
        place = select(here, min(place, layer.piece.place), place);
      }
      if (!layer.has_light) continue;
      const F kink = layer.light.kink();
      const M before = here & (kink > from_) & (kink < F(1));
      place = select(before, min(place, (kink - from_) / select(before, ahead, F(1))), place);
    }
    const F to = min(from_ + ahead * place, F(1));
    tried_ += select(on, I(1), I(0));
    PieceSum<N> sum;
    for (int k = 0; k < layers_; ++k) {
      Layer& layer = layer_[k];
      const M here = on & layer.present;
      if (any(here)) measure(layer, here, place, to, sum);
    }
    const F length = ahead * place * length_;
    const F left = left_ - from_ * length_;
    compositor_.budget.set_remaining_length(
        select(on, left, compositor_.budget.remaining_length()));
    if (any(mixed)) integrate_mixed(mixed, found, place, to, length, sum);
    on = on & !mixed;
    found = found & on;
    if (none(on)) return;
    const F depth = sum.depth;
    SegmentResult<F> s = segment_of_depth(depth, Rgb<F>{});
    const F transparency = compositor_.transparency(), seen = transparency * s.opacity;
    // What is off whatever the color.
    const F range = min(sum.range(), F(2) * largest_color_);
    const F rounding = segment_rounding(s, F(32 * rounding_unit<float>), largest_color_,
                                        sum.depth_error, sum.color_rounding, range) +
                       largest_color_ * min(left_out_ * length, F(1));
    const F linear = transparency * rounding + seen * sum.color_error;
    const typename RayBudget<F>::SpanShare shares =
        compositor_.budget.span_share(length, s.opacity);
    const F allowed = shares.sum();
    const M affordable = found & (linear <= F(0.6f) * allowed);

    // The means of layers without light.
    const F of_means = seen * (range * mean_color_bound(depth));
    const M by_means = affordable & (!sum.lit) & (linear + of_means <= allowed);
    const F largest =
        sampled_.largest_variance(compositor_.budget, linear, s.opacity, length, left);
    const NodeDeviations<N> deviations(range, sum.turns, sum.sharpness, depth);
    const typename LikeErrors<F>::Signs signs = sum.signs(range);
    const auto growth = [&](F deviation) noexcept {
      return max(like_.variance_with(signs, deviation) - sampled_.variance(), F(0));
    };
    const F of_three = seen * deviations.by_three(), of_six = seen * deviations.by_six();
    const F variance = growth(of_six), variance_by_three = growth(of_three);
    const M by_three = affordable & (!by_means) & (variance_by_three <= largest);
    const M by_six = affordable & (!by_means) & (!by_three) & (variance <= largest);
    const M take = by_means | by_three | by_six;
    const M rest = on & !take;
    if (any(rest)) halve(rest, affordable & (variance <= F(1e6f) * largest), place);
    if (none(take)) return;
    Rgb<F> color = sum.color();
    if (any(by_three)) color = select(by_three, nodes_color<3>(by_three, length), color);
    if (any(by_six)) color = select(by_six, nodes_color<6>(by_six, length), color);
    s.radiance = s.opacity * color;
    compositor_.add(take, s);
    const M by_nodes = by_three | by_six;
    if (any(by_nodes)) {
      sampled_.charge(by_nodes, compositor_.budget, select(by_six, variance, variance_by_three),
                      linear, s.opacity, length, left, transparency);
      like_.add(by_nodes, signs, select(by_six, of_six, of_three));
    }
    compositor_.budget.spend(select(by_means, length, F(0)), shares,
                             select(by_means, linear + of_means, F(0)));
    pieces_ += select(take, I(1), I(0));
    panels_ += select(by_nodes, I(1), I(0));
    proved_ = proved_ & !by_nodes;
    go_past(take, place, to);
    retire(take);
  }

  /// Halves the lanes' pieces where that may help, and leaves the others to the caller: light may
  /// turn in a small part of a row, and a table be narrow.
  void halve(M lanes, M may_help, F place) noexcept {
    const F half = F(0.5f) * place;
    const M halved =
        lanes & may_help & (tried_ < I(max_pieces)) & ((F(1) - from_) * half >= F(narrowest));
    cap_ = select(halved, half, cap_);
    wait_for_caller(lanes & !halved);
  }

  /// Pieces in which a layer has Gaussians. `found`: where those of the other layers are known.
  [[gnu::noinline]] void integrate_mixed(M on, M found, F place, F to, F length,
                                         const PieceSum<N>& sum) noexcept {
    const detail::PanelNodes<4, F> few = nodes<4>(on, length);
    const detail::PanelNodes<7, F> many = nodes<7>(on, length);
    const Rgb<F> color = detail::panel_color(many);
    const F change = max(largest_component(detail::panel_color(few) - color),
                         largest_component(detail::color_of_every_other(many) - color));
    // As integrate_lit_panel(); where light turns faster, as other pieces in light.
    const M even = sum.exponents <= F(2);
    const M smooth = even & (many.total <= F(4)) & (sum.turns <= F(16)) & (sum.sharpness <= F(4));
    const F range = min(sum.range(), F(2) * largest_color_);
    const F apart = min(max(sum.most - sum.least, F(0)), F(1));
    const F depth_error = select(smooth, min(apart, abs(few.total - many.total)), apart);
    const F one_deviation = F(1.0f / RandomErrors<F>::deviations);
    const NodeDeviations<N> by_nodes(range, sum.turns, sum.sharpness, many.total);
    const F of_light = select(even, by_nodes.by_six(), one_deviation * range);
    const F color_deviation =
        select(smooth, min(of_light, one_deviation * F(2) * change), of_light);
    const auto within = [](F x, F lower, F upper) noexcept { return min(max(x, lower), upper); };
    const SegmentResult<F> s =
        segment_of_depth(many.total, Rgb<F>{within(color.r, sum.lower.r, sum.upper.r),
                                            within(color.g, sum.lower.g, sum.upper.g),
                                            within(color.b, sum.lower.b, sum.upper.b)});
    const F transparency = compositor_.transparency();
    const F fixed = segment_rounding(s, F(32 * rounding_unit<float>), largest_color_,
                                     sum.depth_error, sum.color_rounding, range) +
                    largest_color_ * min(left_out_ * length, F(1)) + s.opacity * sum.color_error;
    const F linear = transparency * fixed, left = left_ - from_ * length_;
    const M affordable =
        found & (linear <= F(0.6f) * compositor_.budget.span_share(length, s.opacity).sum());
    // Of nodes' errors, which add up as random ones do.
    const F deviation =
        transparency * (s.opacity * color_deviation + one_deviation * largest_color_ * depth_error);
    const typename LikeErrors<F>::Signs signs = sum.signs(range);
    const F variance = max(like_.variance_with(signs, deviation) - sampled_.variance(), F(0));
    const F largest =
        sampled_.largest_variance(compositor_.budget, linear, s.opacity, length, left);
    const M take = on & affordable & (variance <= largest);
    const M rest = on & !take;
    if (any(rest)) halve(rest, affordable & (variance <= F(1e6f) * largest), place);
    if (none(take)) return;
    compositor_.add(take, s);
    sampled_.charge(take, compositor_.budget, variance, linear, s.opacity, length, left,
                    transparency);
    like_.add(take, signs, deviation);
    pieces_ += select(take, I(1), I(0));
    panels_ += select(take, I(1), I(0));
    proved_ = proved_ & !take;
    go_past(take, place, to);
    retire(take);
  }

  /// Measures the piece of a layer of several variables, up to `to` of the row.
  void measure_mixture(Layer& layer, M here, F to, PieceSum<N>& sum) noexcept {
    const F length = (to - from_) * length_;
    const auto found = layer.gaussians.measure(*layer.mixture, here, from_, to, length);
    typename PieceSum<N>::Colors colors{found.colors.lower, found.colors.upper,
                                        found.colors.oscillation(), F(0)};
    if (layer.has_light) {
      const M any_colors = found.most > F(0);
      const auto shown = [&](const Rgb<F>& c) noexcept {
        return select(any_colors, c, Rgb<F>{F(0), F(0), F(0)});
      };
      const Rgb<F> upper = shown(colors.upper);
      layer.light.measure(colors.range, F(0), largest_component(upper), from_, to, layer.lit);
      colors = {layer.lit.bounds.lower.apply(shown(colors.lower)),
                layer.lit.bounds.upper.apply(upper), layer.lit.range, layer.lit.color_error};
      sum.light_up(here, layer.lit);
    }
    sum.add_mixture(here, found, colors);
  }

  /// Measures the piece of a layer up to `place` of what is left, `to` of the row.
  [[gnu::noinline]] void measure(Layer& layer, M here, F place, F to, PieceSum<N>& sum) noexcept {
    if (layer.mixture != nullptr) return measure_mixture(layer, here, to, sum);
    SpanPiece<float, N>& piece = layer.piece;
    piece.capped = piece.capped | (place < piece.place);
    piece.crosses = piece.crosses & !(place < piece.place);
    piece.place = place;
    finish_piece<false>(layer.span, layer.transfers, here, place_error_, largest_color_, piece);
    const Rgb<F> mean = color_at(
        layer.transfers, clamp(piece.seen.value, piece.seen.color_lower, piece.seen.color_upper),
        here, layer.span.color);
    const F change = min(piece.spread.range, piece.spread.slope * range_of(piece.seen));
    Rgb<F> lower{max(mean.r - change, F(0)), max(mean.g - change, F(0)),
                 max(mean.b - change, F(0))};
    Rgb<F> upper{mean.r + change, mean.g + change, mean.b + change};
    F own_range = change, color_error = piece.spread.kinks;
    if (layer.has_light) {
      if (layer.light.has_factor()) {
        layer.light.weaken(piece, from_, to, layer.span, largest_color_);
      }
      layer.light.measure(piece, from_, to, layer.transfers, layer.lit);
      const LightOfPiece<N>& lit = layer.lit;
      lower = lit.bounds.lower.apply(lower);
      upper = lit.bounds.upper.apply(upper);
      own_range = lit.range;
      color_error = lit.color_error;
      sum.light_up(here, lit);
    }
    sum.add(here, piece, mean, {lower, upper, own_range, color_error});
  }

  /// The color of pieces by Nodes Gauss nodes.
  template <int Nodes>
  [[gnu::noinline]] Rgb<F> nodes_color(M lanes, F length) noexcept {
    return detail::panel_color(nodes<Nodes>(lanes, length));
  }
  /// Evaluates all layers at Nodes Gauss nodes of pieces.
  template <int Nodes>
  [[gnu::noinline]] detail::PanelNodes<Nodes, F> nodes(M lanes, F length) noexcept {
    return detail::PanelNodes<Nodes, F>(length, [&](F u) noexcept {
      F extinction(0);
      Rgb<F> source{F(0), F(0), F(0)};
      for (int k = 0; k < layers_; ++k) {
        Layer& layer = layer_[k];
        const M here = lanes & layer.present;
        if (none(here)) continue;
        const Material<F> own = layer.material(here, u);
        const F absorbs = select(here, own.extinction, F(0));
        extinction += absorbs;
        source.r += select(here, absorbs * own.color.r, F(0));
        source.g += select(here, absorbs * own.color.g, F(0));
        source.b += select(here, absorbs * own.color.b, F(0));
      }
      const M shines = extinction >= F(smallest_normal<float>);
      const F weight = select(shines, F(1) / select(shines, extinction, F(1)), F(0));
      return Material<F>{select(shines, extinction, F(0)), weight * source};
    });
  }
  /// The lanes' pieces were taken; where one was halved, its other half comes next.
  void go_past(M take, F place, F to) noexcept {
    for (int k = 0; k < layers_; ++k) {
      Layer& layer = layer_[k];
      const M here = take & layer.present;
      if (none(here)) continue;
      if (layer.mixture == nullptr) layer.span.go_past(here, layer.piece, layer.transfers);
      if (layer.has_light) layer.light.go_past(here, to);
    }
    const F left = F(1) - place;
    const M halved = take & (cap_ < F(1)) & (place >= cap_) & (place < left);
    cap_ = select(take, select(halved, place / select(halved, left, F(1)), F(1)), cap_);
    from_ = select(take, to, from_);
    pending_ = pending_ & !(take & (place >= F(1)));
  }

  /// Something was added to the lanes' rays: ends those that no longer matter.
  void retire(M lanes) noexcept {
    trace_.note(lanes, compositor_);
    const M done = compositor_.cut_off(lanes);
    alive_ = alive_ & !done;
    pending_ = pending_ & !done;
    waits_ = waits_ & !done;
    in_row_ = in_row_ & !done;
  }

  void wait_for_caller(M lanes) noexcept {
    waits_ = waits_ | lanes;
    pending_ = pending_ & !lanes;
  }

  /// Writes the shares of rows that wait for the caller, and the errors allowed for them.
  void ask_caller() noexcept {
    const F length = (F(1) - from_) * length_;
    const D from = step_begin_ + convert<double>(from_) * (step_end_ - step_begin_);
    compositor_.budget.set_remaining_length(
        select(waits_, left_ - from_ * length_, compositor_.budget.remaining_length()));
    const F transparency = compositor_.transparency();
    const F flat = compositor_.budget.allowance(length, F(0), transparency),
            all = compositor_.budget.allowance(length, F(1), transparency);
    for (unsigned left = bits(waits_); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      job_->from[l] = from[l];
      job_->to[l] = step_end_[l];
      job_->allowance_flat[l] = static_cast<double>(flat[l]);
      job_->allowance_per_opacity[l] = static_cast<double>(all[l] - flat[l]);
    }
  }

  /// Takes what the caller has found of the rows that waited.
  void take_handed() noexcept {
    if (none(waits_)) return;
    const M lanes = waits_;
    ScalarFallback<N> found;
    unsigned proved = 0;
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      found.set(l, job_->handed[l]);
      if (job_->handed[l].proved != 0) proved |= 1u << l;
    }
    compositor_.budget.set_remaining_length(
        select(lanes, left_ - from_ * length_, compositor_.budget.remaining_length()));
    compositor_.add(found, select(lanes, (F(1) - from_) * length_, F(0)));
    by_caller_ += select(lanes, I(1), I(0));
    proved_ = proved_ & (M::from_bits(proved) | !lanes);
    waits_ = M(false);
    retire(lanes);
  }

  int layers_;
  Vec3<F> to_eye_;
  F largest_color_;
  PellucidLayeredJob* job_ = nullptr;
  union {
    Layer layer_[Row::max_layers];
  };

  /// Rows that lanes take in steps.
  struct Rows {
    I at{0}, present{0};
    Vec3<F> entry{F(0), F(0), F(0)};
    F left{0};
    M has_runs{false};  ///< of cells: such a row goes on behind `reached`
    D begin{0}, end{1}, reached{0};
  };

  M alive_{false};    ///< rays that are not through
  M pending_{false};  ///< lanes that work on a step
  M waits_{false};    ///< lanes that wait for the caller
  M in_row_{false};   ///< lanes whose rows have more steps
  I next_{0}, end_{0};
  Rows row_;

  // Of the lanes' steps.
  D step_begin_{0}, step_end_{1};  ///< of their rows
  F length_{1}, left_{0}, place_error_{0}, left_out_{0};
  F from_{0};   ///< the share that is done
  F cap_{1};    ///< where the next piece ends at the latest, of what is left
  I tried_{0};  ///< pieces
  float at_mark_[Row::most_marks][N] = {};

  SampledErrors<F> sampled_;
  LikeErrors<F> like_;
  LaneCompositor<N> compositor_;
  OpacityTrace<N> trace_;
  M proved_{true};
  I rows_{0}, pieces_{0}, panels_{0}, by_caller_{0};
};

}  // namespace pellucid
#endif
