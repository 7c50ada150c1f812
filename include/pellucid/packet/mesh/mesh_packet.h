// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/lane_compositor.h"
#include "pellucid/packet/lane_spans.h"
#include "pellucid/packet/mesh/mesh_march.h"
#include "pellucid/packet/mesh/mesh_variable.h"
#include "pellucid/packet/opacity_trace.h"
#include "pellucid/segment/linear.h"
#include "pellucid/transfer/binned.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Integrates N rays through a variable of a mesh, each in a lane of its own and within its own
/// tolerance. What a ray becomes depends on no other lane.
///
/// The rays go ahead some steps at a time (MeshMarch); then each lane takes the spans of its ray
/// that absorb, piece by piece: cut where the extinction has a breakpoint, each is Moreland's
/// integral of linear extinction and color. Where the color has breakpoints of its own, a
/// straight line between the ends replaces it where the budget allows that error. Spans that
/// binary32 cannot resolve are left to another integrator.
///
/// S: the numbers that the rays see the mesh in. With float a ray that is beyond its tolerance is
/// to be followed again in double.
template <class S, int N>
class MeshPacket {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  /// Workspace that many packets use one after the other.
  using Workspace = typename MeshVariable<S, N>::Rows;

  MeshPacket(const PellucidMeshJob& job, Workspace& rows, int first, int count) noexcept
      : job_(job),
        transfer_(*seen(job.transfer)),
        rows_(rows),
        first_(first),
        count_(count),
        march_(job, first, count),
        compositor_(job.tolerance, transfer_.largest_extinction, job.largest_color,
                    max(convert<float>(march_.rays.end - march_.rays.begin), F(0))),
        trace_(job.depth != 0),
        largest_color_(static_cast<float>(job.largest_color)) {
    std::int32_t lane[N];
    for (int l = 0; l < N; ++l) lane[l] = l;
    lane_ = I::load(lane);
  }

  /// Integrates the rays of K packets. They march by turns: while one waits for what it loads the
  /// others go on.
  template <int K>
  static void run(MeshPacket* const (&packets)[K]) noexcept {
    const auto walking = [](const MeshPacket& p) { return p.march_.walking; };
    const auto each = [&](auto&& part) {
      for (MeshPacket* p : packets) {
        if (any(p->march_.walking)) part(*p);
      }
    };
    while (any_of(packets, walking)) {
      for (int s = 0; s < Workspace::steps && any_of(packets, walking); ++s) {
        each([](MeshPacket& p) { p.march_.cross(); });
        each([](MeshPacket& p) { p.march_.load_ahead(); });
        each([](MeshPacket& p) { p.march_.see_ahead(); });
        each([s](MeshPacket& p) { p.put_down(s); });
      }
      for (MeshPacket* p : packets) {
        p->march_.stop_lost(p->cells_);
        p->take_spans();
      }
      while (any_of(packets, [](const MeshPacket& p) { return p.spans_.pending; })) {
        for (MeshPacket* p : packets) p->find_end();
        for (MeshPacket* p : packets) p->integrate_piece();
        for (MeshPacket* p : packets) p->settle_piece();
        for (MeshPacket* p : packets) p->take_spans();
      }
    }
  }

  void store(PellucidRayResult* results) const noexcept {
    const SegmentResult<D> all = compositor_.result();
    const D error =
        compositor_.error(convert<double>(pieces_)) +
        D(job_.largest_color) *
            min(D(job_.largest_extinction) * convert<double>(march_.beside_vacuum), D(1));
    for (int l = 0; l < count_; ++l) {
      PellucidRayResult& r = results[first_ + l];
      r = light_of_lane(all, l);
      r.error = error[l];
      r.cells = r.evaluations = cells_[l];
      if (march_.rays.crowded[l]) r.status = pellucid_left;
      r.closed = pieces_[l];
      r.in_double = in_double_[l];
      r.proved = 1;
      const auto eye = static_cast<double>(march_.rays.eye[l]);
      trace_.find_half(l, static_cast<double>(march_.rays.begin[l]) - eye,
                       static_cast<double>(march_.rays.end[l]) - eye, r);
    }
  }

 private:
  template <int K, class Lanes>
  static bool any_of(MeshPacket* const (&packets)[K], Lanes&& lanes) noexcept {
    M found(false);
    for (const MeshPacket* p : packets) found = found | lanes(*p);
    return any(found);
  }

  void put_down(int s) noexcept {
    cells_ += select(march_.walking, I(1), I(0));
    using Span = typename MeshVariable<S, N>::Span;
    const M found =
        march_.put_down(rows_, s, [this](const Span& span, Workspace&, int, I& note) noexcept {
          const F rounding = span.rounding();
          return absorbs(span.least() - rounding, span.most() + rounding, note);
        });
    spans_.put_down(found, s);
  }

  /// Limit as in PacketIntegrator.
  static constexpr float narrowest = 1.0f / 16;
  /// Largest shift of ends, in optical depth.
  static constexpr float farthest = 1.0f / 8;
  /// Fraction of the remaining budget that a piece may take for rounding, which shorter pieces have
  /// as well, and so has binary64 where what it is handed is known to binary32 only.
  static constexpr float for_rounding = Workspace::more_exact ? 0.0f : 0.25f;

  M absorbs(F least, F most, I& note) const noexcept {
    M jumps;
    const M found = may_absorb(transfer_, M(true), least, most, jumps);
    note += select(jumps, I(SpanNote::scalar_fallback), I(0));
    return found;
  }

  /// Gives the lanes without a span the next one of their ray, if there is any.
  [[gnu::flatten]] void take_spans() noexcept {
    const M lanes = spans_.ready();
    if (none(lanes)) return;
    const F was = front_;
    I note(0);
    spans_.take_oldest(lanes, 0, [&](M here, int at) noexcept {
      const auto take = [&](const float* numbers, F& kept) noexcept {
        kept = select(here, F::load(numbers + at), kept);
      };
      row_ = select(here, I(at) + lane_, row_);
      take(rows_.front, front_);
      take(rows_.back, back_);
      take(rows_.rounding, rounding_);
      take(rows_.length, length_);
      take(rows_.left, left_);
      take(rows_.position_error, place_error_);
      take(rows_.end_error, end_error_);
      note = select(here, I::load(rows_.code + at), note);
    });
    // Where the data go on from where they were, so do extinction and color.
    located_ = located_ & !(lanes & (front_ != was));
    scalar_fallback_ = scalar_fallback_ | (lanes & (note > I(0)));
    span_length_ = select(lanes, length_, span_length_);
    from_ = select(lanes, F(0), from_);
    cap_ = select(lanes, F(1), cap_);
    spans_.pending = spans_.pending | lanes;
  }

  // A piece of each lane that has a span, in parts.

  /// Finds the end of the piece, and the color there.
  [[gnu::flatten]] void find_end() noexcept {
    if (any(scalar_fallback_)) {
      fall_back_to_scalar(scalar_fallback_);
      scalar_fallback_ = M(false);
    }
    const M on = spans_.pending;
    if (none(on)) return;
    const M lost = on & !located_;
    if (any(lost)) {
      const M moved = lost & ((front_ < extinction_.lower) | (front_ >= extinction_.upper));
      if (any(moved)) extinction_ = find_extinction(transfer_, front_, moved, interval_);
      assign_color(lost, front_color_, color_inside(on, front_));
      located_ = located_ | on;
    }
    const ExtinctionInterval<F>& interval = extinction_;
    const M rising = back_ > front_;
    const F limit = select(rising, interval.upper, interval.lower);
    const M beyond = select(rising, back_ > limit, back_ < limit);
    const F rise = back_ - front_;
    F place(1);
    if (any(beyond)) {
      place = select(beyond, clamp((limit - front_) / rise, F(0), F(1)), F(1));
    }
    const M capped = cap_ < place;
    place = min(place, cap_);
    const M crosses = beyond & !capped;
    const F end = select(crosses, limit, select(capped, front_ + place * rise, back_));
    const F length = length_ * place;
    piece_ = {rising, capped, crosses, place, end, length, color_inside(on, end)};
  }

  [[gnu::flatten]] void integrate_piece() noexcept {
    if (none(spans_.pending)) return;
    const ExtinctionInterval<F>& interval = extinction_;
    const auto extinction = [&](F value) noexcept {
      return max(interval.at_lower + interval.slope * (value - interval.lower), F(0));
    };
    segment_ = linear_segment(extinction(front_), extinction(piece_.end), front_color_,
                              piece_.color, piece_.length);
  }

  /// Takes it where the budget pays for it; else cuts it in two or hands it back.
  [[gnu::flatten]] void settle_piece() noexcept {
    const ExtinctionInterval<F>& interval = extinction_;
    // What is charged for an end that is elsewhere is the first order of what it does.
    const M coarse = spans_.pending & (interval.largest * place_error_ > F(farthest));
    if (any(coarse)) give_up(coarse);
    const M on = spans_.pending;
    if (none(on)) return;
    const auto& [rising, capped, crosses, place, end, length, color] = piece_;
    const SegmentResult<F>& s = segment_;
    const F least = min(front_, end), most = max(front_, end), range = most - least;
    F color_error(0);
    if (transfer_.has_color_breakpoints) {
      // A kink at k moves a line between a and b by no more than (k - a)(b - k)/(b - a).
      const F slope_change = color_slope_change(transfer_, least, most);
      color_error = s.opacity * min(F(0.25f) * (slope_change * range), interval.color_range);
    }
    // What rounding can do, as in PacketIntegrator.
    constexpr float u = rounding_unit<float>;
    const F value_error = rounding_;
    const F slope = abs(interval.slope);
    F steep = slope;
    const M touches =
        (least - value_error < interval.lower) | (most + value_error > interval.upper) | crosses;
    if (any(touches)) {
      const F near = select(range > F(2) * value_error, F(2) * value_error / range, F(1));
      steep = select(touches, slope + near * (interval.steepest - slope), slope);
    }
    // An end that is elsewhere, of the same data, takes half of what extinction changes by from one
    // side and gives it to the other; where that is no line, up to all of it.
    const F moved = place_error_ * select((from_ > F(0)) | (place < F(1)), F(1), F(0.5f));
    F depth_error = (length + place_error_) * (value_error * steep) +
                    F(8 * u) * (length * interval.largest) + moved * (slope * range);
    if (any(end_error_ > F(0))) {
      depth_error += end_error_ * (length / span_length_) * interval.largest;
    }
    const F colors = min(interval.color_slope * range, interval.color_range);
    const F color_rounding =
        F(32 * u) * largest_color_ + min(value_error * interval.color_slope, largest_color_);
    const F opacity_rounding =
        F(32 * u) * s.opacity +
        min(select(depth_error <= F(1), F(2) * depth_error * s.transparency, F(1)), F(1));
    // Ends that are elsewhere show another color of the piece, and so does extinction: opacity by
    // their share of the length, and opacity is below extinction · length.
    const F rounding = s.opacity * color_rounding +
                       colors * min(interval.largest * place_error_, s.opacity) +
                       largest_color_ * opacity_rounding + colors * min(depth_error, F(1));

    compositor_.budget.set_remaining_length(
        select(on, left_ - from_ * span_length_, compositor_.budget.remaining_length()));
    const F transparency = compositor_.transparency();
    const typename RayBudget<F>::SpanShare shares =
        compositor_.budget.span_share(length, s.opacity);
    const F cost = transparency * (color_error + rounding);
    const M known = value_error < F(transfer_.narrowest);
    const M take =
        on & known &
        ((cost <= shares.sum()) | ((transparency * color_error <= F(0.5f) * shares.sum()) &
                                   (cost <= F(for_rounding) * compositor_.budget.remaining())));
    const M rest = on & !take;
    if (any(rest)) {
      const F half = F(0.5f) * place;
      const M halve = rest & known & ((F(1) - from_) * half >= F(narrowest)) &
                      (transparency * color_error <= F(64) * shares.sum()) &
                      (transparency * rounding <= F(0.25f) * shares.sum());
      cap_ = select(halve, half, cap_);
      const M other = rest & !halve;
      if (any(other)) fall_back_to_scalar(other);
    }
    if (none(take)) return;
    compositor_.add(take, s);
    compositor_.budget.spend(select(take, length, F(0)), shares, select(take, cost, F(0)));
    pieces_ += select(take, I(1), I(0));

    front_ = select(take, end, front_);
    assign_color(take, front_color_, color);
    const M whole = place >= F(1);
    if (any(take & !whole)) {
      const F remaining = F(1) - place;
      length_ = select(take, length_ * remaining, length_);
      from_ = select(take, from_ + (F(1) - from_) * place, from_);
      cap_ = select(take, select(capped & (place < remaining), place / remaining, F(1)), cap_);
    }
    const M crossed = take & crosses;
    if (any(crossed)) {
      interval_ += select(crossed, select(rising, I(1), I(-1)), I(0));
      extinction_ = load_extinction<F>(transfer_, interval_);
      assign_color(crossed, front_color_, color_inside(crossed, front_));
    }
    const M clear = (max(front_, back_) + rounding_ < F(transfer_.support_min)) |
                    (min(front_, back_) - rounding_ > F(transfer_.support_max));
    spans_.pending = spans_.pending & !(take & (whole | clear));
    retire(take);
  }

  /// The color at a value, coming from inside of the extinction's interval: at its upper end,
  /// behind which the color may be another where nothing absorbs, that just below, by less than the
  /// rounding of the data.
  Rgb<F> color_inside(M lanes, F value) noexcept {
    const F below =
        extinction_.upper - F(4 * rounding_unit<float>) * max(abs(extinction_.upper), F(1e-30f));
    const F inside = max(min(value, below), extinction_.lower);
    return color_at(transfer_, inside, lanes, color_);
  }

  static void assign_color(M lanes, Rgb<F>& to, const Rgb<F>& from) noexcept {
    assign(lanes, to.r, from.r);
    assign(lanes, to.g, from.g);
    assign(lanes, to.b, from.b);
  }

  /// Leaves the lanes' rays to those who know better where they are.
  void give_up(M lanes) noexcept {
    march_.give_up(lanes);
    spans_.forget(lanes);
  }

  /// Something was added to the lanes' rays: ends those that no longer matter.
  void retire(M lanes) noexcept {
    trace_.note(lanes, compositor_);
    const M done = compositor_.cut_off(lanes);
    if (none(done)) return;
    march_.stop(done);
    spans_.forget(done);
  }

  /// Has what is left of the lanes' spans integrated by other means.
  void fall_back_to_scalar(M lanes) noexcept {
    lanes = lanes & spans_.pending;
    compositor_.budget.set_remaining_length(
        select(lanes, left_ - from_ * span_length_, compositor_.budget.remaining_length()));
    ScalarFallback<N> scalar_fallback;
    for (int l = 0; l < N; ++l) {
      if ((bits(lanes) >> l & 1) == 0) continue;
      const int row = row_[l];
      if ((rows_.code[row] & SpanNote::overlaps) != 0) {
        scalar_fallback.error[l] = job_.largest_color;  // anything may be there
        continue;
      }
      const auto [front, back, length, off_by] = exact_span(row);
      const double from = static_cast<double>(from_[l]);
      // Where pieces have ended is known in binary32, and lengths are rounded.
      const double off = (from > 0 ? 4 * static_cast<double>(rounding_unit<float>) : 0) +
                         2 * static_cast<double>(rounding_unit<S>);
      const PellucidLinearSpan span{front + from * (back - front),
                                    back,
                                    off_by,
                                    (1 - from) * length,
                                    static_cast<double>(place_error_[l]),
                                    static_cast<double>(end_error_[l]) + off * length};
      PellucidCellResult result;
      job_.integrate_span(job_.context, &span, &result);
      scalar_fallback.set(l, result);
    }
    compositor_.add(scalar_fallback, select(lanes, length_, F(0)));
    pieces_ += select(lanes, I(1), I(0));
    in_double_ += select(lanes, I(1), I(0));
    spans_.pending = spans_.pending & !lanes;
    retire(lanes);
  }

  struct ExactSpan {
    double front, back, length, error;
  };
  ExactSpan exact_span(int row) const noexcept {
    const auto span = [row](const auto& numbers, const float* error) noexcept {
      return ExactSpan{static_cast<double>(numbers.front[row]),
                       static_cast<double>(numbers.back[row]),
                       static_cast<double>(numbers.length[row]), static_cast<double>(error[row])};
    };
    if constexpr (Workspace::more_exact) {
      return span(rows_.exact, rows_.exact.error);
    } else {
      return span(rows_, rows_.rounding);
    }
  }

  const PellucidMeshJob& job_;
  const BinnedTransfer& transfer_;
  Workspace& rows_;
  int first_, count_;
  MeshMarch<S, N, MeshVariable<S, N>> march_;
  I lane_;

  LaneSpans<N> spans_;

  // The span that a lane works on.
  M scalar_fallback_{false};  ///< those of them that are not for the rule here
  M located_{false};          ///< whether `interval_` and the color at the front are known
  I row_{0}, interval_{0};
  F front_{0}, back_{0};  ///< data, of what is left of it
  F left_{0};             ///< of the ray, from the span's begin on, world length
  F length_{0};           ///< world length of what is left of it
  F span_length_{1};      ///< of all of it
  F from_{0};             ///< the share that is done
  F cap_{1};              ///< the most that the next piece may be of what is left
  F rounding_{0}, place_error_{0}, end_error_{0};
  Rgb<F> front_color_{F(0), F(0), F(0)};
  ExtinctionInterval<F> extinction_{F(0), F(0), F(0), F(0), F(0), F(0), F(0), F(0)};
  ColorInterval<F> color_;

  struct Piece {
    M rising{false}, capped{false}, crosses{false};
    F place{0}, end{0}, length{0};
    Rgb<F> color{F(0), F(0), F(0)};
  };
  Piece piece_;
  SegmentResult<F> segment_;

  LaneCompositor<N> compositor_;
  OpacityTrace<N> trace_;
  F largest_color_;
  I cells_{0}, pieces_{0}, in_double_{0};
};

}  // namespace pellucid
#endif
