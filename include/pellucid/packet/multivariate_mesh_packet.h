// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/lane_primitive_sets.h"
#include "pellucid/packet/mesh_march.h"
#include "pellucid/packet/mesh_mixture.h"
#include "pellucid/packet/mesh_variables.h"
#include "pellucid/packet/packet_fold.h"
#include "pellucid/packet/table_absorbs.h"
#include "pellucid/render/integrate_mesh_ray.h"
#include "pellucid/segment/multivariate_panel.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Integrates N rays through several variables of a mesh, each in a lane of its own and within its
/// own tolerance, as integrate_multivariate_mesh_ray(). What a ray becomes depends on no other
/// lane.
///
/// The rays go ahead some steps at a time (MeshMarch), past spans in which nothing matters; then
/// each lane takes the spans of its ray that are left, panel by panel, cut where the budget does
/// not pay for them. All of it in double, but for what tells near from far.
template <int N>
class MultivariateMeshPacket {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Variables = MeshVariables<N>;
  static constexpr int most_cuts = 60;
  /// What many packets have one after the other: with 16 lanes 200 kB.
  struct Room {
    typename Variables::Rows rows;
    PanelRoom<D> terms;
    double end[most_cuts + 1][N];  ///< of the parts of a lane's span that are still to do
  };

  MultivariateMeshPacket(const PellucidMeshJob& job, Room& room, int first, int count) noexcept
      : job_(job),
        mixture_(*static_cast<const MeshMixture*>(job.transfer)),
        transfer_(mixture_.transfer),
        room_(room),
        first_(first),
        count_(count),
        march_(job, first, count),
        length_(max(convert<float>(march_.rays.end - march_.rays.begin), F(0))),
        fold_(job.tolerance, job.largest_extinction, job.largest_color, length_) {
    demand_.grade = job.proved != 0 ? Grade::proved : Grade::estimated;
    demand_.largest_color = job.largest_color;
  }

  void run() noexcept {
    while (any(march_.walking)) {
      see_less();
      for (int s = 0; s < Variables::Rows::steps && any(march_.walking); ++s) step(s);
      march_.stop_lost(cells_);
      take_spans();
      while (any(spans_.pending)) {
        integrate();
        take_spans();
      }
    }
  }

  void store(PellucidRayResult* results) const noexcept {
    const SegmentResult<D> all = fold_.result();
    const D beside = D(job_.largest_color) *
                     min(D(job_.largest_extinction) * convert<double>(march_.beside_vacuum), D(1));
    // As long as the way is, and where it may be longer.
    const D longer = convert<double>(march_.passed_ends / share_of_diagonal());
    const D not_seen =
        D(2 * job_.largest_color * mixture_.left_out) * (D(mixture_.diagonal) + longer);
    const D error = fold_.error(convert<double>(taken_)) + beside + not_seen;
    for (int l = 0; l < count_; ++l) {
      PellucidRayResult& r = results[first_ + l];
      r = light_of_lane(all, l);
      r.error = march_.rays.meets[l] ? error[l] : 0;
      r.cells = r.evaluations = cells_[l];
      // Nothing is known of those that were not followed.
      if (march_.rays.crowded[l]) r.error = std::numeric_limits<double>::infinity();
      r.closed = panels_[l] - nodes_[l];
      r.panels = nodes_[l];
      r.skipped = cells_[l] > panels_[l] ? cells_[l] - panels_[l] : 0;
      r.proved = estimated_[l] ? 0 : 1;
    }
  }

 private:
  /// How much may be left out from here on: all rays may leave out as much light, and where much is
  /// in front there is less of it.
  void see_less() noexcept {
    const F depth = convert<float>(fold_.result().optical_depth);
    less_ = max(depth - log(share_of_diagonal()), F(0)) * F(1 - 16 * rounding_unit<float>);
    left_out_ = F(static_cast<float>(mixture_.left_out)) * exp(min(less_, F(60)));
  }
  F share_of_diagonal() const noexcept {
    const auto diagonal = static_cast<float>(mixture_.diagonal);
    return clamp(length_ * F(1 / diagonal), F(1e-6f), F(1));
  }

  void step(int s) noexcept {
    march_.cross();
    march_.load_ahead();
    march_.see_ahead();
    cells_ += select(march_.walking, I(1), I(0));
    const M found =
        march_.put_down(room_.rows, s,
                        [this](const typename Variables::Span& span, typename Variables::Rows& rows,
                               int at, I& /*note*/) noexcept { return matters(span, rows, at); });
    spans_.put_down(found, s);
  }

  /// Whether anything of the spans may be seen; where |p|² >= square - less_ a primitive has
  /// e^less_ times what is negligible, at most. As much as the primitives that are passed over may
  /// have, errors of the data may change where all are.
  [[gnu::flatten]] M matters(const typename Variables::Span& span, typename Variables::Rows& rows,
                             int at) noexcept {
    LinearBernstein<F> data[most_channels];
    F changed(0);
    for (int c = 0; c < span.channels; ++c) {
      data[c] = {{convert<float>(span.front[c]), convert<float>(span.back[c])}};
      changed += F(static_cast<float>(mixture_.steepness[c])) * span.error(c);
    }
    changed = changed * F(1 + 16 * rounding_unit<float>);
    LanePrimitiveSets<N> sets;
    M found(false);
    for (int i = 0; i < transfer_.gaussians.count; ++i) {
      const NearGaussian& g = mixture_.primitive[i];
      const GaussianLinear<F> along(g.gaussian, data);
      const M seen = march_.walking & along.comes_within(F(g.square) - less_);
      sets.add(seen, i);
      found = found | seen;
    }
    if (transfer_.tables > 0) found = found | tables_matter(span, changed);
    changed = min(changed, F(static_cast<float>(job_.largest_extinction)));
    found = found | (changed > left_out_);
    changed.store(rows.changed + at);
    sets.low.store(rows.low + at);
    sets.high.store(rows.high + at);
    return found;
  }

  /// Whether tables absorb, lane by lane; and how far errors of the data change that.
  M tables_matter(const typename Variables::Span& span, F& changed) const noexcept {
    double front[most_channels][N], back[most_channels][N];
    float error[most_channels][N], of_lane[N];
    for (int c = 0; c < span.channels; ++c) {
      span.front[c].store(front[c]);
      span.back[c].store(back[c]);
      span.error(c).store(error[c]);
    }
    changed.store(of_lane);
    unsigned found = 0;
    for (unsigned left = bits(march_.walking); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      MeshSpan one;
      bool vacuum = false;
      for (int c = 0; c < span.channels; ++c) {
        one.front[c] = front[c][l];
        one.back[c] = back[c][l];
        one.value_error[c] = static_cast<double>(error[c][l]);
        vacuum = vacuum || is_nan(one.front[c] + one.back[c]);
      }
      if (vacuum) continue;
      if (tables_absorb(one)) found |= 1u << l;
      of_lane[l] += static_cast<float>(detail::error_through_tables(transfer_, one)) *
                    (1 + 4 * rounding_unit<float>);
    }
    changed = F::load(of_lane);
    return M::from_bits(found);
  }

  bool tables_absorb(const MeshSpan& span) const noexcept {
    for (int i = 0; i < transfer_.tables; ++i) {
      const int c = transfer_.table[i].channel;
      const LinearBernstein<double> data{{span.front[c], span.back[c]}};
      if (table_absorbs(transfer_.table[i].table, as_cubic(data), span.value_error[c])) return true;
    }
    return false;
  }

  /// Gives the lanes without a span the next one of their ray, if there is any.
  void take_spans() noexcept {
    const M lanes = spans_.ready();
    if (none(lanes)) return;
    const auto& rows = room_.rows;
    std::int32_t waiting[N];
    spans_.waiting.store(waiting);
    int step_of[N] = {};
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      step_of[l] = __builtin_ctz(static_cast<unsigned>(waiting[l]));
      waiting[l] &= waiting[l] - 1;
    }
    spans_.waiting = I::load(waiting);
    I note(0);
    // Rays beside each other are at nearly the same step.
    for (unsigned left = bits(lanes); left != 0;) {
      const int s = step_of[__builtin_ctz(left)];
      unsigned at_step = 0;
      for (int l = 0; l < N; ++l) at_step |= step_of[l] == s ? 1u << l : 0u;
      const M here = M::from_bits(left & at_step);
      const int at = s * N;
      const auto take = [&](const auto* numbers, auto& kept) noexcept {
        kept = select(here, std::decay_t<decltype(kept)>::load(numbers + at), kept);
      };
      for (int c = 0; c < transfer_.channels; ++c) {
        take(rows.front[c], front_[c]);
        take(rows.back[c], back_[c]);
      }
      take(rows.exact_length, span_length_);
      take(rows.left, left_);
      take(rows.changed, changed_);
      take(rows.low, demand_.primitives.low);
      take(rows.high, demand_.primitives.high);
      F place_error(0), end_error(0);
      take(rows.place_error, place_error);
      take(rows.end_error, end_error);
      place_error_ = select(here, place_error + end_error, place_error_);
      take(rows.code, note);
      left &= ~at_step;
    }
    from_ = select(lanes, D(0), from_);
    to_ = select(lanes, D(1), to_);
    open_ = select(lanes, I(0), open_);
    spans_.pending = spans_.pending | lanes;
    // What lies in tetrahedra that overlap is for a ray by itself to say.
    const M lost = lanes & (note > I(0));
    if (any(lost)) give_up(lost);
  }

  /// A panel of each lane that has a span.
  void integrate() noexcept {
    const M on = spans_.pending;
    if (none(on)) return;
    const M whole = (!on) | ((from_ == D(0)) & (to_ == D(1)));
    LinearSpan<D> span;
    for (int c = 0; c < transfer_.channels; ++c) span.data[c] = {{front_[c], back_[c]}};
    span.length = select(on, span_length_, D(0));
    if (!all(whole)) span = span.part(transfer_.channels, from_, to_);
    // Cuts inside of a span move by their share of what it is longer or shorter by.
    const D place_error = convert<double>(place_error_);
    demand_.place_error =
        select((from_ > D(0)) & (to_ < D(1)), (to_ - from_) * place_error, place_error);
    demand_.last_resort = (open_ >= I(most_cuts)) | !(to_ - from_ > D(1e-9));
    fold_.budget.pass_to(select(on, max(left_ - convert<float>(from_ * span_length_), F(0)),
                                fold_.budget.length_left()));
    const F length = convert<float>(span.length);
    const F transparency = select(on, fold_.transparency(), F(1));
    const F least = RayBudget<F>::least_allowance(F(static_cast<float>(job_.tolerance)),
                                                  length / max(length_, length));
    const auto allowance = [&](const D& opacity) noexcept {
      return convert<double>(
          max(fold_.budget.allowance(length, convert<float>(opacity), transparency), least));
    };
    const PanelSegment<D> panel =
        integrate_multivariate_panel(transfer_, span, demand_, allowance, room_.terms);

    const M take = on & panel.done;
    if (any(take)) {
      const F error = convert<float>(panel.error(demand_.largest_color)) +
                      F(static_cast<float>(job_.largest_color)) * min(changed_ * length, F(1));
      fold_.add(take, panel.found.segment);
      fold_.budget.spend(select(take, length, F(0)), convert<float>(panel.opacity), transparency,
                         select(take, error * F(1 + 8 * rounding_unit<float>), F(0)));
      const M absorbs = take & (panel.found.segment.optical_depth > D(0));
      taken_ += select(take, I(1), I(0));
      panels_ += select(absorbs, I(1), I(0));
      nodes_ += select(absorbs & panel.found.panels, I(1), I(0));
      estimated_ = estimated_ | (absorbs & !panel.found.proved);
      next_part(take);
      retire(take);
    }
    const M rest = on & !panel.done;
    if (any(rest)) cut(rest, panel.cut);
  }

  /// Of a span that is cut, what lies behind the panel that is done.
  void next_part(M lanes) noexcept {
    const M more = lanes & (open_ > I(0));
    from_ = select(more, to_, from_);
    for (unsigned left = bits(more); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      to_ = select(M::from_bits(1u << l), D(room_.end[open_[l] - 1][l]), to_);
    }
    open_ -= select(more, I(1), I(0));
    spans_.pending = spans_.pending & !(lanes & !more);
  }

  void cut(M lanes, const D& share) noexcept {
    const D at = from_ + share * (to_ - from_);
    const M inside = (at > from_) & (at < to_);
    const D end = select(inside, at, D(0.5) * (from_ + to_));
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      room_.end[open_[l]][l] = to_[l];
    }
    open_ += select(lanes, I(1), I(0));
    to_ = select(lanes, end, to_);
  }

  /// Leaves the lanes' rays to those who know better where they are.
  void give_up(M lanes) noexcept {
    march_.give_up(lanes);
    spans_.forget(lanes);
  }

  /// Ends those of the lanes' rays that no longer matter.
  void retire(M lanes) noexcept {
    const M done = fold_.cut_off(lanes);
    if (none(done)) return;
    march_.stop(done);
    spans_.forget(done);
  }

  const PellucidMeshJob& job_;
  const MeshMixture& mixture_;
  const Multivariate<double>& transfer_;
  Room& room_;
  int first_, count_;
  MeshMarch<double, N, Variables> march_;
  F length_;       ///< of the rays, from where they enter the mesh to where they leave it
  F less_{0};      ///< ln of how much more may be left out than on the longest ray, behind nothing
  F left_out_{0};  ///< that extinction
  PanelDemand<D, LanePrimitiveSets<N>> demand_;  ///< of the spans that lanes work on
  PacketFold<N> fold_;

  LaneSpans<N> spans_;

  // The span that a lane works on, and which part of it.
  D front_[most_channels], back_[most_channels], span_length_{0};
  F left_{0}, changed_{0}, place_error_{0};
  D from_{0}, to_{1};
  I open_{0};  ///< parts behind that one

  I cells_{0};
  I taken_{0};  ///< panels that are done; of these absorb `panels_`, of them by nodes `nodes_`
  I panels_{0}, nodes_{0};
  M estimated_{false};
};

}  // namespace pellucid
#endif
