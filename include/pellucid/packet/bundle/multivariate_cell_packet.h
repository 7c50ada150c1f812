// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/bundle/multichannel_cells.h"
#include "pellucid/packet/bundle/node_panels.h"
#include "pellucid/packet/bundle/table_absorbs.h"
#include "pellucid/packet/gaussian_packet_interface.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Integrates N rays through several fields behind Gaussians, each in a lane of its own and within
/// its own tolerance, as integrate_multivariate_ray(). The rays go ahead some cells at a time
/// (MultichannelCells), past those in which nothing matters; then the others are integrated
/// (PanelLanes).
template <int N>
class MultivariateCellPacket {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Cells = MultichannelCells<N>;
  using Panels = PanelLanes<N, CubicBernstein, NodePanels<N>>;
  using Workspace = typename Panels::Workspace;

  MultivariateCellPacket(const PellucidGaussianPacketJob& job, const PacketGrid& grid,
                         Workspace& workspace, int first, int count) noexcept
      : job_(job),
        rays_(job.grid_and_rays),
        mixture_(*seen(job.near)),
        rows_(workspace.rows),
        first_(first),
        count_(count),
        march_(rays_, grid, *seen(job.grid), seen(job.primitives), first, count),
        lanes_(mixture_, rays_.tolerance, rays_.largest_color, rays_.largest_extinction,
               job.proved != 0, rays_.depth != 0, convert<float>(march_.end), workspace) {}

  void run() noexcept {
    for (;;) {
      while (any(march_.walking) && lanes_.has_row() &&
             count(march_.walking & !lanes_.busy()) > N / 4) {
        step();
      }
      if (any(lanes_.busy())) {
        lanes_.integrate([this](M lanes) noexcept { march_.stop(lanes); }, [](M) noexcept {});
      } else if (any(march_.walking)) {
        step();
      } else {
        return;
      }
    }
  }

  void store(PellucidRayResult* results) const noexcept {
    const SegmentResult<D> all = lanes_.result();
    const D error =
        lanes_.error(F(0)) + D(rays_.largest_color) * min(D(job_.left_out) * march_.end, D(1));
    for (int l = 0; l < count_; ++l) {
      PellucidRayResult& r = results[first_ + l];
      r = light_of_lane(all, l);
      r.error = error[l];
      const std::int32_t cells = march_.cells[l], panels = lanes_.panels[l],
                         nodes = lanes_.nodes[l];
      r.cells = r.evaluations = cells;
      r.closed = panels - nodes;
      r.panels = nodes;
      r.in_double = job_.proved == 0 && mixture_.transfer.tables == 0 ? r.closed : 0;
      r.skipped = march_.skipped[l] + max(cells - panels, 0);
      r.proved = lanes_.estimated[l] ? 0 : 1;
      const PellucidRay& ray = rays_.rays[first_ + l];
      lanes_.trace().find_half(l, ray.begin, ray.end, r);
    }
  }

 private:
  void step() noexcept {
    march_.skip();
    lanes_.add(march_.step(rows_, lanes_.row() * N,
                           [this](const CubicBernstein<D>* data, typename Cells::Rows& rows,
                                  int at) noexcept { return matters(data, rows, at); }));
  }

  /// Returns the lanes in which anything of the cells may be seen, by the ranges of their data.
  [[gnu::flatten]] M matters(const CubicBernstein<D>* data, typename Cells::Rows& rows,
                             int at) noexcept {
    const int channels = mixture_.transfer.channels;
    for (int c = 0; c < channels; ++c) {
      lower_[c] = convert<float>(data[c].hull_min());
      upper_[c] = convert<float>(data[c].hull_max());
    }
    LanePrimitiveSets<N> sets;
    M found(false);
    for (int i = 0; i < mixture_.transfer.gaussians.count; ++i) {
      const M held = march_.walking & march_.near.contains(i);
      if (none(held)) continue;
      const NearGaussian& g = mixture_.primitive[i];
      const M seen =
          held & !(least_exponent_by_rows(g, lower_, upper_) >= F(g.square) - lanes_.less);
      sets.add(seen, i);
      found = found | seen;
    }
    sets.low.store(rows.low + at);
    sets.high.store(rows.high + at);
    return mixture_.transfer.tables > 0 ? found | tables_absorb(data) : found;
  }

  /// Lane by lane.
  M tables_absorb(const CubicBernstein<D>* data) const noexcept {
    const MultivariateTransfer<double>& transfer = mixture_.transfer;
    unsigned found = 0;
    for (int i = 0; i < transfer.tables; ++i) {
      const D* b = data[transfer.table[i].channel].b;
      for (unsigned left = bits(march_.walking) & ~found; left != 0; left &= left - 1) {
        const int l = __builtin_ctz(left);
        const CubicBernstein<double> of_lane{{b[0][l], b[1][l], b[2][l], b[3][l]}};
        if (table_absorbs(transfer.table[i].table, of_lane, 0)) found |= 1u << l;
      }
    }
    return M::from_bits(found);
  }

  const PellucidGaussianPacketJob& job_;
  const PellucidPacketJob& rays_;
  const CulledMixture& mixture_;
  typename Panels::Rows& rows_;
  int first_, count_;
  Cells march_;
  Panels lanes_;
  /// Range of a cell's data, by channel; kept here so that they are not set to 0 for each.
  F lower_[max_channels], upper_[max_channels];
};

}  // namespace pellucid
#endif
