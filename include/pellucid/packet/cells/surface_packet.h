// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/cell_positions.h"
#include "pellucid/packet/cells/span_queue.h"
#include "pellucid/packet/cells/surface_lanes.h"
#include "pellucid/packet/lane_compositor.h"
#include "pellucid/segment/extinction_piece.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// N rays at once, each in a lane of its own, from isosurface to isosurface of data without medium.
///
/// A ray knows between which values its data are (SurfaceLanes); where they leave that range is a
/// surface. Where binary32 cannot tell, or what a surface costs is more than the tolerance, the
/// ray's error is infinite: it is for the general path.
template <int N>
class SurfacePacket {
 public:
  static constexpr int lane_count = N;
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  using Workspace = SpanWorkspace<N>;

  /// Prepares for rays first … first + count - 1 of the job, count <= N.
  SurfacePacket(const PellucidPacketJob& job, const PacketGrid& grid, Workspace& workspace,
                int first, int count) noexcept
      : job_(job),
        grid_(grid),
        light_(*seen(job.light)),
        workspace_(workspace),
        first_(first),
        count_(count),
        blocks_(grid, job.rays + first, count),
        finder_(grid, blocks_, *seen(job.transfer), true),
        gradients_(grid, light_),
        to_eye_(direction_to_eye(light_, blocks_)),
        surfaces_(seen(job.surfaces), light_, job.largest_color),
        place_error_(span_end_errors<N>(job, first, count)) {
    for (PellucidHalfOpacity& half : half_) {
      half = {0, std::numeric_limits<double>::infinity(), 0};
    }
  }

  void run() noexcept {
    while (any(blocks_.alive)) {
      blocks_.find(workspace_.stretches, skipped_, stretches_ahead);
      with_value_type(grid_.type, [this](auto value) noexcept {
        finder_.template find<decltype(value)>(workspace_.stretches, workspace_.walks,
                                               workspace_.rows, cells_seen_);
      });
      queue_.begin(workspace_.rows);
      for (take_spans(); any(pending_); take_spans()) follow(pending_);
    }
  }

  void store(PellucidRayResult* results) const noexcept {
    const SegmentResult<D> all = compositor_.result();
    for (int l = 0; l < count_; ++l) {
      PellucidRayResult& r = results[first_ + l];
      r = light_of_lane(all, l);
      r.cells = r.evaluations = cells_seen_[l];
      r.skipped = skipped_[l];
      r.closed = met_[l];
      r.half = half_[l];
      r.optical_depth = -__builtin_log1p(-r.opacity);
      // Costs are added in float; folding in double costs next to nothing.
      r.error = static_cast<double>(error_[l]) * (1 + 1e-5) + 1e-12 * job_.largest_color;
      if (failed_[l] || !(r.error <= job_.tolerance)) r.status = pellucid_left;
    }
  }

 private:
  /// Number of stretches of a ray that are traversed at a time: behind an opaque surface all is
  /// wasted.
  static constexpr int stretches_ahead = 1;
  static constexpr float margin = SurfaceLanes<N>::margin;

  [[gnu::flatten]] void take_spans() noexcept {
    using Rows = SpanRows<N>;
    F row[Rows::fields];
    const M lanes = queue_.take(!pending_, workspace_.rows, row);
    if (none(lanes)) return;
    pending_ = pending_ | lanes;
    for (int k = 0; k < 4; ++k) data_.b[k] = select(lanes, row[k], data_.b[k]);
    length_ = select(lanes, row[5], length_);
    code_ = select(lanes, convert<std::int32_t>(row[7]), code_);
    from_ = select(lanes, F(0), from_);
    close_ = select(lanes, surfaces_.close(data_, row[4], place_error_, row[5]), close_);
    fail(surfaces_.come_to(lanes, data_.b[0], close_));
  }

  M is_inside(F least, F most) const noexcept { return surfaces_.is_inside(least, most, close_); }

  /// Follows the data to where they leave their range, or turn, or the cell ends.
  [[gnu::flatten]] void follow(M on) noexcept {
    const F lower = surfaces_.lower(), upper = surfaces_.upper();
    const MonotonePiece<F> piece = monotone_piece(data_, close_, on);
    const M rising = piece.reach > data_.b[0];
    const F beyond = select(rising, piece.reach - upper, lower - piece.reach);
    const M stays = on & is_inside(piece.reach, piece.reach);
    M crosses = on & (beyond > F(margin) * close_) & surfaces_.is_wide(close_);
    F place = piece.place;
    if (any(crosses)) {
      M open;
      const F at =
          find_crossing(data_, piece, select(rising, upper, lower), rising, close_, crosses, open);
      crosses = crosses & !open;
      place = select(crosses, at, place);
    }
    fail(on & !(crosses | stays));
    if (any(crosses)) {
      meet(crosses, rising, place);
      surfaces_.cross(crosses, rising);
    }
    const CubicBernstein<F> rest = cut(data_, place).back;
    for (int k = 0; k < 4; ++k) data_.b[k] = select(on, rest.b[k], data_.b[k]);
    from_ = select(on, from_ + (F(1) - from_) * place, from_);
    const M over = on & ((place >= F(1)) | is_inside(rest.hull_min(), rest.hull_max()));
    pending_ = pending_ & !over;
  }

  /// Puts the surfaces that the lanes have come to behind what is in front of them.
  [[gnu::noinline]] void meet(M lanes, M rising, F place) noexcept {
    const F ahead = F(1) - from_;
    const F u = min(from_ + ahead * place, F(1));
    const F u_error = min(ahead * crossing_error(data_, place, F(2) * close_) + F(1e-6f), F(1));
    CellPositions<N> places;
    if (surfaces_.is_lit() || job_.depth != 0) {
      places = span_places(grid_, blocks_, workspace_.stretches, lanes, code_);
    }
    GradientStretch<F> along;
    along.to_eye = to_eye_;
    if (surfaces_.is_lit()) {
      CubicBernstein<F> magnitude;
      gradients_(lanes, places, along.component, magnitude);
      if (light_.points > 0) {
        const Vec3<D> in_cell = places.entry + (places.exit - places.entry) * convert<double>(u);
        along.middle = place_in_world(grid_, light_, places.cell, in_cell);
      }
    }
    const auto [opacity, depth, color, error] = surfaces_.meet(rising, along, u, u_error, length_);
    if (job_.depth != 0) {
      note_depth(lanes & (opacity >= F(1)) & (u_error < F(1e-3f)),
                 places.begin + convert<double>(u) * places.length);
    }
    const F before = convert<float>(compositor_.transparency());
    error_ += select(lanes, before * opacity * error, F(0));
    const D a = select(lanes, convert<double>(opacity), D(0));
    const auto masked = [&](F x) noexcept { return select(lanes, convert<double>(x), D(0)); };
    compositor_.add(SegmentResult<D>{
        D(0), a, D(1) - a, {a * masked(color.r), a * masked(color.g), a * masked(color.b)}});
    met_ += select(lanes, I(1), I(0));
    // What is behind them no longer matters.
    const F rest =
        convert<float>(compositor_.transparency()) * F(static_cast<float>(job_.largest_color));
    const M done = lanes & (rest <= F(0.125f) * F(static_cast<float>(job_.tolerance)));
    error_ += select(done, rest, F(0));
    end_rays(done);
  }

  /// An opaque surface in front of all others is where half of the opacity is reached.
  void note_depth(M lanes, D at) noexcept {
    for (unsigned left = bits(lanes & (met_ < I(1))); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      half_[l].begin = half_[l].end = job_.rays[first_ + l].begin + at[l];
    }
  }

  /// The lanes' rays are not for binary32.
  void fail(M lanes) noexcept {
    if (none(lanes)) return;
    failed_ = failed_ | lanes;
    end_rays(lanes);
  }
  void end_rays(M lanes) noexcept {
    pending_ = pending_ & !lanes;
    queue_.drop(lanes);
    blocks_.alive = blocks_.alive & !lanes;
  }

  const PellucidPacketJob& job_;
  const PacketGrid& grid_;
  const PacketLight& light_;
  Workspace& workspace_;
  int first_, count_;
  BlockMarch<N> blocks_;
  SpanFinder<N> finder_;
  GradientLoads<N> gradients_;
  SpanQueue<N> queue_;
  Vec3<F> to_eye_;
  SurfaceLanes<N> surfaces_;
  F place_error_;  ///< how far spans' ends may be from where they are thought to be, world length

  M pending_{false};

  // The span that a lane works on.
  CubicBernstein<F> data_;  ///< of what is left of it
  F close_;                 ///< what the data may be off by
  F from_;                  ///< the share of the cell that is done
  F length_;                ///< of the cell, world length
  I code_;

  FrontToBackCompositor<D> compositor_;
  F error_{0};
  M failed_{false};  ///< whether a lane's ray is left
  PellucidHalfOpacity half_[N];
  std::int32_t cells_seen_[N] = {};
  I skipped_{0}, met_{0};
};

}  // namespace pellucid
#endif
