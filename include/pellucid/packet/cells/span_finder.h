// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/blocks/block_segment_list.h"
#include "pellucid/packet/cells/cell_march.h"
#include "pellucid/transfer/binned.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Spans that absorb, as rows of floats: eight of each, those of a stretch one behind the other.
template <int N>
struct SpanRows {
  static constexpr int fields = 8;
  /// A ray crosses at most 22 cells of a block; the row behind the last one is written to.
  static constexpr int of_a_stretch = 23;

  /// Data b0 … b3; their rounding; world length; of the ray from its begin on; PackedSpanInfo.
  float row[(BlockIntervals<N>::most + 1) * of_a_stretch * fields];

  // Per ray, the stretches that have spans: where their rows begin and end.
  int stretches[N];
  std::int32_t first[N][BlockIntervals<N>::of_a_ray], end[N][BlockIntervals<N>::of_a_ray];
};

/// Places [0,1]³ at which rays enter and leave the cells of spans: of each what SpanRows has in the
/// same row.
template <int N>
struct SpanWays {
  static constexpr int fields = 8;

  /// Entry x, y, z; exit x, y, z; two that are not used.
  float row[(BlockIntervals<N>::most + 1) * SpanRows<N>::of_a_stretch * fields];
};

/// Further facts of a span, in a whole number that a float holds exactly: the sum of these.
struct PackedSpanInfo {
  static constexpr int cell[3] = {1, 8, 64};   ///< times its place in the block
  static constexpr int scalar_fallback = 512;  ///< not for the packets' rule
  static constexpr int whole_block = 1024;     ///< of one material
  static constexpr int in_double = 2048;       ///< not for binary32
  static constexpr int stretch = 4096;         ///< times its number, of 8 bits

  // I: an int, or several.
  template <class I>
  static I place_in_block(I code, int a) noexcept {
    return (code >> 3 * a) & I(7);
  }
  template <class I>
  static I stretch_of(I code) noexcept {
    return code >> 12;
  }
};
static_assert(block_width == 8 && PackedSpanInfo::cell[2] == 1 << 6 &&
              PackedSpanInfo::stretch == 1 << 12);

/// Finds what of rays' stretches absorbs: from cell to cell, their range and then the hull of the
/// data along the ray against the marks of the transfer function.
template <int N>
class SpanFinder {
 public:
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using All = BlockIntervals<N>;
  using Rows = SpanRows<N>;

  /// `lit`: blocks of one material are gone through cell by cell, for light changes in them.
  /// `ways`: where the places of spans are put, if they are wanted.
  SpanFinder(const PacketGrid& grid, const BlockMarch<N>& rays, const BinnedTransfer& transfer,
             bool lit = false, SpanWays<N>* ways = nullptr) noexcept
      : transfer_(transfer), list_(grid, rays), cells_(grid, rays), lit_(lit), ways_(ways) {}

  /// Looks at data of this type. Adds to `cells` those looked at, per ray.
  template <class Value>
  void find(All& stretches, BlockSegments<N>& walks, Rows& rows, std::int32_t* cells) noexcept {
    for (int i = 0; i < stretches.count; ++i) stretches.cells[i] = stretches.spans[i] = 0;
    fill<Value>(stretches, walks, rows);
    cells_.begin();
    row_ = I(All::most * Rows::of_a_stretch);
    seen_ = I(0);
    while (take(walks, stretches)) step_cells<Value>(rows);
    list(stretches, rows, cells);
  }

 private:
  template <class Value>
  [[gnu::flatten]] void fill(All& stretches, BlockSegments<N>& walks, Rows& rows) noexcept {
    list_.template fill<Value>(
        stretches, walks, [&](M lanes, I stretch, F value, F length, F left) noexcept {
          lanes = is_constant<Value>(lanes, value);
          const I number = select(lanes, stretch, I(All::most));
          const F code =
              convert<float>(number) * F(PackedSpanInfo::stretch) + F(PackedSpanInfo::whole_block);
          const F rounding = F(4 * rounding_unit<float>) * abs(value);
          const F span[] = {value, value, value, value, rounding, length, left, code};
          store_records<Rows::fields>(span, rows.row, number * I(Rows::of_a_stretch));
          std::int32_t at[N];
          stretch.store(at);
          for (int l = 0; l < N; ++l) {
            if (lanes[l]) stretches.spans[at[l]] = 1;
          }
          return lanes;
        });
  }

  /// Returns whether blocks of one material are one span: that of any value in the block, so of the
  /// one at its first corner, as binary32 has it. Not beside a jump, which may lie between a value
  /// and its rounding, and not of types that binary32 rounds: the function may be steep there.
  template <class Value>
  M is_constant(M lanes, F value) const noexcept {
    constexpr bool exact = std::is_same_v<Value, float> || sizeof(Value) < sizeof(float);
    if (!exact || lit_) return M(false);
    if (!transfer_.has_marks) return lanes;
    const F rounding = F(2 * rounding_unit<float>) * abs(value);
    return lanes & (marks_between(transfer_, value - rounding, value + rounding) <
                    I(BinnedTransfer::one_jump));
  }

  /// Returns whether there is anything left to be gone through.
  [[gnu::flatten]] bool take(const BlockSegments<N>& walks, All& stretches) noexcept {
    if (cells_.wants(walks)) {
      note(stretches);
      const M begun = cells_.take(walks);
      row_ = select(begun, cells_.stretch * I(Rows::of_a_stretch), row_);
      seen_ = select(begun, I(0), seen_);
    }
    return any(cells_.walking);
  }

  template <class Value>
  [[gnu::flatten]] void step_cells(Rows& rows) noexcept {
    typename CellMarch<N>::Step& step = step_;
    const M ready = cells_.walking;
    cells_.template step<Value>(step);
    seen_ += select(ready, I(1), I(0));
    const F* v = step.corners.value;
    F lower = v[0], upper = v[0];
    for (int n = 1; n < 8; ++n) {
      lower = min(lower, v[n]);
      upper = max(upper, v[n]);
    }
    M found = ready & (upper >= F(transfer_.support_min)) & (lower <= F(transfer_.support_max)) &
              (step.end > step.begin);
    const CellCubic<F> cubic(step.corners, lower, upper, cells_.place(step, step.begin),
                             cells_.place(step, step.end));
    const CubicBernstein<F>& data = cubic.data;
    if constexpr (!std::is_integral_v<Value>) found = found & !is_nan(data.b[0]);
    if (any(found)) put_down(found, data, cubic.rounding, rows);
    const F per_length = F(1) / convert<float>(step.end - step.begin);
    skip(ready, data.b[3], cubic.rounding, F(3) * cubic.last_rise * per_length,
         F(160 * rounding_unit<float>) * cubic.range * per_length);
  }

  /// Puts down what of the lanes' cells is a span.
  void put_down(M found, const CubicBernstein<F>& data, F rounding, Rows& rows) noexcept {
    const typename CellMarch<N>::Step& step = step_;
    const F least = data.hull_min() - rounding, most = data.hull_max() + rounding;
    F code = convert<float>(cells_.stretch) * F(PackedSpanInfo::stretch);
    for (int a = 0; a < 3; ++a) code += F(PackedSpanInfo::cell[a]) * step.cell[a];
    M jumps;
    found = may_absorb(transfer_, found, least, most, jumps);
    if (any(jumps)) {
      const M hard =
          has_unresolved_jump(transfer_, select(jumps, least, F(0)), select(jumps, most, F(0)));
      code += select(jumps,
                     select(hard, F(PackedSpanInfo::scalar_fallback), F(PackedSpanInfo::in_double)),
                     F(0));
    }
    if (none(found)) return;
    const F span[] = {data.b[0],
                      data.b[1],
                      data.b[2],
                      data.b[3],
                      rounding,
                      convert<float>(step.end - step.begin),
                      cells_.ray_left - convert<float>(step.begin),
                      code};
    // Of lanes that found nothing too: behind their last row.
    store_records<Rows::fields>(span, rows.row, row_);
    if (ways_ != nullptr) {
      const Vec3<F> entry = cells_.place_in_cell(step, step.begin);
      const Vec3<F> exit = cells_.place_in_cell(step, step.end);
      const F way[] = {entry.x, entry.y, entry.z, exit.x, exit.y, exit.z, F(0), F(0)};
      store_records<SpanWays<N>::fields>(way, ways_->row, row_);
    }
    row_ += select(found, I(1), I(0));
  }

  /// Skips what of the block cannot absorb for the data's value and slope where the cell ends,
  /// within these roundings. With B a bound on how much the slope can grow, the data at a distance
  /// s are not above value + slope · s + ∫B, B = jump + 2 bend · s or `variation`: they do not
  /// reach what absorbs at a distance of c in front of the smallest s with
  ///
  ///   (slope + jump) s + bend s² = c,  or  (slope + variation) s = c
  void skip(M lanes, F value, F value_rounding, F slope, F slope_rounding) noexcept {
    const F above = value + value_rounding, below = value - value_rounding;
    lanes = lanes & cells_.walking;
    if (transfer_.supports > 1) return skip_in_gaps(lanes, above, below, slope, slope_rounding);
    const F rise = F(transfer_.support_min) - above, fall = below - F(transfer_.support_max);
    lanes = lanes & ((rise > F(0)) | (fall > F(0)));
    if (none(lanes)) return;
    const F towards = select(rise > F(0), slope, -slope);
    cells_.skip(lanes, distance_to(max(rise, fall), towards, slope_rounding));
  }

  /// The same where data between two ranges of values that absorb may rise to the one or fall to
  /// the other.
  void skip_in_gaps(M lanes, F above, F below, F slope, F slope_rounding) noexcept {
    constexpr float far = BinnedTransfer::far;
    F rise(far), fall(far);
    for (int i = 0; i < transfer_.supports; ++i) {
      const F up = F(transfer_.support[2 * i]) - above,
              down = below - F(transfer_.support[2 * i + 1]);
      lanes = lanes & ((up > F(0)) | (down > F(0)));
      rise = select(up > F(0), min(rise, up), rise);
      fall = select(down > F(0), min(fall, down), fall);
    }
    if (none(lanes)) return;
    const F unbounded(std::numeric_limits<float>::infinity());
    const auto reach = [&](F gap, F towards) noexcept {
      return select(gap < F(far), distance_to(gap, towards, slope_rounding), unbounded);
    };
    cells_.skip(lanes, min(reach(rise, slope), reach(fall, -slope)));
  }

  /// Returns a lower bound on the length in which the data move by `gap`, where they move towards
  /// that at this rate; 0 where it is not known, as of a cell without a length.
  F distance_to(F gap, F towards, F slope_rounding) const noexcept {
    constexpr float u = rounding_unit<float>;
    const F size = abs(towards);
    const auto growth = [&](F bound) noexcept {
      return (towards + bound) + (slope_rounding + F(8 * u) * (size + bound));
    };
    const F by_jumps = growth(cells_.jump), by_variation = growth(cells_.variation);
    // Squares may underflow.
    const F root = sqrt(by_jumps * by_jumps + F(4) * cells_.second_difference * gap + F(1e-36f));
    const M away = by_jumps < F(0);
    const F smallest = select(away, root - by_jumps, F(2) * gap) /
                       select(away, F(2) * cells_.second_difference, by_jumps + root);
    constexpr float less = 1 - 32 * u;
    return select(is_nan(by_jumps + by_variation), F(0),
                  F(less) * max(smallest, gap / max(by_variation, F(0))));
  }

  /// Notes what was found in stretches that are gone through.
  void note(All& stretches) noexcept {
    std::int32_t stretch[N], seen[N], row[N];
    cells_.stretch.store(stretch);
    seen_.store(seen);
    row_.store(row);
    for (unsigned left = bits(!cells_.walking); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      stretches.cells[stretch[l]] = seen[l];
      stretches.spans[stretch[l]] = row[l] - stretch[l] * Rows::of_a_stretch;
    }
  }

  [[gnu::noinline]] void list(All& stretches, Rows& rows, std::int32_t* cells) noexcept {
    note(stretches);
    for (int& n : rows.stretches) n = 0;
    for (int i = 0; i < stretches.count; ++i) {
      const int ray = stretches.ray[i];
      cells[ray] += stretches.cells[i];
      const int spans = stretches.spans[i];
      if (spans == 0) continue;
      int& n = rows.stretches[ray];
      rows.first[ray][n] = i * Rows::of_a_stretch;
      rows.end[ray][n] = i * Rows::of_a_stretch + spans;
      ++n;
    }
  }

  const BinnedTransfer& transfer_;
  BlockSegmentList<N> list_;
  CellMarch<N> cells_;
  bool lit_;
  SpanWays<N>* ways_;
  typename CellMarch<N>::Step step_;
  I row_;   ///< that each lane's next span goes to
  I seen_;  ///< cells of the lane's stretch
};

}  // namespace pellucid
#endif
