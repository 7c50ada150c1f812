// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/bundle/culled_mixture.h"
#include "pellucid/packet/bundle/lane_primitive_sets.h"
#include "pellucid/packet/lane_compositor.h"
#include "pellucid/packet/lane_spans.h"
#include "pellucid/packet/mesh/mesh_rows.h"
#include "pellucid/packet/opacity_trace.h"
#include "pellucid/segment/multivariate_panel.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rows of spans of several variables, in double: Data of each, by its coefficients.
template <int N, template <class> class Data>
struct PanelRows : MeshRows<N, 16> {
  using MeshRows<N, 16>::size;
  static constexpr int numbers = sizeof(Data<double>) / sizeof(double);

  double data[max_channels][numbers][size], exact_length[size];
  float changed[size];  ///< a bound on the change of extinction that errors of the data make
  std::int32_t low[size], high[size];  ///< LanePrimitiveSets: those that may matter
};

/// Panels in closed form, in double.
template <int N>
struct ClosedPanels {
  using D = Batch<double, N>;
  using Workspace = PanelWorkspace<D>;

  template <class Data, class Demand, class Allowance>
  static PanelSegment<D> integrate(const CulledMixture& mixture,
                                   const MultivariateSpan<D, Data>& span, const Demand& demand,
                                   BatchMask<N> /*on*/, const Batch<float, N>& /*less*/,
                                   const Allowance& allowance, Workspace& workspace) noexcept {
    return integrate_multivariate_panel(mixture.transfer, span, demand, allowance, workspace);
  }
};

/// Integrates spans of rays in lanes, each within its ray's tolerance: panel by panel, cut where
/// the budget does not pay for them. The light of a ray depends on no other lane. Panels: how.
template <int N, template <class> class Data, class Panels>
class PanelLanes {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Rows = PanelRows<N, Data>;
  using Span = MultivariateSpan<D, Data<D>>;
  static constexpr int max_cuts = 60;
  /// Workspace that many packets use one after the other: with 16 lanes 800 kB, on the stack.
  struct Workspace {
    Rows rows;
    typename Panels::Workspace terms;
    double end[max_cuts + 1][N];  ///< of the parts of a lane's span that are still to do
  };

  /// `length` of the rays, where they may absorb; `largest_color` >= 1; `depth`: whether trace() is
  /// asked for.
  PanelLanes(const CulledMixture& mixture, double tolerance, double largest_color,
             double largest_extinction, bool proved, bool depth, const F& length,
             Workspace& workspace) noexcept
      : mixture_(mixture),
        transfer_(mixture.transfer),
        tolerance_(static_cast<float>(tolerance)),
        largest_color_(largest_color),
        workspace_(workspace),
        length_(length),
        log_share_(log(share_of_diagonal())),
        compositor_(tolerance, largest_extinction, largest_color, length),
        trace_(depth) {
    demand_.grade = proved ? Grade::proved : Grade::estimated;
    demand_.largest_color = largest_color;
    see_less();
  }

  /// Sets the light that may be left out from here on: all rays may leave out as much light, and
  /// where much is in front there is less of it. What rays become depends on when this is called:
  /// it must not depend on other lanes.
  void see_less() noexcept {
    less = less_by_now();
    left_out = F(static_cast<float>(mixture_.left_out)) * exp(min(less, F(60)));
  }
  F less{0};      ///< ln of how much more may be left out than on the longest ray, behind nothing
  F left_out{0};  ///< that extinction

  /// Return the row in which spans are stored next; and whether no lane waits for its contents.
  int row() const noexcept { return row_; }
  bool has_row() const noexcept { return none((spans_.waiting & I(1 << row_)) != I(0)); }
  /// Spans were put down there in these lanes.
  void add(M found) noexcept {
    spans_.put_down(found, row_);
    row_ = (row_ + 1) % Rows::steps;
  }
  /// Lanes that have spans.
  M busy() const noexcept { return spans_.pending | (spans_.waiting != I(0)); }
  /// Leaves out what is there of these lanes' rays.
  void forget(M lanes) noexcept { spans_.forget(lanes); }

  /// Integrates a panel of each lane that has a span. stop(lanes): rays that matter no more.
  /// lost(lanes): spans with a note, which are not for panels.
  template <class Stop, class Lost>
  void integrate(Stop&& stop, Lost&& lost) noexcept {
    take_spans(lost);
    if (any(spans_.pending)) integrate_panels(stop);
  }

  const OpacityTrace<N>& trace() const noexcept { return trace_; }

  SegmentResult<D> result() const noexcept { return compositor_.result(); }
  /// Returns the error of that; `longer`: how much longer the rays may be where spans were passed
  /// over, as left_out says.
  D error(const F& longer) const noexcept {
    const D all = D(mixture_.diagonal) + convert<double>(longer / share_of_diagonal());
    return compositor_.error(convert<double>(taken_)) + D(largest_color_ * mixture_.charged) * all;
  }
  I panels{0}, nodes{0};  ///< that absorb; of these, those whose color Gauss nodes have
  M estimated{false};

 private:
  F share_of_diagonal() const noexcept {
    const auto diagonal = static_cast<float>(mixture_.diagonal);
    return clamp(length_ * F(1 / diagonal), F(1e-6f), F(1));
  }
  F less_by_now() const noexcept {
    const F depth = convert<float>(compositor_.result().optical_depth);
    return max(depth - log_share_, F(0)) * F(1 - 16 * rounding_unit<float>);
  }

  /// Gives the lanes without a span the next one of their ray, if there is any.
  template <class Lost>
  void take_spans(Lost&& lost) noexcept {
    const M lanes = spans_.ready();
    if (none(lanes)) return;
    const Rows& rows = workspace_.rows;
    I note(0);
    spans_.take_oldest(lanes, row_, [&](M here, int at) noexcept {
      const auto take = [&](const auto* numbers, auto& kept) noexcept {
        kept = select(here, std::decay_t<decltype(kept)>::load(numbers + at), kept);
      };
      for (int c = 0; c < transfer_.channels; ++c) {
        for (int k = 0; k < Rows::numbers; ++k) take(rows.data[c][k], span_.data[c].b[k]);
      }
      take(rows.exact_length, span_length_);
      take(rows.left, left_);
      take(rows.changed, changed_);
      take(rows.low, demand_.primitives.low);
      take(rows.high, demand_.primitives.high);
      F position_error(0), end_error(0);
      take(rows.position_error, position_error);
      take(rows.end_error, end_error);
      place_error_ = select(here, position_error + end_error, place_error_);
      take(rows.code, note);
    });
    from_ = select(lanes, D(0), from_);
    to_ = select(lanes, D(1), to_);
    open_ = select(lanes, I(0), open_);
    spans_.pending = spans_.pending | lanes;
    const M noted = lanes & (note > I(0));
    if (any(noted)) {
      forget(noted);
      lost(noted);
    }
  }

  /// The lanes' spans, or the parts of them that they work on.
  const Span& open_spans(M on) noexcept {
    const D length = select(on, span_length_, D(0));
    if (all((!on) | ((from_ == D(0)) & (to_ == D(1))))) {
      span_.length = length;
      return span_;
    }
    for (int c = 0; c < transfer_.channels; ++c) {
      part_.data[c] = restrict_to(span_.data[c], from_, to_);
    }
    part_.length = (to_ - from_) * length;
    return part_;
  }

  /// A panel of each lane that has a span.
  template <class Stop>
  void integrate_panels(Stop&& stop) noexcept {
    const M on = spans_.pending;
    const Span& span = open_spans(on);
    // Cuts inside of a span move by their share of what it is longer or shorter by.
    const D position_error = convert<double>(place_error_);
    demand_.position_error =
        select((from_ > D(0)) & (to_ < D(1)), (to_ - from_) * position_error, position_error);
    demand_.last_resort = (open_ >= I(max_cuts)) | !(to_ - from_ > D(1e-9));
    compositor_.budget.set_remaining_length(
        select(on, max(left_ - convert<float>(from_ * span_length_), F(0)),
               compositor_.budget.remaining_length()));
    const F length = convert<float>(span.length);
    const F transparency = select(on, compositor_.transparency(), F(1));
    const F least = RayBudget<F>::minimum_allowance(F(tolerance_), length / max(length_, length));
    const auto allowance = [&](const D& opacity) noexcept {
      return convert<double>(
          max(compositor_.budget.allowance(length, convert<float>(opacity), transparency), least));
    };
    const PanelSegment<D> panel =
        Panels::integrate(mixture_, span, demand_, on, less_by_now(), allowance, workspace_.terms);

    const M take = on & panel.done;
    if (any(take)) {
      const F error = convert<float>(panel.error(demand_.largest_color)) +
                      F(static_cast<float>(largest_color_)) * min(changed_ * length, F(1));
      compositor_.add(take, panel.found.segment);
      compositor_.budget.spend(select(take, length, F(0)), convert<float>(panel.opacity),
                               transparency,
                               select(take, error * F(1 + 8 * rounding_unit<float>), F(0)));
      const M absorbs = take & (panel.found.segment.optical_depth > D(0));
      taken_ += select(take, I(1), I(0));
      panels += select(absorbs, I(1), I(0));
      nodes += select(absorbs & panel.found.panels, I(1), I(0));
      estimated = estimated | (absorbs & !panel.found.proved);
      next_part(take);
      trace_.note(take, compositor_);
      const M done = compositor_.cut_off(take);
      if (any(done)) {
        forget(done);
        stop(done);
      }
    }
    const M rest = on & !panel.done;
    if (any(rest)) cut(rest, panel);
  }

  /// Continues spans that are cut with the part behind the panel that is done.
  void next_part(M lanes) noexcept {
    const M more = lanes & (open_ > I(0));
    from_ = select(more, to_, from_);
    for (unsigned left = bits(more); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      to_ = select(M::from_bits(1u << l), D(workspace_.end[open_[l] - 1][l]), to_);
    }
    open_ -= select(more, I(1), I(0));
    spans_.pending = spans_.pending & !(lanes & !more);
  }

  /// Leaves a first part of the lanes' spans to work on, and what is behind it for later: the last
  /// part without what does not matter at its end. Where a part ends the next one begins, so that
  /// of others that comes back as the beginning of the one behind.
  void cut(M lanes, const PanelSegment<D>& panel) noexcept {
    const auto place = [&](const D& share) noexcept { return from_ + share * (to_ - from_); };
    const D begin = place(panel.clear), at = place(panel.cut);
    const M inside = (at > begin) & (at < to_);
    const D end = select(inside, at, D(0.5) * (from_ + to_));
    const D until = select(inside, min(place(panel.until), to_), to_);
    from_ = select(lanes & inside, begin, from_);
    to_ = select(lanes, end, to_);
    const M more = lanes & (until > end);
    for (unsigned left = bits(more); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      workspace_.end[open_[l]][l] = until[l];
    }
    open_ += select(more, I(1), I(0));
  }

  const CulledMixture& mixture_;
  const MultivariateTransfer<double>& transfer_;
  float tolerance_;
  double largest_color_;
  Workspace& workspace_;
  F length_, log_share_;
  PanelDemand<D, LanePrimitiveSets<N>> demand_;  ///< of the spans that lanes work on
  LaneCompositor<N> compositor_;
  OpacityTrace<N> trace_;
  LaneSpans<N> spans_;
  int row_ = 0;

  // The span that a lane works on, and which part of it.
  Span span_, part_;
  D span_length_{0};
  F left_{0}, changed_{0}, place_error_{0};
  D from_{0}, to_{1};
  I open_{0};  ///< parts behind that one

  I taken_{0};  ///< panels that are done
};

}  // namespace pellucid
#endif
