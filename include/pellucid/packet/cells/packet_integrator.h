// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/random_errors.h"
#include "pellucid/packet/cells/cell_positions.h"
#include "pellucid/packet/cells/cells_in_double.h"
#include "pellucid/packet/cells/light_lanes.h"
#include "pellucid/packet/cells/span_finder.h"
#include "pellucid/packet/cells/span_piece.h"
#include "pellucid/packet/cells/span_queue.h"
#include "pellucid/packet/cells/surface_lanes.h"
#include "pellucid/packet/lane_compositor.h"
#include "pellucid/packet/opacity_trace.h"
#include "pellucid/packet/steps/smooth_march.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Integrates N rays at once, each in a lane of its own and within its own tolerance. What a ray
/// becomes depends on no other lane; on N within its tolerance only, for 4 lanes do not fuse.
///
/// What lies ahead of all of them is found first: their stretches in blocks (BlockMarch), and the
/// spans that absorb in these (SpanFinder), whose lanes are any stretches. Then each lane takes the
/// spans of its ray, piece by piece: each is cut where the extinction has a breakpoint
/// (segment/extinction_piece.h), and halved where the budget cannot pay for its color. What
/// binary32 is not good enough for is begun anew in double, when enough lanes have waited for that;
/// what that is not good enough for is handed back, cell by cell.
///
/// If `is_lit`, each piece is shaded in binary32 (light_lanes.h); there are no smooth steps, and
/// what binary32 is not good enough for is handed back at once. The values of isosurfaces are
/// control points of the extinction, so that pieces end where a ray meets one (surface_lanes.h). If
/// binary32 cannot tell whether it does, the ray is left (PellucidStatus), and so it is where what
/// integrates a cell by other means leaves it.
template <int N, bool is_lit = false>
class PacketIntegrator {
  struct Unlit {};

 public:
  static constexpr int lane_count = N;
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// Workspace that many packets use one after the other.
  struct Workspace : SpanWorkspace<N> {
    StepTable<N> step_lengths;
    std::conditional_t<is_lit, SpanWays<N>, Unlit> ways;
  };

  /// Prepares for rays first … first + count - 1 of the job, count <= N.
  PacketIntegrator(const PellucidPacketJob& job, const PacketGrid& grid, Workspace& workspace,
                   int first, int count) noexcept
      : job_(job),
        grid_(grid),
        transfer_(*seen(job.transfer)),
        workspace_(workspace),
        first_(first),
        count_(count),
        blocks_(grid, job.rays + first, count),
        finder_(grid, blocks_, transfer_, is_lit, ways_of(workspace)),
        light_(make_light(job, grid, blocks_)),
        surfaces_(make_surfaces(job)),
        smooth_(job, grid, blocks_.origin, blocks_.direction, workspace.step_lengths),
        place_error_(span_end_errors<N>(job, first, count)),
        compositor_(
            job.tolerance,
            is_lit ? job.largest_extinction : static_cast<double>(transfer_.largest_extinction),
            job.largest_color, convert<float>(D::load(blocks_.end))),
        trace_(job.depth != 0),
        largest_color_(static_cast<float>(job.largest_color)),
        double_will_do_(job.tolerance >
                        64 * static_cast<double>(rounding_unit<float>) * job.largest_color) {
    if (!(seen(job.smooth)->longest_step > 0)) {
      blocks_.in_cells_until = D(std::numeric_limits<double>::infinity());
    }
  }

  void run() noexcept {
    while (any(blocks_.alive)) {
      find_spans();
      queue_.begin(workspace_.rows);
      if constexpr (is_lit) light_.begin(workspace_, workspace_.ways);
      for (take_spans(); any(pending_); take_spans()) integrate_spans();
      sample_smooth();
    }
  }

  void store(PellucidRayResult* results) const noexcept {
    const SegmentResult<D> all = compositor_.result();
    const D error = compositor_.error(convert<double>(pieces_ + strides_));
    const F neighbor_deviation = smooth_.neighbor_deviation();
    const F longest_step = smooth_.longest_step();
    for (int l = 0; l < count_; ++l) {
      PellucidRayResult& r = results[first_ + l];
      r = {{all.radiance.r[l], all.radiance.g[l], all.radiance.b[l]},
           all.opacity[l],
           all.optical_depth[l],
           error[l],
           {},
           cells_seen_[l],
           cells_seen_[l] + samples_taken_[l],
           skipped_[l],
           constant_[l],
           pieces_[l] - panels_[l],
           panels_[l],
           in_double_[l],
           strides_[l],
           neighbor_deviation[l],
           longest_step[l],
           static_cast<std::uint8_t>(bits(proved_) >> l & 1),
           failed_[l] ? pellucid_left : pellucid_followed};
      const PellucidRay& ray = job_.rays[first_ + l];
      trace_.find_half(l, ray.begin, ray.end, r);
    }
  }

 private:
  using Light = std::conditional_t<is_lit, LightLanes<N>, Unlit>;
  using LitPiece = std::conditional_t<is_lit, SpanPiece<float, N>, Unlit>;
  using PieceLight = std::conditional_t<is_lit, LightOfPiece<N>, Unlit>;
  using Like = std::conditional_t<is_lit, LikeErrors<F>, Unlit>;
  using Surfaces = std::conditional_t<is_lit, SurfaceLanes<N>, Unlit>;

  static Light make_light(const PellucidPacketJob& job, const PacketGrid& grid,
                          const BlockMarch<N>& rays) noexcept {
    if constexpr (is_lit) {
      return Light(grid, *seen(job.light), rays);
    } else {
      return {};
    }
  }

  static SpanWays<N>* ways_of(Workspace& workspace) noexcept {
    if constexpr (is_lit) {
      return &workspace.ways;
    } else {
      return nullptr;
    }
  }

  static Surfaces make_surfaces(const PellucidPacketJob& job) noexcept {
    if constexpr (is_lit) {
      return Surfaces(seen(job.surfaces), *seen(job.light), job.largest_color);
    } else {
      return {};
    }
  }

  /// Least width of a part of a cell, below which it is handed back.
  static constexpr float narrowest = 1.0f / 16;
  static constexpr float narrowest_lit = 1.0f / 512;
  static constexpr int max_lit_pieces = 40;
  /// Fraction of the difference of two rules that counts as the standard deviation of the better
  /// one.
  static constexpr float share_of_difference = 0.4f;
  /// After so many pieces and halvings what is left of a cell is handed back if it is not taken.
  static constexpr int max_pieces = 64;

  void find_spans() noexcept {
    blocks_.find(workspace_.stretches, skipped_);
    with_value_type(grid_.type, [this](auto value) noexcept {
      finder_.template find<decltype(value)>(workspace_.stretches, workspace_.walks,
                                             workspace_.rows, cells_seen_);
    });
  }

  /// Gives the lanes without a span the next one of their ray, if there is any.
  [[gnu::flatten]] void take_spans() noexcept {
    using Rows = SpanRows<N>;
    F(&row)[Rows::fields] = row_;
    const M lanes = queue_.take(!pending_, workspace_.rows, row);
    if (none(lanes)) return;
    const I code = convert<std::int32_t>(row[7]);
    const auto has = [&](int flag) noexcept { return (code & I(flag)) > I(0); };
    pending_ = pending_ | lanes;
    in_double_now_ = in_double_now_ & !lanes;
    for (int k = 0; k < 4; ++k) single_.data.b[k] = select(lanes, row[k], single_.data.b[k]);
    single_.rounding = select(lanes, row[4], single_.rounding);
    single_.length = select(lanes, row[5], single_.length);
    single_.from = select(lanes, F(0), single_.from);
    single_.begin(lanes);
    span_length_ = select(lanes, row[5], span_length_);
    left_ = select(lanes, row[6], left_);
    code_ = select(lanes, code, code_);
    whole_block_ = select(lanes, has(PackedSpanInfo::whole_block), whole_block_);
    scalar_fallback_ = scalar_fallback_ | (lanes & has(PackedSpanInfo::scalar_fallback));
    const M in_double = lanes & has(PackedSpanInfo::in_double);
    if (any(in_double)) wait_for_double(in_double);
    if constexpr (is_lit) {
      scalar_fallback_ = scalar_fallback_ | light_.take(lanes, row[5]);
      if (surfaces_.exist()) {
        close_ = select(lanes, surfaces_.close(single_.data, row[4], place_error_, row[5]), close_);
        fail(surfaces_.come_to(lanes, single_.data.b[0], close_));
      }
    }
    constant_ += select(lanes & whole_block_, I(1), I(0));
  }

  /// Returns the positions at which the lanes' rays cross the cells of these spans.
  CellPositions<N> places_of(M lanes, I of) const noexcept {
    return span_places(grid_, blocks_, workspace_.stretches, lanes, of);
  }

  /// Gives up what was found of the lanes' rays.
  void drop_spans(M lanes) noexcept {
    pending_ = pending_ & !lanes;
    not_begun_ = not_begun_ & !lanes;
    queue_.drop(lanes);
    if constexpr (is_lit) light_.drop(lanes);
  }

  /// Goes through blocks that were taken for one span after all.
  void go_back(M lanes) noexcept {
    drop_spans(lanes);
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      blocks_.go_back(l, workspace_.stretches, PackedSpanInfo::stretch_of(code_[l]));
    }
  }

  /// Goes through the smooth stretches that come behind the spans that were found.
  void sample_smooth() noexcept {
    const M lanes = blocks_.smooth & blocks_.alive;
    if (none(lanes)) return;
    smooth_.enter(lanes, blocks_.smooth_begin, blocks_.smooth_end);
    while (any(smooth_.walking)) step_smooth();
  }

  /// Four steps through smooth blocks, where the budget can pay for their error.
  [[gnu::flatten]] void step_smooth() noexcept {
    const M on = smooth_.walking;
    const D from = smooth_.at;
    const typename SmoothMarch<N>::Steps steps = smooth_.look();
    samples_taken_ += select(on, I(4), I(0));
    const SegmentResult<F>& s = steps.found.segment;
    const F left = convert<float>(D::load(blocks_.end) - from);
    const F transparency = compositor_.transparency();
    const F deviation = F(share_of_difference) * steps.found.difference;
    const F variance = transparency * transparency * (deviation * deviation + steps.least_variance);
    const F rounding = transparency * (F(32 * rounding_unit<float>) * s.opacity * largest_color_ +
                                       F(static_cast<float>(job_.sample_rounding)) * steps.length);
    const F largest =
        sampled_.largest_variance(compositor_.budget, rounding, s.opacity, steps.length, left);
    const M take =
        on & steps.valid & (variance <= largest) & (rounding <= compositor_.budget.remaining());
    const M refused = smooth_.finer(on & !take);
    if (any(refused)) {
      blocks_.go_in_cells(refused, from, smooth_.end);
      smooth_.refuse(refused, transparency);
    }
    if (none(take)) return;
    compositor_.add(take, s);
    sampled_.charge(take, compositor_.budget, variance, rounding, s.opacity, steps.length, left,
                    transparency);
    smooth_.take(take, steps, transparency, variance <= F(0.2f) * largest);
    strides_ += select(take, I(1), I(0));
    proved_ = proved_ & !take;
    retire(take);
  }

  void integrate_spans() noexcept {
    if (any(scalar_fallback_)) {
      fall_back_to_scalar(scalar_fallback_);
      scalar_fallback_ = M(false);
    }
    const M single = pending_ & !in_double_now_, wide = pending_ & in_double_now_;
    if constexpr (is_lit) {
      if (any(single)) integrate_lit_pieces(single);
      return;
    }
    // What becomes of a lane does not depend on when it is its turn. Lanes wait until that has cost
    // half as much as the others then lose, and no longer: who waits alone may be all there is.
    const int waiting = count(wide);
    if (any(single) && (waiting == 0 || 2 * waited_ < N - waiting)) {
      waited_ += waiting;
      integrate_pieces(single_, single);
    } else if (waiting > 0) {
      waited_ = 0;
      begin_in_double();
      integrate_pieces(double_, wide);
    }
  }

  template <class T>
  [[gnu::flatten]] void integrate_pieces(SpanLanes<T, N>& span, M on) noexcept {
    using Place = Batch<T, N>;
    constexpr bool wide = !is_single<T>;
    SpanPiece<T, N> piece = next_piece(span, transfer_, on, place_error_, largest_color_);
    const SegmentResult<F>& s = piece.found.segment;
    const F length = convert<float>(piece.length);
    compositor_.budget.set_remaining_length(
        select(on, left_behind(convert<float>(span.from)), compositor_.budget.remaining_length()));
    const F transparency = compositor_.transparency();
    const typename RayBudget<F>::SpanShare shares =
        compositor_.budget.span_share(length, s.opacity);
    const F allowed = shares.sum(), cost_of_rounding = transparency * piece.rounding;
    const auto fits = [&] {
      return on & piece.end.found &
             (transparency * piece.found.color_error + cost_of_rounding <= allowed);
    };
    M take = fits();
    const M restart = on & !take & whole_block_;
    if (any(restart)) go_back(restart);
    M rest = on & !take & !restart;
    const M room_for_color = rest & piece.end.found & (cost_of_rounding <= F(0.6f) * allowed);
    if (any(room_for_color)) {
      // Panels are worth their price where they will do: where they look up many colors, only for
      // pieces that are dear, in double or halved again and again.
      const bool proved = job_.proved != 0;
      const F in_panel_cost =
          transparency * s.opacity * panel_piece_error(piece.seen, piece.spread, proved);
      const F halved_in_vain = wide || !transfer_.has_color_breakpoints ? F(0) : F(8) * allowed;
      const M in_panel = room_for_color & (s.optical_depth <= F(largest_panel_depth<float>)) &
                         (in_panel_cost + cost_of_rounding <= allowed) &
                         (transparency * piece.found.color_error > halved_in_vain);
      if (any(in_panel)) {
        color_in_panel(span, proved, transfer_, in_panel, piece);
        take = fits();
        rest = rest & !take;
      }
    }
    if (any(rest)) {
      const Place half = Place(0.5f) * piece.place;
      const F part = convert<float>((Place(1) - span.from) * half);  // of the cell
      // Halving makes the color at most four times better, and the half of a half sixteen times,
      // and of rounding nothing: that has to leave some room.
      const M halve = rest & room_for_color & (span.pieces < I(max_pieces)) &
                      (part >= F(narrowest)) &
                      (transparency * piece.found.color_error <= F(64) * allowed);
      span.cap = select(halve, half, span.cap);
      const M give_up = rest & !halve;
      if (any(give_up)) {
        if constexpr (wide) {
          fall_back_to_scalar(give_up);
        } else {
          wait_for_double(give_up);
        }
      }
    }
    if (none(take)) return;
    const F cost = transparency * piece.found.color_error + cost_of_rounding;
    compositor_.add(take, s);
    compositor_.budget.spend(select(take, length, F(0)), shares, select(take, cost, F(0)));
    pieces_ += select(take, I(1), I(0));
    panels_ += select(take & piece.found.panels, I(1), I(0));
    proved_ = proved_ & !(take & !piece.found.proved);

    span.go_past(take, piece, transfer_);
    const CubicBernstein<Place>& back = piece.parts.back;
    const M clear = (convert<float>(back.hull_max() + span.rounding) < F(transfer_.support_min)) |
                    (convert<float>(back.hull_min() - span.rounding) > F(transfer_.support_max));
    pending_ = pending_ & !(take & ((piece.place >= Place(1)) | clear));
    retire(take);
  }

  /// The next pieces in light. The errors of their colors are random ones, of signs and sizes that
  /// differ from cell to cell, but for those of pieces that are alike.
  [[gnu::flatten]] void integrate_lit_pieces(M on) noexcept {
    const F from = single_.from, ahead = F(1) - from;
    const F kink = light_.kink();
    const M before = on & (kink > from) & (kink < F(1));
    const F up_to_kink = (kink - from) / select(before, ahead, F(1));
    const M to_kink = before & (up_to_kink < single_.cap);
    single_.cap = select(to_kink, up_to_kink, single_.cap);
    SpanPiece<float, N>& piece = lit_piece_;
    begin_piece(single_, transfer_, on, piece);
    finish_piece<false>(single_, transfer_, on, place_error_, largest_color_, piece);
    SegmentResult<F>& s = piece.found.segment;
    const F to = min(from + ahead * piece.place, F(1));
    if (light_.has_factor()) light_.weaken(piece, from, to, single_, largest_color_);
    light_.measure(piece, from, to, transfer_, lit_);
    const LightOfPiece<N>& lit = lit_;
    const F length = piece.length, left = left_behind(from);
    compositor_.budget.set_remaining_length(
        select(on, left, compositor_.budget.remaining_length()));
    const F transparency = compositor_.transparency(), seen = transparency * s.opacity;
    const F linear = transparency * piece.rounding + seen * lit.color_error;
    const typename RayBudget<F>::SpanShare shares =
        compositor_.budget.span_share(length, s.opacity);
    const M affordable = linear <= F(0.6f) * shares.sum();
    const F largest =
        sampled_.largest_variance(compositor_.budget, linear, s.opacity, length, left);
    const auto growth = [&](F deviation) noexcept {
      return max(like_.variance_with(lit.signs, deviation) - sampled_.variance(), F(0));
    };
    const NodeDeviations<N> deviations(lit.range, lit.turns, lit.sharpness, piece.seen.depth);
    F deviation = seen * deviations.by_three(), variance = growth(deviation);
    const M payable = on & piece.end.found & affordable;
    const M more = payable & !(variance <= largest);
    if (any(more)) {
      deviation = select(more, seen * deviations.by_six(), deviation);
      variance = growth(deviation);
    }
    const M take = payable & (variance <= largest);
    const M rest = on & !take;
    if (any(rest)) {
      const F half = F(0.5f) * piece.place;
      // Light may turn in a small part of a cell, and a table be narrow.
      const M halve = rest & payable & (single_.pieces < I(max_lit_pieces)) &
                      (ahead * half >= F(narrowest_lit)) & (variance <= F(1e6f) * largest);
      single_.cap = select(halve, half, single_.cap);
      scalar_fallback_ = scalar_fallback_ | (rest & !halve);
    }
    if (none(take)) return;
    // What becomes of a lane must not depend on the others: each has its own rule.
    s.radiance =
        s.opacity * light_.color(lit, piece, single_, take, take & more, transfer_, single_.color);
    compositor_.add(take, s);
    sampled_.charge(take, compositor_.budget, variance, linear, s.opacity, length, left,
                    transparency);
    like_.add(take, lit.signs, deviation);
    pieces_ += select(take, I(1), I(0));
    panels_ += select(take, I(1), I(0));
    proved_ = proved_ & !take;
    if (surfaces_.exist()) meet_surfaces(take, piece, to);
    single_.go_past(take, piece, transfer_);
    // Behind a kink there is no other half.
    single_.cap = select(take & to_kink, F(1), single_.cap);
    light_.go_past(take, to);
    const CubicBernstein<F>& back = piece.parts.back;
    const M clear = (back.hull_max() + single_.rounding < F(transfer_.support_min)) |
                    (back.hull_min() - single_.rounding > F(transfer_.support_max));
    pending_ = pending_ & !(take & ((piece.place >= F(1)) | clear));
    retire(take);
  }

  /// Meets the surfaces at the ends of pieces that were taken, at these shares of their cells.
  [[gnu::noinline]] void meet_surfaces(M take, const SpanPiece<float, N>& piece, F to) noexcept {
    const M rising = piece.end.rising;
    const F end = piece.parts.front.b[3];
    const M crosses =
        take & piece.crosses & (end == select(rising, surfaces_.upper(), surfaces_.lower()));
    // Where they turn, data may come so near to a value that nobody knows whether they reach it.
    const CubicBernstein<F>& data = piece.parts.front;
    const M stays = take & !crosses;
    const M beside = stays & !surfaces_.is_inside(end, end, close_);
    fail(beside & !piece.capped);
    if (any(beside)) {
      // The other half of what ended at a surface ends there, too. Where light has a kink data may
      // turn: with gradients `field` and a head light they always do.
      const MonotonePiece<F> next = monotone_piece(piece.parts.back, F(0), beside);
      fail(beside & piece.capped & !surfaces_.is_beyond(next.reach, close_));
    }
    const M near = stays & !surfaces_.is_inside(data.hull_min(), data.hull_max(), close_);
    if (any(near)) {
      const MonotonePiece<F> first = monotone_piece(data, close_, near);
      fail(near & (first.place < F(1)) & !surfaces_.is_inside(first.reach, first.reach, close_));
    }
    fail(crosses & !surfaces_.is_wide(close_));
    if (none(crosses)) return;
    const F ahead = F(1) - single_.from;
    const F u_error =
        min(ahead * crossing_error(single_.data, piece.place, F(2) * close_) + F(1e-6f), F(1));
    auto [opacity, depth, color, error] =
        surfaces_.meet(rising, light_.around(to), to, u_error, span_length_);
    // What is between its place and where it may be is in front of it, or behind.
    const F largest = F(2) * single_.extinction.largest * F(light_.largest_factor());
    error += largest_color_ * min(largest * u_error * span_length_, F(1));
    const F transparency = compositor_.transparency();
    const F cost = transparency * opacity * error;
    const M affordable = crosses & (cost <= compositor_.budget.remaining());
    fail(crosses & !affordable);
    const typename RayBudget<F>::SpanShare shares = compositor_.budget.span_share(F(0), opacity);
    compositor_.budget.spend(F(0), shares, select(affordable, cost, F(0)));
    compositor_.add(affordable, SegmentResult<F>{depth, opacity, F(1) - opacity, opacity * color});
    surfaces_.cross(affordable, rising);
  }

  /// Leaves the lanes' rays.
  void fail(M lanes) noexcept {
    if (none(lanes)) return;
    failed_ = failed_ | lanes;
    blocks_.alive = blocks_.alive & !lanes;
    drop_spans(lanes);
    scalar_fallback_ = scalar_fallback_ & !lanes;
  }

  /// Returns the remaining lengths of the rays, from this share of the lanes' cells on.
  F left_behind(F from) const noexcept { return left_ - from * span_length_; }

  /// Lanes whose span is to be gone on with in double.
  void wait_for_double(M lanes) noexcept {
    if (is_lit || !double_will_do_) {
      // Not yet: a span that is being taken is not complete.
      scalar_fallback_ = scalar_fallback_ | lanes;
      return;
    }
    in_double_now_ = in_double_now_ | lanes;
    not_begun_ = not_begun_ | lanes;
    in_double_ += select(lanes, I(1), I(0));
  }

  void begin_in_double() noexcept {
    if (none(not_begun_)) return;
    begin_spans_in_double(grid_, not_begun_, places_of(not_begun_, code_),
                          convert<double>(single_.from), double_);
    not_begun_ = M(false);
  }

  /// Something was added to the lanes' rays: ends those that no longer matter.
  void retire(M lanes) noexcept {
    trace_.note(lanes, compositor_);
    const M done = compositor_.cut_off(lanes);
    blocks_.alive = blocks_.alive & !done;
    drop_spans(done);
    smooth_.walking = smooth_.walking & !done;
  }

  /// Has what is left of the lanes' spans integrated by other means.
  void fall_back_to_scalar(M lanes) noexcept {
    if constexpr (is_lit) {
      if (surfaces_.exist()) {
        const CubicBernstein<F>& data = single_.data;
        fail(lanes & !surfaces_.is_inside(data.hull_min(), data.hull_max(), close_));
      }
    }
    lanes = lanes & pending_;
    const F transparency = compositor_.transparency();
    const M wide = in_double_now_ & !not_begun_;
    const D from = select(wide, double_.from, convert<double>(single_.from));
    const F length = select(wide, convert<float>(double_.length), single_.length);
    compositor_.budget.set_remaining_length(
        select(lanes, left_behind(convert<float>(from)), compositor_.budget.remaining_length()));
    const F flat = compositor_.budget.allowance(length, F(0), transparency),
            all = compositor_.budget.allowance(length, F(1), transparency);
    ScalarFallback<N> scalar_fallback;
    unsigned not_proved = 0, with_panels = 0, given_up = 0;
    for (int l = 0; l < N; ++l) {
      if ((bits(lanes) >> l & 1) == 0) continue;
      PellucidCell cell;
      const int code = code_[l], stretch = PackedSpanInfo::stretch_of(code);
      for (int a = 0; a < 3; ++a) {
        cell.cell[a] = workspace_.stretches.block[a][stretch] * block_width +
                       PackedSpanInfo::place_in_block(code, a);
      }
      cell.begin = workspace_.stretches.begin[stretch];
      cell.from = from[l];
      cell.position_error = static_cast<double>(place_error_[l]);
      cell.allowance_flat = static_cast<double>(flat[l]);
      cell.allowance_per_opacity = static_cast<double>(all[l] - flat[l]);
      PellucidCellResult result;
      job_.integrate_cell(job_.context, first_ + l, &cell, &result);
      if (result.status == pellucid_left) {
        given_up |= 1u << l;
        continue;
      }
      scalar_fallback.set(l, result);
      if (result.proved == 0) not_proved |= 1u << l;
      if (result.panels != 0) with_panels |= 1u << l;
    }
    fail(M::from_bits(given_up));
    lanes = lanes & pending_;
    compositor_.add(scalar_fallback, select(lanes, length, F(0)));
    proved_ = proved_ & !M::from_bits(not_proved);
    pieces_ += select(lanes, I(1), I(0));
    in_double_ += select(lanes & !in_double_now_, I(1), I(0));
    panels_ += select(M::from_bits(with_panels), I(1), I(0));
    pending_ = pending_ & !lanes;
    retire(lanes);
  }

  const PellucidPacketJob& job_;
  const PacketGrid& grid_;
  const BinnedTransfer& transfer_;
  Workspace& workspace_;
  int first_, count_;
  BlockMarch<N> blocks_;
  SpanFinder<N> finder_;
  Light light_;
  // The pieces that lanes work on, and their light.
  LitPiece lit_piece_;
  PieceLight lit_;
  Surfaces surfaces_;
  SmoothMarch<N> smooth_;

  SpanQueue<N> queue_;
  F row_[SpanRows<N>::fields];  ///< that lanes took last

  // The span that a lane works on.
  M pending_{false};
  M scalar_fallback_{false};  ///< those of them that are not for the rule here
  M in_double_now_{false};    ///< those that binary32 is not good enough for
  M not_begun_{false};        ///< and of which double_ does not hold anything yet
  M whole_block_{false};      ///< of one material
  SpanLanes<float, N> single_;
  SpanLanes<double, N> double_;
  int waited_ = 0;  ///< pieces that lanes which wait for double could have integrated
  F left_;          ///< of the ray, from the span's begin on, world length
  F span_length_;   ///< of all of it
  F place_error_;   ///< how far spans' ends may be from where they are thought to be,
                    ///< world length
  I code_;
  F close_{0};       ///< what its data may be off by, beside isosurfaces
  M failed_{false};  ///< whether a lane's ray is left

  SampledErrors<F> sampled_;
  Like like_;
  LaneCompositor<N> compositor_;
  OpacityTrace<N> trace_;
  F largest_color_;
  bool double_will_do_;  ///< with colors in float
  M proved_{true};
  std::int32_t cells_seen_[N] = {};
  I skipped_, constant_;
  I pieces_;  ///< all of them
  I in_double_, panels_;
  I strides_, samples_taken_;
};

}  // namespace pellucid
#endif
