// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/bundle/panel_lanes.h"
#include "pellucid/packet/bundle/table_absorbs.h"
#include "pellucid/packet/mesh/mesh_march.h"
#include "pellucid/packet/mesh/mesh_variables.h"
#include "pellucid/render/integrate_mesh_ray.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Integrates N rays through several variables of a mesh, each in a lane of its own and within its
/// own tolerance, as integrate_multivariate_mesh_ray(). The rays go ahead some steps at a time
/// (MeshMarch), past spans in which nothing matters; then the others are integrated (PanelLanes).
template <int N>
class MultivariateMeshPacket {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Variables = MeshVariables<N>;
  using Panels = PanelLanes<N, LinearBernstein, ClosedPanels<N>>;
  using Workspace = typename Panels::Workspace;

  MultivariateMeshPacket(const PellucidMeshJob& job, Workspace& workspace, int first,
                         int count) noexcept
      : job_(job),
        mixture_(*seen(job.mixture)),
        transfer_(mixture_.transfer),
        rows_(workspace.rows),
        first_(first),
        count_(count),
        march_(job, first, count),
        lanes_(mixture_, job.tolerance, job.largest_color, job.largest_extinction, job.proved != 0,
               job.depth != 0, max(convert<float>(march_.rays.end - march_.rays.begin), F(0)),
               workspace) {}

  void run() noexcept {
    while (any(march_.walking)) {
      lanes_.see_less();
      for (int s = 0; s < steps_ahead && any(march_.walking); ++s) step();
      march_.stop_lost(cells_);
      while (any(lanes_.busy())) {
        lanes_.integrate([this](M lanes) noexcept { march_.stop(lanes); },
                         // What lies in tetrahedra that overlap is for a ray by itself to say.
                         [this](M lanes) noexcept { march_.give_up(lanes); });
      }
    }
  }

  void store(PellucidRayResult* results) const noexcept {
    const SegmentResult<D> all = lanes_.result();
    const D beside = D(job_.largest_color) *
                     min(D(job_.largest_extinction) * convert<double>(march_.beside_vacuum), D(1));
    const D error = lanes_.error(march_.passed_ends) + beside;
    for (int l = 0; l < count_; ++l) {
      PellucidRayResult& r = results[first_ + l];
      r = light_of_lane(all, l);
      r.error = march_.rays.meets[l] ? error[l] : 0;
      r.cells = r.evaluations = cells_[l];
      if (march_.rays.crowded[l]) r.status = pellucid_left;
      const std::int32_t panels = lanes_.panels[l], nodes = lanes_.nodes[l];
      r.closed = panels - nodes;
      r.panels = nodes;
      r.skipped = max(cells_[l] - panels, 0);
      r.proved = lanes_.estimated[l] ? 0 : 1;
      const double eye = march_.rays.eye[l];
      lanes_.trace().find_half(l, march_.rays.begin[l] - eye, march_.rays.end[l] - eye, r);
    }
  }

 private:
  static constexpr int steps_ahead = 8;

  void step() noexcept {
    march_.cross();
    march_.load_ahead();
    march_.see_ahead();
    cells_ += select(march_.walking, I(1), I(0));
    lanes_.add(
        march_.put_down(rows_, lanes_.row(),
                        [this](const typename Variables::Span& span, typename Variables::Rows& rows,
                               int at, I& /*note*/) noexcept { return matters(span, rows, at); }));
  }

  /// Returns the lanes in which anything of the spans may be seen; where |p|² >= square - less a
  /// primitive has e^less times what is negligible, at most. As much as the primitives that are
  /// passed over may have, errors of the data may change where all are.
  [[gnu::flatten]] M matters(const typename Variables::Span& span, typename Variables::Rows& rows,
                             int at) noexcept {
    LinearBernstein<F> data[max_channels];
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
      const M seen = march_.walking & along.comes_within(F(g.square) - lanes_.less);
      sets.add(seen, i);
      found = found | seen;
    }
    if (transfer_.tables > 0) found = found | tables_matter(span, changed);
    changed = min(changed, F(static_cast<float>(job_.largest_extinction)));
    found = found | (changed > lanes_.left_out);
    changed.store(rows.changed + at);
    sets.low.store(rows.low + at);
    sets.high.store(rows.high + at);
    return found;
  }

  /// Returns the lanes in which tables absorb; and how far errors of the data change that.
  M tables_matter(const typename Variables::Span& span, F& changed) const noexcept {
    double front[max_channels][N], back[max_channels][N];
    float error[max_channels][N], of_lane[N];
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

  const PellucidMeshJob& job_;
  const CulledMixture& mixture_;
  const MultivariateTransfer<double>& transfer_;
  typename Panels::Rows& rows_;
  int first_, count_;
  MeshMarch<double, N, Variables> march_;
  Panels lanes_;
  I cells_{0};
};

}  // namespace pellucid
#endif
