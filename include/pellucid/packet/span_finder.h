// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/cell_march.h"
#include "pellucid/transfer/binned.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Spans that absorb, as rows of floats: eight of each, those of a stretch one behind the other.
template <class Value, int N>
struct SpanRows {
  static constexpr int fields = 8;
  /// A ray crosses at most 22 cells of a block; the row behind the last one is written to.
  static constexpr int of_a_stretch = 24;

  /// Data b0 … b3; their rounding; world length; of the ray from its begin on; SpanCode.
  float row[(Stretches<Value, N>::most + 1) * of_a_stretch * fields];

  // Per ray, the stretches that have spans: where their rows begin and end.
  int stretches[N];
  std::int32_t first[N][Stretches<Value, N>::of_a_ray], end[N][Stretches<Value, N>::of_a_ray];
};

/// What else is known of a span, in a whole number that a float holds exactly: the sum of these.
struct SpanCode {
  static constexpr int cell[3] = {1, 8, 64};  ///< times its place in the block
  static constexpr int last = 512;            ///< of the stretch
  static constexpr int handed_back = 1024;    ///< not for the packets' rule
  static constexpr int whole_block = 2048;    ///< of one material
  static constexpr int stretch = 4096;        ///< times its number, of 8 bits
};

/// Finds what of rays' stretches absorbs: from cell to cell, their range and then the hull of the
/// data along the ray against the marks of the transfer function.
template <class Value, int N>
class SpanFinder {
 public:
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using All = Stretches<Value, N>;
  using Rows = SpanRows<Value, N>;

  SpanFinder(const PacketGrid<Value>& grid, const BlockMarch<Value, N>& rays,
             const BinnedTransfer& transfer) noexcept
      : transfer_(transfer), cells_(grid, rays) {}

  /// Adds to `cells` those looked at, per ray.
  void find(All& stretches, Rows& rows, std::int32_t* cells) noexcept {
    cells_.begin(stretches);
    take_constant(stretches, rows);
    row_ = I(All::most * Rows::of_a_stretch);
    seen_ = I(0);
    while (take(stretches)) step_cells(rows);
    list(stretches, rows, cells);
  }

 private:
  /// The marks of the transfer function over a range of values.
  I marks_in(F least, F most) const noexcept {
    return gather(transfer_.marks, bin_of(transfer_, most) + I(1)) -
           gather(transfer_.marks, bin_of(transfer_, least));
  }
  static I jump() noexcept { return I(BinnedTransfer::one_jump); }

  /// Takes blocks of one material as one span: that of any value in the block, so of the one at its
  /// first corner, as binary32 has it. Beside a jump, which may lie between a value and its
  /// rounding, they are gone through, and of types that binary32 rounds: the function may be steep
  /// there.
  void take_constant(All& stretches, Rows& rows) noexcept {
    constexpr bool exact = std::is_same_v<Value, float> || sizeof(Value) < sizeof(float);
    for (int first = 0; first < stretches.count; first += N) {
      M lanes = I::load(stretches.constant + first) > I(0);
      if (none(lanes)) continue;
      const F value = cells_.first_values(stretches, first);
      lanes = lanes & M(exact);
      if (transfer_.has_marks) {
        const F rounding = F(2 * rounding_unit<float>) * abs(value);
        lanes = lanes & (marks_in(value - rounding, value + rounding) < jump());
      }
      select(lanes, I(1), I(0)).store(stretches.constant + first);
      std::int32_t number[N];
      for (int l = 0; l < N; ++l) number[l] = lanes[l] ? first + l : All::most;
      const I stretch = I::load(number);
      const F code = convert<float>(stretch) * F(SpanCode::stretch) +
                     F(SpanCode::whole_block + SpanCode::last);
      const F span[] = {value,
                        value,
                        value,
                        value,
                        F(4 * rounding_unit<float>) * abs(value),
                        F::load(stretches.length + first),
                        F::load(stretches.left + first),
                        code};
      store_records<Rows::fields>(span, rows.row, stretch * I(Rows::of_a_stretch));
    }
  }

  /// Whether there is anything left to be gone through.
  [[gnu::flatten]] bool take(All& stretches) noexcept {
    if (!cells_.wants(stretches)) return any(cells_.walking);
    do {
      note(stretches);
      const M begun = cells_.take(stretches);
      row_ = select(begun, cells_.stretch * I(Rows::of_a_stretch), row_);
      seen_ = select(begun, I(0), seen_);
    } while (cells_.wants(stretches));
    return any(cells_.walking);
  }

  [[gnu::flatten]] void step_cells(Rows& rows) noexcept {
    typename CellMarch<Value, N>::Step& step = step_;
    const M ready = cells_.walking;
    cells_.step(step);
    seen_ += select(ready, I(1), I(0));
    const F* v = step.corners.value;
    F lower = v[0], upper = v[0];
    for (int n = 1; n < 8; ++n) {
      lower = min(lower, v[n]);
      upper = max(upper, v[n]);
    }
    M found = ready & (upper >= F(transfer_.support_min)) & (lower <= F(transfer_.support_max)) &
              (step.end > step.begin);
    if constexpr (!std::is_integral_v<Value>) {
      F sum = v[0];
      for (int n = 1; n < 8; ++n) sum += v[n];
      found = found & !is_nan(sum);  // vacuum
    }
    if (none(found)) return;
    // Of the values' differences from one of them: what is rounded is their range, and the value
    // itself only at the end and in cuts. A place is off by 16 u of a cell along each axis.
    CellCorners<F> differences;
    for (int n = 0; n < 8; ++n) differences.value[n] = v[n] - v[0];
    CubicBernstein<F> data =
        trilinear_cubic(differences, cells_.place(step, step.begin), cells_.place(step, step.end));
    for (F& b : data.b) b += v[0];
    constexpr float u = rounding_unit<float>;
    const F rounding = F(8 * u) * max(abs(lower), abs(upper)) + F(80 * u) * (upper - lower);
    const F least = data.hull_min() - rounding, most = data.hull_max() + rounding;
    F code = convert<float>(cells_.stretch) * F(SpanCode::stretch) +
             select(step.last, F(SpanCode::last), F(0));
    for (int a = 0; a < 3; ++a) code += F(SpanCode::cell[a]) * step.cell[a];
    if (transfer_.has_marks) {
      const I marks = marks_in(least, most);
      found = found & (marks > I(0));
      code += select(marks >= jump(), F(SpanCode::handed_back), F(0));
    } else {
      found = found & (most >= F(transfer_.support_min)) & (least <= F(transfer_.support_max));
    }
    if (none(found)) return;
    const F span[] = {data.b[0],
                      data.b[1],
                      data.b[2],
                      data.b[3],
                      rounding,
                      step.end - step.begin,
                      cells_.ray_left - step.begin,
                      code};
    // Of lanes that found nothing too: behind their last row.
    store_records<Rows::fields>(span, rows.row, row_);
    row_ += select(found, I(1), I(0));
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
      const int spans = stretches.constant[i] != 0 ? 1 : stretches.spans[i];
      if (spans == 0) continue;
      int& n = rows.stretches[ray];
      rows.first[ray][n] = i * Rows::of_a_stretch;
      rows.end[ray][n] = i * Rows::of_a_stretch + spans;
      ++n;
    }
  }

  const BinnedTransfer& transfer_;
  CellMarch<Value, N> cells_;
  typename CellMarch<Value, N>::Step step_;
  I row_;   ///< that each lane's next span goes to
  I seen_;  ///< cells of the lane's stretch
};

}  // namespace pellucid
#endif
