// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/budget.h"
#include "pellucid/packet/cell_chunk.h"
#include "pellucid/packet/multivariate_interface.h"
#include "pellucid/packet/panel_list.h"
#include "pellucid/packet/table_absorbs.h"
#include "pellucid/segment/compositor.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/multivariate_blocks.h"

#if PELLUCID_HAS_BATCH_4
namespace pellucid {

/// One ray through several fields within a tolerance, as MultivariateRayIntegrator, with N panels
/// in lanes: the lanes lie one behind the other on the ray. Each may cost what it could if all in
/// front of it took their shares (RayBudget::allowance_ahead), so that they can be done together.
///
/// Cells are gathered N at a time. Those in which nothing matters are passed over at once; the
/// others become panels, of which the first N that are not done are tried together, and cut where
/// they have to be. What is done is folded as soon as all in front of it is.
template <int N>
class MultivariateRay {
  using B = Batch<double, N>;

 public:
  /// What a ray needs to work; too large for the stack of a small thread.
  struct Room {
    static constexpr int chunks = 8;
    CellChunk<N> chunk[chunks];
    PanelList panels;
    PanelWorkspace<B> terms;
  };

  MultivariateRay(const PellucidMultivariateJob& job, const PellucidRay& ray, Room& room) noexcept
      : job_(job),
        grid_(*static_cast<const MultichannelGrid*>(job.grid)),
        blocks_(*static_cast<const MultivariateBlocks*>(job.blocks)),
        transfer_(*static_cast<const MultivariateTransfer<double>*>(job.transfer)),
        ray_{{ray.origin[0], ray.origin[1], ray.origin[2]},
             {ray.direction[0], ray.direction[1], ray.direction[2]}},
        largest_color_(max(job.largest_color, 1.0)),
        room_(room),
        block_walk_(blocks_.records, ray_, {ray.begin, ray.end}),
        cell_walk_(grid_.axis, ray_, {ray.begin, ray.begin}),
        begin_(ray.begin),
        length_(ray.end - ray.begin),
        budget_(job.tolerance, length_) {
    room_.panels.clear();
    demand_.grade = job.proved != 0 ? Grade::proved : Grade::estimated;
    demand_.largest_color = largest_color_;
  }

  void run() noexcept {
    bool more = true;
    while (!done()) {
      while (more && pending_ < N && live_chunks() < Room::chunks &&
             room_.panels.room() >= kept_room + 2 * N) {
        more = gather();
      }
      if (room_.panels.front() < 0) {
        if (!more) break;
        continue;
      }
      integrate();
      fold();
    }
  }

  void store(PellucidRayResult& result) const noexcept {
    // Folding in double costs 4 u a panel (segment/compositor.h).
    const double folding = 4 * rounding_unit<double> * largest_color_ * folded_;
    const Rgb<double> radiance = fold_.radiance();
    result = {};
    result.radiance[0] = radiance.r;
    result.radiance[1] = radiance.g;
    result.radiance[2] = radiance.b;
    result.opacity = fold_.opacity();
    result.optical_depth = fold_.optical_depth();
    result.error = budget_.spent() + rest() + folding;
    result.half = {begin_, begin_ + length_, 0};
    result.cells = result.evaluations = cells_;
    result.skipped = skipped_;
    result.closed = folded_ - nodes_;
    result.panels = nodes_;
    result.proved = proved_ ? 1 : 0;
  }

 private:
  static constexpr int most_cuts = 60;
  /// Places in the list for the cuts of the front panel.
  static constexpr int kept_room = most_cuts + 4;
  static constexpr double left_out_share = 1.0 / 8;

  bool done() const noexcept { return budget_.allows_termination(rest(), job_.tolerance); }

  /// A bound on what lies behind: as little as light can come from there.
  double rest() const noexcept {
    return budget_.remainder_bound(fold_.transparency(), job_.largest_extinction, largest_color_);
  }

  /// Stretches in which so much depth, at most, is left out.
  void skip(int stretches, double length, double depth) noexcept {
    skipped_ += stretches;
    budget_.spend(length, 0, fold_.transparency(), largest_color_ * min(depth, 1.0));
  }

  /// The next cell that is not in a block to skip; false behind the last one.
  bool next_cell(StructuredWalk<double>::Step& step) noexcept {
    while (!cell_walk_.next(step)) {
      BlockStep block;
      if (!block_walk_.next(blocks_.classes.block, block)) return false;
      if (blocks_.classes[block.block].kind == BlockKind::skip) {
        const double length = block.t_end - block.t_begin;
        skip(1, length, blocks_.left_out * length);
        continue;
      }
      primitives_ = blocks_.primitives[block.block];
      cell_walk_ = StructuredWalk<double>(grid_.axis, ray_, {block.t_begin, block.t_end});
    }
    return true;
  }

  int live_chunks() const noexcept { return newest_ - oldest_; }
  CellChunk<N>& chunk(int number) noexcept { return room_.chunk[number % Room::chunks]; }

  /// Another chunk of cells; false behind the last one.
  bool gather() noexcept {
    CellChunk<N>& cells = chunk(newest_);
    cells.clear();
    StructuredWalk<double>::Step step;
    bool more = true;
    while (!cells.full() && (more = next_cell(step))) {
      ++cells_;
      cells.add(grid_, step, primitives_);
    }
    if (cells.count() == 0) return more;
    cells.finish(grid_.channels);
    if (unculled_ > 0) {
      --unculled_;
      take_whole(cells);
    } else {
      cull(cells);
    }
    return more;
  }

  /// Makes panels of all cells. Where Gaussians are wide against what the data do, culling finds
  /// nothing, and takes as long as a panel.
  void take_whole(CellChunk<N>& cells) noexcept {
    int clear = 0;
    double passed = 0;
    for (int l = 0; l < cells.count(); ++l) {
      if (cells.filled(l)) {
        room_.panels.append(newest_, l, 0, 1);
        ++pending_;
      } else {
        passed += cells.length(l);
        ++clear;
      }
    }
    if (clear > 0) skip(clear, passed, 0);
    if (clear < cells.count()) ++newest_;
  }

  /// Makes panels of the parts of the cells in which something matters. What is left out of a cell
  /// is at most the share `left_out_share` of what its length may cost.
  void cull(CellChunk<N>& cells) noexcept {
    CubicBernstein<B> data[max_channels];
    for (int c = 0; c < grid_.channels; ++c) data[c] = cells.cubic(c);
    const GaussianMixture<double>& all = transfer_.gaussians;
    // The extinction that a primitive may have and be left out.
    const double negligible = left_out_share * budget_.allowance_per_length() /
                              (fold_.transparency() * max(all.count, 1) * largest_color_);
    B from(2.0), to(-1.0);
    PrimitiveSet wanted[N];
    for (PrimitiveSet& set : wanted) set.bits = 0;
    PrimitiveSet any_cell{0};
    for (int l = 0; l < cells.count(); ++l) any_cell.bits |= cells.primitives(l).bits;
    double left_out = blocks_.left_out;
    for (int i = 0; i < all.count; ++i) {
      if (!any_cell.contains(i)) continue;
      const Gaussian<double>& g = all.primitive[i];
      left_out += min(g.peak, negligible);
      if (!(g.peak > negligible)) continue;
      const double exponent = log(g.peak / negligible);
      const GaussianCubic<B> cubic(g, data);
      const auto near = cubic.lower() < B(exponent);
      if (none(near)) continue;
      const auto part = cubic.range_within(B(sqrt(exponent)));
      const auto matters = near & (part.from < part.to);
      from = select(matters, min(from, part.from), from);
      to = select(matters, max(to, part.to), to);
      for (unsigned left = bits(matters); left != 0; left &= left - 1) {
        wanted[__builtin_ctz(left)].bits |= 1ULL << (i & 63);
      }
    }
    double begin[N], end[N];
    max(from, B(0.0)).store(begin);
    min(to, B(1.0)).store(end);
    int clear = 0;
    bool used = false, whole = true;
    double passed = 0, depth = 0;  // over at once
    for (int l = 0; l < cells.count(); ++l) {
      const double length = cells.length(l);
      if (!cells.filled(l)) {
        passed += length;
        ++clear;
        continue;
      }
      if (transfer_.tables > 0 && tables_absorb(cells, l)) {
        begin[l] = 0;
        end[l] = 1;
      }
      const double kept = end[l] > begin[l] ? end[l] - begin[l] : 0;
      passed += (1 - kept) * length;
      // What blocks leave out is charged with the panels where there are some.
      depth += (left_out - blocks_.left_out * kept) * length;
      whole = whole && kept == 1;
      if (!(kept > 0)) {
        ++clear;
        continue;
      }
      cells.primitives(l) = wanted[l];
      room_.panels.append(newest_, l, begin[l], end[l]);
      ++pending_;
      used = true;
    }
    skip(clear, passed, depth);
    if (used) ++newest_;
    if (whole) unculled_ = 3;
  }

  bool tables_absorb(const CellChunk<N>& cells, int lane) const noexcept {
    for (int i = 0; i < transfer_.tables; ++i) {
      const ChannelTable<double>& t = transfer_.table[i];
      CubicBernstein<double> data;
      for (int k = 0; k < 4; ++k) data.b[k] = cells.coefficient(t.channel, k, lane);
      if (table_absorbs(t.table, data, 0)) return true;
    }
    return false;
  }

  /// Tries the first N panels that are not done.
  void integrate() noexcept {
    int index[N], count = 0;
    // Panels behind an opaque one have little of the budget and are cut in vain: where the list
    // fills up, the front one is done alone.
    const int most = room_.panels.room() >= kept_room + N ? N : 1;
    for (int i = room_.panels.front(); i >= 0 && count < most; i = room_.panels.next(i)) {
      if (!room_.panels[i].done) index[count++] = i;
    }
    if (count == 0) return;
    const MultivariateSpan<B> span = load(index, count);
    const double transparency = fold_.transparency();
    Shares shares;
    const B from_length = span.length * B((1 - left_out_share) * budget_.allowance_per_length());
    from_length.store(shares.from_length);
    const B least =
        B(RayBudget<double>::minimum_allowance(job_.tolerance, 1 / length_)) * span.length;
    const auto allowance = [&](B opacity) noexcept {
      return max((share_out(opacity, shares) + from_length) * B(1 / transparency), least);
    };
    const PanelSegment<B> panel =
        integrate_multivariate_panel(transfer_, span, demand_, allowance, room_.terms);
    take(panel, span.length, shares, index, count);
  }

  /// What the lanes may take of the budget.
  struct Shares {
    double from_opacity[N], from_length[N];
  };
  /// Shares of the pot that is there for opacity, from front to back.
  B share_out(B opacity, Shares& shares) const noexcept {
    double of_lane[N], left = budget_.unreserved_opacity_budget();
    opacity.store(of_lane);
    for (int l = 0; l < N; ++l) {
      shares.from_opacity[l] = left * of_lane[l];
      left -= shares.from_opacity[l];
    }
    return B::load(shares.from_opacity);
  }

  MultivariateSpan<B> load(const int* index, int count) noexcept {
    double data[max_channels][4][N], begin[N], end[N], length[N], place[N];
    demand_.primitives.bits = 0;
    unsigned last_resort = 0;
    bool whole = true;
    for (int l = 0; l < N; ++l) {
      const PanelList::Panel& panel = room_.panels[index[l < count ? l : 0]];
      CellChunk<N>& cells = chunk(panel.chunk);
      for (int c = 0; c < grid_.channels; ++c) {
        for (int k = 0; k < 4; ++k) data[c][k][l] = cells.coefficient(c, k, panel.lane);
      }
      begin[l] = panel.begin;
      end[l] = panel.end;
      length[l] = l < count ? cells.length(panel.lane) : 0;
      // Cuts inside move by their share of what the cell is longer or shorter by.
      const double off = cells.position_error(panel.lane);
      place[l] = panel.begin > 0 && panel.end < 1 ? (panel.end - panel.begin) * off : off;
      demand_.primitives.bits |= cells.primitives(panel.lane).bits;
      whole = whole && panel.begin == 0 && panel.end == 1;
      const bool small = !(panel.end - panel.begin > 1e-9) || panel.cuts >= most_cuts;
      if (small || room_.panels.room() < 2) last_resort |= 1u << l;
    }
    demand_.last_resort = BatchMask<N>::from_bits(last_resort);
    demand_.position_error = B::load(place);
    MultivariateSpan<B> span;
    for (int c = 0; c < grid_.channels; ++c) {
      for (int k = 0; k < 4; ++k) span.data[c].b[k] = B::load(data[c][k]);
    }
    span.length = B::load(length);
    return whole ? span : span.part(grid_.channels, B::load(begin), B::load(end));
  }

  void take(const PanelSegment<B>& panel, B length, const Shares& shares, const int* index,
            int count) noexcept {
    const B error = panel.error(B(largest_color_)) +
                    B(largest_color_) * min(B(blocks_.left_out) * length, B(1.0));
    const SegmentResult<B>& s = panel.found.segment;
    double cut[N], lengths[N], errors[N], segment[6][N];
    panel.cut.store(cut);
    length.store(lengths);
    error.store(errors);
    s.optical_depth.store(segment[0]);
    s.opacity.store(segment[1]);
    s.transparency.store(segment[2]);
    s.radiance.r.store(segment[3]);
    s.radiance.g.store(segment[4]);
    s.radiance.b.store(segment[5]);
    const unsigned done = bits(panel.done), proved = bits(panel.found.proved),
                   nodes = bits(panel.found.panels);
    for (int l = 0; l < count; ++l) {
      PanelList::Panel& of = room_.panels[index[l]];
      if ((done >> l & 1) == 0) {
        const double at = of.begin + cut[l] * (of.end - of.begin);
        room_.panels.cut(index[l], at > of.begin && at < of.end ? at : 0.5 * (of.begin + of.end));
        ++pending_;
        continue;
      }
      of.done = true;
      of.segment = {segment[0][l],
                    segment[1][l],
                    segment[2][l],
                    {segment[3][l], segment[4][l], segment[5][l]}};
      of.length = lengths[l];
      of.error = errors[l];
      of.from_opacity = shares.from_opacity[l];
      of.from_length = shares.from_length[l];
      budget_.reserve(of.from_opacity);
      of.proved = (proved >> l & 1) != 0;
      of.nodes = (nodes >> l & 1) != 0;
      --pending_;
    }
  }

  /// Folds what is done at the front.
  void fold() noexcept {
    PanelList& panels = room_.panels;
    while (panels.front() >= 0 && panels[panels.front()].done) {
      const PanelList::Panel& panel = panels[panels.front()];
      budget_.spend_reserved(panel.length, panel.from_opacity, panel.from_length,
                             fold_.transparency(), panel.error);
      fold_.add(panel.segment);
      if (panel.segment.optical_depth > 0) {
        ++folded_;
        nodes_ += panel.nodes ? 1 : 0;
        proved_ = proved_ && panel.proved;
      } else {
        ++skipped_;
      }
      panels.remove_front();
      if (done()) return;
    }
    oldest_ = panels.front() >= 0 ? panels[panels.front()].chunk : newest_;
  }

  const PellucidMultivariateJob& job_;
  const MultichannelGrid& grid_;
  const MultivariateBlocks& blocks_;
  const MultivariateTransfer<double>& transfer_;
  Ray<double> ray_;
  double largest_color_;
  Room& room_;
  BlockWalk block_walk_;
  StructuredWalk<double> cell_walk_;  ///< of the block that the ray stands in
  PrimitiveSet primitives_;           ///< of that block
  double begin_, length_;             ///< of the ray
  RayBudget<double> budget_;
  FrontToBackCompositor<double> fold_{0.0};
  PanelDemand<B> demand_;
  int oldest_ = 0, newest_ = 0;  ///< chunks that panels refer to: oldest_ <= number < newest_
  int pending_ = 0;              ///< panels that are not done
  int unculled_ = 0;             ///< chunks that need not be culled
  std::int32_t cells_ = 0, skipped_ = 0, folded_ = 0, nodes_ = 0;
  bool proved_ = true;
};

}  // namespace pellucid
#endif
