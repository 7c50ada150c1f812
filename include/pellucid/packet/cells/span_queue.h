// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cells/cell_positions.h"
#include "pellucid/packet/cells/span_finder.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Workspace in which the spans of packets are found, one packet after the other.
template <int N>
struct SpanWorkspace {
  BlockIntervals<N> stretches;
  BlockSegments<N> walks;
  SpanRows<N> rows;
};

/// Returns the errors of spans' ends of rays first … first + count - 1: the crossings of a ray and
/// the planes are known to a few units of its arc length.
template <int N>
Batch<float, N> span_end_errors(const PellucidPacketJob& job, int first, int count) noexcept {
  float far[N];
  for (int l = 0; l < N; ++l) {
    const PellucidRay& ray = job.rays[first + (l < count ? l : 0)];
    far[l] = static_cast<float>(8 * rounding_unit<double> * ray.end);
  }
  return Batch<float, N>::load(far);
}

/// Returns the positions at which the lanes' own rays cross the cells of spans.
template <int N>
CellPositions<N> span_places(const PacketGrid& grid, const BlockMarch<N>& rays,
                             const BlockIntervals<N>& stretches, BatchMask<N> lanes,
                             Batch<std::int32_t, N> code) noexcept {
  using I = Batch<std::int32_t, N>;
  code = select(lanes, code, I(0));
  I in_block[3];
  for (int a = 0; a < 3; ++a) in_block[a] = PackedSpanInfo::place_in_block(code, a);
  return cell_places(grid, rays, stretches, PackedSpanInfo::stretch_of(code), in_block);
}

/// The spans that were found of rays and are not taken yet, for each lane those of its own ray.
template <int N>
class SpanQueue {
 public:
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using Rows = SpanRows<N>;

  SpanQueue() noexcept {
    std::int32_t lane[N];
    for (int l = 0; l < N; ++l) lane[l] = l;
    lane_ = I::load(lane);
  }

  /// Begins with what a SpanFinder has found.
  void begin(const Rows& rows) noexcept {
    stretches_ = I::load(rows.stretches);
    stretch_of_ray_ = row_ = end_row_ = I(0);
  }

  /// Gives the wanted lanes the next span of their ray, and returns those that have got one.
  M take(M wanted, const Rows& rows, F (&row)[Rows::fields]) noexcept {
    const M over = wanted & (row_ >= end_row_) & (stretch_of_ray_ < stretches_);
    if (any(over)) {
      const I at = select(over, lane_ * I(BlockIntervals<N>::of_a_ray) + stretch_of_ray_, I(0));
      row_ = select(over, gather(rows.first[0], at), row_);
      end_row_ = select(over, gather(rows.end[0], at), end_row_);
      stretch_of_ray_ += select(over, I(1), I(0));
    }
    const M lanes = wanted & (row_ < end_row_);
    if (none(lanes)) return lanes;
    load_records<Rows::fields>(rows.row, select(lanes, row_, I(0)), row);
    row_ += select(lanes, I(1), I(0));
    return lanes;
  }

  /// Gives up what is left of the lanes' rays.
  void drop(M lanes) noexcept {
    row_ = select(lanes, end_row_, row_);
    stretches_ = select(lanes, I(0), stretches_);
  }

 private:
  I lane_;
  I stretch_of_ray_, stretches_;  ///< with spans: the next one, and how many there are
  I row_, end_row_;               ///< of the stretch in front of it
};

}  // namespace pellucid
#endif
