// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/random_errors.h"
#include "pellucid/packet/sample/sampler_transfer.h"
#include "pellucid/packet/steps/packet_samples.h"
#include "pellucid/segment/sampled.h"
#include "pellucid/traverse/block_classes.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// The lengths of steps for directions of rays in lanes, and the mean squares of what they err
/// because of bends along each axis: for packets one after the other, which mostly share theirs.
template <int N>
struct StepTable {
  static constexpr int max_levels = max_sampled_step_levels;

  double direction[3][N];
  int levels = 0;  ///< those that are known
  Batch<float, N> step[max_levels], weight[max_levels][3];

  /// Keeps what is known for these directions, if they are the same.
  void begin(const double (&directions)[3][N]) noexcept {
    bool same = levels > 0;
    for (int a = 0; a < 3; ++a) {
      for (int l = 0; l < N; ++l) same = same && direction[a][l] == directions[a][l];
    }
    if (same) return;
    levels = 0;
    for (int a = 0; a < 3; ++a) {
      for (int l = 0; l < N; ++l) direction[a][l] = directions[a][l];
    }
  }
};

/// Rays in lanes that go through smooth blocks (SmoothBlocks) in steps, four at a time: how long
/// these are is each lane's own matter, from longest_step downward in powers of √½ as its errors
/// demand.
///
/// Steps that keep in step with the cells are avoided: what trilinear data lie below the curve
/// through their points between two of these would be missed by all samples alike, and by the
/// difference of two rules as well. So of a few lengths that is taken for which
/// simpson_error_mean_square() is least, and where a stretch ends it is done in two parts if need
/// be.
template <int N>
class SmoothMarch {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  M walking{false};  ///< whether a lane has anything left of its smooth stretch
  D at, end;         ///< of it: world length from the entry into the grid

  /// `lengths` is of this march alone while it lasts.
  SmoothMarch(const PellucidPacketJob& job, const PacketGrid& grid, const double (&origin)[3][N],
              const double (&direction)[3][N], StepTable<N>& lengths) noexcept
      : transfer_(*seen(job.samples)),
        smooth_(*seen(job.smooth)),
        grid_(grid),
        samples_(grid),
        lengths_(lengths) {
    at = end = D(0);
    F square(0);
    for (int a = 0; a < 3; ++a) {
      origin_[a] = D::load(origin[a]);
      direction_[a] = D::load(direction[a]);
      direction_in_float_[a] = convert<float>(direction_[a]);
      square += direction_in_float_[a] * direction_in_float_[a];
    }
    samples_.set_direction(direction_);
    cells_per_length_ = sqrt(square);
    if (smooth_.longest_step > 0) lengths_.begin(direction);
  }

  /// Begins, or goes on with, the stretches of the lanes.
  void enter(M lanes, D begin, D to) noexcept {
    known_ = known_ & !(lanes & (begin != at));
    at = select(lanes, begin, at);
    end = select(lanes, to, end);
    walking = walking | lanes;
  }

  struct Steps {
    F length;  ///< world length of all four
    M last;    ///< whether they end the stretch
    SampledSegment<F> found;
    F least_variance;               ///< of the error beside what `found` says
    F local[SmoothBlocks::fields];  ///< of SmoothBlocks
    M valid;                        ///< false: there is vacuum, or a step is too dense, or too long
    M may_be_longer;
  };

  /// Four steps of each lane. Those that are taken are to be told to take().
  [[gnu::flatten]] Steps look() noexcept {
    Steps s;
    D place[3];
    for (int a = 0; a < 3; ++a) place[a] = origin_[a] + at * direction_[a];
    samples_.anchor(place);
    const F left = convert<float>(end - at);
    while (any(walking & (level_ >= I(lengths_.levels)))) find_step(lengths_.levels);
    F step = lengths_.step[0];
    F weight[3] = {lengths_.weight[0][0], lengths_.weight[0][1], lengths_.weight[0][2]};
    for (int l = 1; l < lengths_.levels; ++l) {
      const M here = level_ == I(l);
      step = select(here, lengths_.step[l], step);
      for (int a = 0; a < 3; ++a) weight[a] = select(here, lengths_.weight[l][a], weight[a]);
    }
    const M near_end = F(4.0001f) * step >= left;
    s.last = near_end;
    if (any(near_end & walking)) {
      // A quarter of what is left, unless that is in step with the cells.
      F quarter = F(0.25f) * left, its_weight[3];
      weigh(quarter, its_weight);
      const M alike = (worst(its_weight) > F(resonant)) & near_end;
      if (any(alike)) {
        quarter = select(alike, F(first_part) * quarter, quarter);
        weigh(quarter, its_weight);
      }
      s.last = near_end & !alike;
      step = select(near_end, quarter, step);
      for (int a = 0; a < 3; ++a) weight[a] = select(near_end, its_weight[a], weight[a]);
    }
    s.length = select(s.last, left, F(4) * step);
    look_at_blocks(weight, step, s);
    if (any(walking & !known_)) find_front();
    F offset[4], value[4];
    for (int i = 0; i < 4; ++i) offset[i] = step * F(static_cast<float>(i + 1));
    samples_.template sample<4>(offset, value);
    for (int i = 0; i < 4; ++i) offset[i] = step * F(static_cast<float>(i + 5));
    samples_.template load_ahead<4>(offset);
    s.valid = s.valid & walking &
              !is_nan(((value[0] + value[1]) + (value[2] + value[3])) + front_.extinction);
    Material<F> material[5];
    material[0] = front_;
    for (int i = 0; i < 4; ++i) {
      material[i + 1] = material_at(transfer_, select(s.valid, value[i], F(transfer_.support_min)));
    }
    s.least_variance += of_corners(value, step, s.valid);
    F densest = material[0].extinction;
    for (int i = 1; i < 5; ++i) densest = max(densest, material[i].extinction);
    s.valid = s.valid & (step * densest <= F(deepest));
    s.found = sampled_segment(material, step);
    back_ = material[4];
    back_value_ = value[3];
    return s;
  }

  /// Goes behind the steps of these lanes. `easy`: those which could do with longer ones.
  void take(M lanes, const Steps& s, F transparency, M easy) noexcept {
    note(lanes, s.length, s.local, transparency);
    at = select(lanes, select(s.last, end, at + convert<double>(s.length)), at);
    set_front(lanes, back_, back_value_);
    walking = walking & !(lanes & s.last);
    level_ = select(lanes & easy & s.may_be_longer & (level_ > I(0)), level_ - I(1), level_);
  }

  /// Leaves what is left of their stretches to others. How far these will see is not known: bends
  /// count as if it were to where the mean of all that was seen is the largest.
  [[gnu::noinline]] void refuse(M lanes, F transparency) noexcept {
    walking = walking & !lanes;
    const D block = convert<double>(F(static_cast<float>(block_width)) / cells_per_length_);
    F mean[3];
    const auto mean_so_far = [&](int a) noexcept { return bends_[a] / (seen_ + F(tiny)); };
    for (int a = 0; a < 3; ++a) mean[a] = mean_so_far(a);
    D from = at;
    for (M left = lanes & (from < end); any(left); left = left & (from < end)) {
      const D to = min(from + block, end);
      F local[SmoothBlocks::fields];
      look_up(left, D(0.5) * (from + to), local);
      note(left, convert<float>(to - from), local, transparency);
      for (int a = 0; a < 3; ++a) mean[a] = max(mean[a], mean_so_far(a));
      from = select(left, to, from);
    }
    for (int a = 0; a < 3; ++a) bends_[a] = select(lanes, mean[a] * seen_, bends_[a]);
  }

  /// RayResult::neighbor_deviation, of what was taken or refused.
  F neighbor_deviation() const noexcept {
    F variance(0);
    for (int a = 0; a < 3; ++a) {
      const F mean = bends_[a] / max(seen_, F(tiny));
      variance += variance_between_rays(mean, mean, seen_, abs(direction_in_float_[a]));
    }
    return sqrt(variance);
  }
  /// RayResult::longest_step, likewise.
  F longest_step() const noexcept { return F(1) / max_frequency_; }

  /// Shortens the steps of these lanes; of those whose are the shortest returns which they are.
  M finer(M lanes) noexcept {
    const M finest = lanes & (level_ >= I(smooth_.levels - 1));
    level_ = select(lanes & !finest, level_ + I(1), level_);
    return finest;
  }

 private:
  static constexpr float tiny = std::numeric_limits<float>::min();
  static constexpr int choices = 5;
  /// The optical depth of a step at most: the rule goes by what is small against 1.
  static constexpr float deepest = 1;
  /// Mean square error of a breakpoint, as uncorrelated_error_mean_square() of many; doubled, for
  /// `fastest` is a mean over a step.
  static constexpr float corner = 2 * uncorrelated_error_limit;
  /// simpson_error_mean_square() above which steps are in step with the cells, and by how much
  /// shorter ones are taken then.
  static constexpr float resonant = 0.004f, first_part = 0.62f;

  /// Notes how much the data bend along this length.
  void note(M lanes, F length, const F* local, F transparency) noexcept {
    const F weight = select(lanes, transparency * transparency * length, F(0));
    seen_ += weight;
    for (int a = 0; a < 3; ++a) bends_[a] += select(lanes, weight * (local[a] * local[a]), F(0));
    max_frequency_ = max(max_frequency_, select(lanes, local[3], F(0)));
  }

  /// The fields of SmoothBlocks for the block at this length from the entry into the grid.
  void look_up(M lanes, D there, F* local) const noexcept {
    I block[3];
    for (int a = 0; a < 3; ++a) {
      const D place = floor((origin_[a] + there * direction_[a]) * D(1.0 / block_width));
      block[a] = convert<std::int32_t>(clamp(place, D(0), D(grid_.blocks[a] - 1)));
    }
    const I index = grid_.index_of_block(block);
    load_records<SmoothBlocks::fields>(smooth_.local, select(lanes, index, I(0)), local);
  }

  /// The material where the lanes stand; that of NaN, which is none, in vacuum.
  void find_front() noexcept {
    const F here(0);
    F value;
    samples_.template sample<1>(&here, &value);
    const M vacuum = is_nan(value);
    Material<F> found = material_at(transfer_, select(vacuum, F(transfer_.support_min), value));
    found.extinction = select(vacuum, value, found.extinction);
    set_front(!known_, found, value);
    known_ = known_ | walking;
  }

  void set_front(M lanes, const Material<F>& m, F value) noexcept {
    front_value_ = select(lanes, value, front_value_);
    front_.extinction = select(lanes, m.extinction, front_.extinction);
    front_.color.r = select(lanes, m.color.r, front_.color.r);
    front_.color.g = select(lanes, m.color.g, front_.color.g);
    front_.color.b = select(lanes, m.color.b, front_.color.b);
  }

  /// The mean squares of what steps of this length err because of bends along each axis, in units
  /// of the step squared.
  void weigh(F step, F* weight) const noexcept {
    for (int a = 0; a < 3; ++a) {
      const F cells = abs(step * direction_in_float_[a]);
      weight[a] = charged_error_mean_square(cells);
    }
  }
  F worst(const F* weight) const noexcept { return max(weight[0], max(weight[1], weight[2])); }

  /// The length of steps of a level: a little below the longest, and of those the one whose
  /// variance by length is the least.
  void find_step(int level) noexcept {
    const F longest =
        F(static_cast<float>(smooth_.longest_step) * sampled_step_share(level)) / cells_per_length_;
    F least(std::numeric_limits<float>::infinity());
    for (int c = 0; c < choices; ++c) {
      // 2^(-c/10)
      static constexpr float share[choices] = {1, 0.9330330f, 0.8705506f, 0.8122524f, 0.7578583f};
      const F candidate = F(share[c]) * longest;
      F weight[3], cost(0);
      weigh(candidate, weight);
      for (int a = 0; a < 3; ++a) {
        cost += weight[a] * F(smooth_.second_difference[a] * smooth_.second_difference[a] /
                              largest_square_of_bend());
      }
      cost = (cost + F(1e-4f)) * F(share[c]);
      const M better = cost < least;
      F& step = lengths_.step[level];
      step = select(better, candidate, step);
      for (int a = 0; a < 3; ++a) {
        F& of_axis = lengths_.weight[level][a];
        of_axis = select(better, weight[a], of_axis);
      }
      least = min(cost, least);
    }
    lengths_.levels = level + 1;
  }
  float largest_square_of_bend() const noexcept {
    const float largest = max(smooth_.second_difference[0],
                              max(smooth_.second_difference[1], smooth_.second_difference[2]));
    return largest > 0 ? largest * largest : 1;
  }

  /// Reads from the blocks of the steps least_variance, and whether the steps are short enough,
  /// with those of the level before being so, too.
  void look_at_blocks(const F* weight, F step, Steps& s) const noexcept {
    // The block in the middle of the steps, whose neighbours hold the others.
    look_up(walking, at + D(0.5) * convert<double>(s.length), s.local);
    F sum(0);
    for (int a = 0; a < 3; ++a) sum += weight[a] * (s.local[a] * s.local[a]);
    s.least_variance = step * step * sum;
    const F part = step * cells_per_length_ * s.local[3];
    s.valid = part <= F(1.0001f);
    s.may_be_longer = part <= F(0.7071f);
  }

  /// The mean square of what breakpoints of the transfer function make steps err, over where in a
  /// step they are: each the more, the faster the data pass it. A corner that the data come near to
  /// between two steps counts as well.
  F of_corners(const F* value, F step, M lanes) const noexcept {
    F least = front_value_, most = front_value_, fastest(0), before = front_value_;
    for (int i = 0; i < 4; ++i) {
      least = min(least, value[i]);
      most = max(most, value[i]);
      fastest = max(fastest, abs(value[i] - before));
      before = value[i];
    }
    const F margin = F(0.5f) * fastest;
    const F squares = corners_between(transfer_, select(lanes, least - margin, F(0)),
                                      select(lanes, most + margin, F(0)));
    const F passed = step * fastest;
    return F(corner) * (passed * passed) * squares;
  }

  const SamplerTransfer& transfer_;
  const SmoothBlocks& smooth_;
  const PacketGrid& grid_;
  PacketSamples<N> samples_;
  D origin_[3], direction_[3];
  F direction_in_float_[3], cells_per_length_;
  StepTable<N>& lengths_;
  I level_;
  M known_{false};            ///< whether `front_` is that at `at`
  Material<F> front_, back_;  ///< of the steps that were looked at
  F front_value_{0}, back_value_{0};
  // Of what was taken or refused: squares of roughness times bend along each axis, over length; and
  // the largest of 1 / the longest step.
  F bends_[3] = {F(0), F(0), F(0)}, max_frequency_{0};
  F seen_{0};  ///< their length, by the square of what they show of it
};

}  // namespace pellucid
#endif
