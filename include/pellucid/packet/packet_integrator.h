// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/budget.h"
#include "pellucid/error/random_errors.h"
#include "pellucid/packet/cell_march.h"
#include "pellucid/packet/smooth_march.h"
#include "pellucid/segment/extinction_piece.h"
#include "pellucid/segment/fold.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Integrates N rays at once, each in a lane of its own and within its own tolerance. What a ray
/// becomes depends on no other lane; on N within its tolerance only, for 4 lanes do not fuse.
///
/// A lane walks from block to block and from cell to cell until it meets data that absorb: its
/// span. Spans are worked on together, when half of the lanes have one, piece by piece: each is cut
/// where the extinction has a corner (segment/extinction_piece.h), and halved where the budget
/// cannot pay for its color. What binary32 is not good enough for is handed back, cell by cell.
template <class Value, int N>
class PacketIntegrator {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// Of rays first … first + count - 1 of the job, count <= N.
  PacketIntegrator(const PellucidPacketJob& job, const PacketGrid<Value>& grid, int first,
                   int count) noexcept
      : job_(job),
        transfer_(*static_cast<const BinnedTransfer*>(job.transfer)),
        first_(first),
        count_(count),
        blocks_(grid, job.rays + first, count),
        cells_(grid, blocks_),
        smooth_(job, grid, blocks_.origin, blocks_.direction),
        budget_(F(static_cast<float>(job.tolerance * (1 - kept_back))),
                convert<float>(blocks_.end)),
        largest_color_(static_cast<float>(job.largest_color)) {
    float far[N];
    for (int l = 0; l < N; ++l) {
      // Where the ray meets the planes is known to a few units of its arc length.
      const PellucidRay& ray = job.rays[first + (l < count ? l : 0)];
      far[l] = static_cast<float>(8 * rounding_unit<double> * ray.end);
    }
    place_error_ = F::load(far);
    if (!static_cast<const SmoothBlocks*>(job.smooth)->any) {
      blocks_.in_cells_until = D(std::numeric_limits<double>::infinity());
    }
  }

  void run() noexcept {
    while (any(blocks_.alive)) {
      const M idle = blocks_.alive & !cells_.walking & !pending_ & !smooth_.walking;
      const M ready = cells_.walking & !pending_;
      const int wait = count(blocks_.alive) / 4;
      if (any(idle) && (count(idle) > wait || none(ready | pending_ | smooth_.walking))) {
        enter_blocks(idle);
        continue;
      }
      if (any(smooth_.walking) &&
          (none(ready | pending_) || 2 * count(smooth_.walking) >= count(blocks_.alive))) {
        step_smooth();
        continue;
      }
      if (any(pending_) && (none(ready) || 2 * count(pending_) >= count(blocks_.alive))) {
        integrate_pieces();
      } else if (any(ready)) {
        step_cells(ready);
      }
    }
  }

  void store(PellucidRayResult* results) const noexcept {
    const SegmentResult<D> all = fold_.result();
    // Folding in double costs 4 u a piece, and adding up costs in float 2 u of them.
    constexpr double folding = 8 * rounding_unit<double>;
    constexpr double account = 2 * static_cast<double>(rounding_unit<float>);
    const D pieces = convert<double>(pieces_ + strides_) + D(1);
    const D error =
        convert<double>(budget_.spent() + rest_behind()) * (D(1) + D(account) * pieces) +
        D(folding * job_.largest_color) * pieces;
    for (int l = 0; l < count_; ++l) {
      PellucidRayResult& r = results[first_ + l];
      r = {{all.radiance.r[l], all.radiance.g[l], all.radiance.b[l]},
           all.opacity[l],
           all.optical_depth[l],
           error[l],
           cells_seen_[l],
           cells_seen_[l] + samples_taken_[l],
           skipped_[l],
           constant_[l],
           pieces_[l] - panels_[l],
           panels_[l],
           in_double_[l],
           strides_[l],
           static_cast<std::uint8_t>(bits(proved_) >> l & 1)};
    }
  }

 private:
  /// The share of the tolerance that pays for adding up costs in float: of 16000 pieces.
  static constexpr double kept_back = 0x1p-9;
  /// How narrow a part of a cell may get before it is handed back.
  static constexpr float narrowest = 1.0f / 16;
  /// Of the difference of two rules what counts as the standard deviation of the better one.
  static constexpr float share_of_difference = 1.0f / 3;
  /// After so many pieces and halvings what is left of a cell is handed back if it is not taken.
  static constexpr int most_pieces = 64;

  [[gnu::flatten]] void enter_blocks(M idle) noexcept {
    blocks_.to_next(idle, skipped_);
    M here = idle & blocks_.alive;
    const M wavy = blocks_.kind == I(static_cast<int>(BlockKind::wavy));
    const M smooth = here & (wavy | (blocks_.kind == I(static_cast<int>(BlockKind::smooth))));
    if (any(smooth)) {
      smooth_.enter(smooth, wavy, blocks_.begin, blocks_.next);
      here = here & !smooth;
    }
    const M constant = here & (blocks_.kind == I(static_cast<int>(BlockKind::constant)));
    cells_.enter(here, blocks_);
    left_behind_block_begin_ =
        select(here, convert<float>(blocks_.end - blocks_.begin), left_behind_block_begin_);
    // Not of types that binary32 rounds: the function may be steep there.
    constexpr bool exact = std::is_same_v<Value, float> || sizeof(Value) < sizeof(float);
    if (exact && any(constant)) begin_constant(constant & cells_.walking);
  }

  /// Four steps through smooth blocks, where the budget can pay for their error.
  [[gnu::flatten]] void step_smooth() noexcept {
    const M on = smooth_.walking;
    const D from = smooth_.at;
    const typename SmoothMarch<Value, N>::Steps steps = smooth_.look();
    samples_taken_ += select(on, I(4), I(0));
    const SegmentResult<F>& s = steps.found.segment;
    const F left = convert<float>(blocks_.end - from);
    const F transparency = convert<float>(fold_.transparency());
    const F deviation = F(share_of_difference) * steps.found.difference;
    const F variance = transparency * transparency * (deviation * deviation + steps.least_variance);
    const F share = F(0.5f) * (s.opacity + min(steps.length / left, F(1)));
    const F rounding = transparency * (F(32 * rounding_unit<float>) * s.opacity * largest_color_ +
                                       F(static_cast<float>(job_.sample_rounding)) * steps.length);
    const F largest = random_.largest(budget_.left() - rounding, share);
    const M take = on & steps.valid & (variance <= largest) & (rounding <= budget_.left());
    const M refused = smooth_.finer(on & !take);
    if (any(refused)) {
      blocks_.go_back(refused, from, smooth_.end);
      smooth_.walking = smooth_.walking & !refused;
    }
    if (none(take)) return;
    const D opacity = masked(take, s.opacity);
    fold_.add(SegmentResult<D>{
        masked(take, s.optical_depth),
        opacity,
        select(take, convert<double>(s.transparency), D(1)),
        {masked(take, s.radiance.r), masked(take, s.radiance.g), masked(take, s.radiance.b)}});
    const F cost = random_.charge(variance) + rounding;
    random_.add(select(take, variance, F(0)));
    budget_.pass_to(select(take, left, budget_.length_left()));
    budget_.spend(select(take, steps.length, F(0)), s.opacity, transparency,
                  select(take, cost / transparency, F(0)));
    smooth_.take(take, steps, variance <= F(0.05f) * largest);
    strides_ += select(take, I(1), I(0));
    proved_ = proved_ & !take;
    retire();
  }

  /// Takes blocks of one material as one span: that of any value in the block, so of the one at its
  /// first corner, as binary32 has it. Beside a jump, which may lie between a value and its
  /// rounding, they are gone through; and where the tolerance does not allow for rounding.
  void begin_constant(M lanes) noexcept {
    cells_.step(M(false), step_);  // looks, and does not go on
    const F value = step_.corners.value[0];
    if (transfer_.has_marks) {
      const F rounding = F(2 * rounding_unit<float>) * abs(value);
      lanes = lanes & (marks_in(value - rounding, value + rounding) < jump());
    }
    step_.end = cells_.block_length;
    begin_span(lanes, step_, F(0), cells_.block_length);
    for (F& b : data_.b) b = select(lanes, value, b);
    rounding_ = select(lanes, F(4 * rounding_unit<float>) * abs(value), rounding_);
    whole_block_ = whole_block_ | lanes;
    cells_.walking = cells_.walking & !lanes;
    constant_ += select(lanes, I(1), I(0));
  }

  /// The marks of the transfer function over a range of values.
  I marks_in(F least, F most) const noexcept {
    return gather(transfer_.marks, bin_of(transfer_, most) + I(1)) -
           gather(transfer_.marks, bin_of(transfer_, least));
  }
  static I jump() noexcept { return I(BinnedTransfer::one_jump); }

  [[gnu::flatten]] void step_cells(M ready) noexcept {
    typename CellMarch<Value, N>::Step& step = step_;
    cells_.step(ready, step);
    cells_seen_ += select(ready, I(1), I(0));
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
    M hand_back_at_once(false);
    if (transfer_.has_marks) {
      const I marks = marks_in(least, most);
      found = found & (marks > I(0));
      hand_back_at_once = found & (marks >= jump());
    } else {
      found = found & (most >= F(transfer_.support_min)) & (least <= F(transfer_.support_max));
    }
    if (none(found)) return;
    begin_span(found, step, step.begin, step.end - step.begin);
    for (int k = 0; k < 4; ++k) data_.b[k] = select(found, data.b[k], data_.b[k]);
    rounding_ = select(found, rounding, rounding_);
    handed_back_ = handed_back_ | hand_back_at_once;
  }

  void begin_span(M lanes, const typename CellMarch<Value, N>::Step& step, F begin,
                  F length) noexcept {
    pending_ = pending_ | lanes;
    located_ = located_ & !lanes;
    whole_block_ = whole_block_ & !lanes;
    length_ = select(lanes, length, length_);
    begin_ = select(lanes, begin, begin_);
    span_length_ = select(lanes, length, span_length_);
    last_of_block_ = select(lanes, step.end >= cells_.block_length, last_of_block_);
    from_ = select(lanes, F(0), from_);
    cap_ = select(lanes, F(1), cap_);
    pieces_of_span_ = select(lanes, I(0), pieces_of_span_);
    rounding_ = select(lanes, F(0), rounding_);
    for (int a = 0; a < 3; ++a) cell_[a] = select(lanes, step.cell[a], cell_[a]);
  }

  [[gnu::flatten]] void integrate_pieces() noexcept {
    if (any(handed_back_)) {
      hand_back(handed_back_);
      handed_back_ = M(false);
      if (none(pending_)) return;
    }
    const M on = pending_;
    const M lost =
        on & !located_ & ((data_.b[0] < extinction_.lower) | (data_.b[0] >= extinction_.upper));
    if (any(lost)) extinction_ = find_extinction(transfer_, data_.b[0], lost, interval_);
    const ExtinctionInterval<F>& interval = extinction_;
    located_ = located_ | on;
    pieces_of_span_ += select(on, I(1), I(0));
    const F close = F(0.25f) * rounding_;
    const PieceEnd<F> end = piece_end(data_, interval.lower, interval.upper, close, on);
    const M capped = cap_ < end.place;
    const F place = min(end.place, cap_);
    const M crosses = end.crosses & !capped;
    CutCubic<F> parts{data_, data_};
    if (any(on & (place < F(1)))) {
      parts = cut(data_, place);
      const F limit = select(end.rising, interval.upper, interval.lower);
      parts.front.b[3] = select(crosses, limit, parts.front.b[3]);
      parts.back.b[0] = select(crosses, limit, parts.back.b[0]);
    }
    const F length = length_ * place;
    const BoundedSegment<F> piece = extinction_piece(parts.front, interval, length, transfer_);
    const SegmentResult<F>& s = piece.segment;

    // What rounding can do, as in segment/rounding.h.
    constexpr float u = rounding_unit<float>;
    const F value_error = rounding_ + close;
    // The slope of the next interval counts for as much of the piece as is near to it: where the
    // data rise throughout, no more than 2 value_error over their least slope.
    const CubicBernstein<F>& f = parts.front;
    const M touches = (f.hull_min() - value_error < interval.lower) |
                      (f.hull_max() + value_error > interval.upper) | crosses;
    const F d0 = f.b[1] - f.b[0], d1 = f.b[2] - f.b[1], d2 = f.b[3] - f.b[2];
    const F least_slope = F(3) * max(min(d0, min(d1, d2)), -max(d0, max(d1, d2)));
    const F near = select(least_slope > F(2) * value_error, F(2) * value_error / least_slope, F(1));
    const F slope = abs(interval.slope);
    const F steep = select(touches, slope + near * (interval.steepest - slope), slope);
    const F depth_error = length * (value_error * steep + F(8 * u) * interval.largest) +
                          place_error() * (length / span_length_) * interval.largest;
    const F color_rounding =
        F(32 * u) * largest_color_ + min(value_error * interval.color_slope, largest_color_);
    const F opacity_rounding =
        F(32 * u) * s.opacity +
        min(select(depth_error <= F(1), F(2) * depth_error * s.transparency, F(1)), F(1));
    const F rounding = s.opacity * color_rounding + largest_color_ * opacity_rounding;
    const F error = piece.color_error + rounding;

    budget_.pass_to(select(on, left_behind_block_begin_ - begin_ - from_ * span_length_,
                           budget_.length_left()));
    const F transparency = convert<float>(fold_.transparency());
    const F allowance = budget_.allowance(length, s.opacity, transparency);
    const M take = on & end.found & (error <= allowance);
    const M restart = on & !take & whole_block_;
    pending_ = pending_ & !restart;
    cells_.walking = cells_.walking | restart;
    const M rest = on & !take & !restart;
    if (any(rest)) {
      const F half = F(0.5f) * place;
      const F part = (F(1) - from_) * half;  // of the cell
      // Halving makes it at most four times better, and the half of a half sixteen times.
      const M halve = rest & end.found & (pieces_of_span_ < I(most_pieces)) &
                      (part >= F(narrowest)) & (piece.color_error <= F(64) * allowance) &
                      (rounding <= F(0.25f) * allowance);
      cap_ = select(halve, half, cap_);
      const M give_up = rest & !halve;
      if (any(give_up)) hand_back(give_up);
    }
    if (none(take)) return;
    const D opacity = masked(take, s.opacity);
    fold_.add(SegmentResult<D>{
        masked(take, s.optical_depth),
        opacity,
        select(take, convert<double>(s.transparency), D(1)),
        {masked(take, s.radiance.r), masked(take, s.radiance.g), masked(take, s.radiance.b)}});
    budget_.spend(select(take, length, F(0)), s.opacity, transparency, select(take, error, F(0)));
    pieces_ += select(take, I(1), I(0));

    const F left = F(1) - place;
    for (int k = 0; k < 4; ++k) data_.b[k] = select(take, parts.back.b[k], data_.b[k]);
    length_ = select(take, length_ * left, length_);
    from_ = select(take, from_ + (F(1) - from_) * place, from_);
    cap_ = select(take, select(capped & (place < left), place / left, F(1)), cap_);
    const M crossed = take & crosses;
    if (any(crossed)) {
      interval_ += select(crossed, select(end.rising, I(1), I(-1)), I(0));
      extinction_ = load_extinction<F>(transfer_, interval_);
    }
    const M clear = (parts.back.hull_max() + rounding_ < F(transfer_.support_min)) |
                    (parts.back.hull_min() - rounding_ > F(transfer_.support_max));
    pending_ = pending_ & !(take & ((place >= F(1)) | clear));
    retire();
  }

  /// Ends the rays that no longer matter.
  void retire() noexcept {
    const M done = blocks_.alive & (rest_behind() <= budget_.left());
    blocks_.alive = blocks_.alive & !done;
    cells_.walking = cells_.walking & !done;
    pending_ = pending_ & !done;
    smooth_.walking = smooth_.walking & !done;
    cut_off_ = cut_off_ | done;
  }

  /// A bound on what lies behind the last piece, as little as light can come from there; nothing
  /// behind rays that went to their end.
  F rest_behind() const noexcept {
    const F opacity = min(F(transfer_.largest_extinction) * budget_.length_left(), F(1));
    const F rest = convert<float>(fold_.transparency()) * opacity * largest_color_;
    return select(blocks_.alive | cut_off_, rest, F(0));
  }

  /// How far a span's ends may be from where they are thought to be, world length. Where cells meet
  /// is known to binary32 only, but what one has too much the other has too little, of data that
  /// are the same there; the end of a block is rounded for good.
  F place_error() const noexcept {
    return place_error_ +
           select(last_of_block_, F(2 * rounding_unit<float>) * cells_.block_length, F(0));
  }

  D masked(M mask, F value) const noexcept { return select(mask, convert<double>(value), D(0)); }

  /// Has what is left of the lanes' spans integrated by other means.
  void hand_back(M lanes) noexcept {
    lanes = lanes & pending_;
    const F transparency = convert<float>(fold_.transparency());
    budget_.pass_to(select(lanes, left_behind_block_begin_ - begin_ - from_ * span_length_,
                           budget_.length_left()));
    const F flat = budget_.allowance(length_, F(0), transparency),
            all = budget_.allowance(length_, F(1), transparency);
    double depth[N] = {}, opacity[N] = {}, through[N], red[N] = {}, green[N] = {}, blue[N] = {},
           error[N] = {}, bound[N] = {};
    unsigned not_proved = 0, with_panels = 0;
    for (int l = 0; l < N; ++l) {
      through[l] = 1;
      if ((bits(lanes) >> l & 1) == 0) continue;
      PellucidCell cell;
      for (int a = 0; a < 3; ++a) {
        cell.cell[a] = blocks_.block[a][l] * block_width + cell_[a][l];
      }
      cell.from = static_cast<double>(from_[l]);
      cell.place_error = static_cast<double>(place_error_[l]);
      cell.allowance_flat = static_cast<double>(flat[l]);
      cell.allowance_per_opacity = static_cast<double>(all[l] - flat[l]);
      PellucidCellResult result;
      job_.integrate_cell(job_.context, first_ + l, &cell, &result);
      depth[l] = result.optical_depth;
      opacity[l] = result.opacity;
      through[l] = result.transparency;
      red[l] = result.radiance[0];
      green[l] = result.radiance[1];
      blue[l] = result.radiance[2];
      error[l] = result.error;
      bound[l] = result.opacity_bound;
      if (result.proved == 0) not_proved |= 1u << l;
      if (result.panels != 0) with_panels |= 1u << l;
    }
    fold_.add(SegmentResult<D>{D::load(depth),
                               D::load(opacity),
                               D::load(through),
                               {D::load(red), D::load(green), D::load(blue)}});
    budget_.spend(select(lanes, length_, F(0)), convert<float>(D::load(bound)), transparency,
                  convert<float>(D::load(error)) * F(1 + 4 * rounding_unit<float>));
    proved_ = proved_ & !M::from_bits(not_proved);
    pieces_ += select(lanes, I(1), I(0));
    in_double_ += select(lanes, I(1), I(0));
    panels_ += select(M::from_bits(with_panels), I(1), I(0));
    pending_ = pending_ & !lanes;
    retire();
  }

  const PellucidPacketJob& job_;
  const BinnedTransfer& transfer_;
  int first_, count_;
  BlockMarch<Value, N> blocks_;
  CellMarch<Value, N> cells_;
  SmoothMarch<Value, N> smooth_;

  typename CellMarch<Value, N>::Step step_;

  // The span that a lane has met.
  M pending_{false};
  M handed_back_{false};  ///< those of them that are not for the rule here
  M whole_block_{false};  ///< of one material
  M last_of_block_{false};
  M located_{false};  ///< whether `interval_` is known
  CubicBernstein<F> data_;
  F left_behind_block_begin_;         ///< of the ray, world length
  F length_;                          ///< world length of what is left of it
  F begin_, span_length_;             ///< of all of it, from the block's entry
  F from_;                            ///< the share that is done
  F cap_;                             ///< the most that the next piece may be of what is left
  F rounding_;                        ///< of the data
  F place_error_;                     ///< world length
  ExtinctionInterval<F> extinction_;  ///< that of `interval_`
  I interval_, pieces_of_span_, cell_[3];

  RayBudget<F> budget_;
  RandomErrors<F> random_;
  FrontToBack<D> fold_;
  F largest_color_;
  M proved_{true}, cut_off_{false};
  I cells_seen_, skipped_, constant_;
  I pieces_;  ///< all of them
  I in_double_, panels_;
  I strides_, samples_taken_;
};

}  // namespace pellucid
#endif
