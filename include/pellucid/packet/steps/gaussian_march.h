// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/random_errors.h"
#include "pellucid/packet/blocks/rays_in_blocks.h"
#include "pellucid/packet/steps/multichannel_samples.h"
#include "pellucid/packet/steps/resolved_gaussians.h"
#include "pellucid/traverse/block_variation.h"
#include "pellucid/traverse/curvature_bounds.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes that go through several fields in steps, four at a time, which resolve what
/// Gaussians make of them: how long the steps are is each lane's own matter. Where nothing absorbs
/// they grow to the distance at which something can; where something does they shrink to what it
/// takes to see it, and on to what its error demands.
template <int N>
class GaussianMarch {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  M alive;  ///< whether a lane's ray is not yet through
  D at;     ///< world length from the entry into the grid

  /// Lanes have no rays yet.
  GaussianMarch(const PacketGrid& grid, const MultichannelGrid& fields,
                const SteppedMixture& mixture, const PrimitiveSet* primitives,
                const BlockVariation* variation, const float* waves) noexcept
      : grid_(grid),
        fields_(fields),
        mixture_(mixture),
        primitives_(primitives),
        variation_(reinterpret_cast<const std::int32_t*>(variation)),
        waves_(waves),
        rays_(grid, nullptr, 0),
        samples_(fields, grid) {
    at = D(0);
    alive = M(false);
  }

  /// Gives the lanes the rays of theirs; `rays` has one for each lane, also of those that go on.
  void begin(M lanes, const PellucidRay* rays) noexcept {
    rays_ = RaysInBlocks<N>(grid_, rays, N);
    samples_.set_direction(rays_.direction());
    fastest_ = F(1e-30f);
    for (int a = 0; a < 3; ++a) {
      direction_[a] = convert<float>(rays_.direction()[a]);
      fastest_ = max(fastest_, abs(direction_[a]));
    }
    longest_ = F(longest_step) / fastest_;
    step_ = select(lanes, longest_, step_);
    at = select(lanes, D(0), at);
    known_ = known_ & !lanes;
    seen_ = select(lanes, F(0), seen_);
    max_frequency_ = select(lanes, F(0), max_frequency_);
    for (int a = 0; a < 3; ++a) {
      bends_[a] = select(lanes, F(0), bends_[a]);
      bends_at_ends_[a] = select(lanes, F(0), bends_at_ends_[a]);
    }
    alive = alive | (lanes & (rays_.end > D(0)));
  }

  D end() const noexcept { return rays_.end; }

  /// Takes the lanes on to the next block in which anything absorbs, if there is any.
  void skip(I& skipped) noexcept {
    M lanes = alive;
    while (any(lanes)) {
      const M inside = at < rays_.end;
      alive = alive & (inside | !lanes);
      lanes = lanes & inside;
      D leave;
      lanes = rays_.find_skipped(lanes, at, leave);
      if (none(lanes)) return;
      // A little further, so that the next block is found there; it touches the last one.
      at = select(lanes, max(leave, at) + convert<double>(F(5e-7f) * longest_), at);
      known_ = known_ & !lanes;
      skipped += select(lanes, I(1), I(0));
    }
  }

  /// Four steps.
  struct Look {
    F step, length;  ///< world length of one, and of all four
    M last;          ///< whether they end the ray
    M empty;         ///< nothing matters on any of them
    M resolved;      ///< else they are too long, or in vacuum
    ResolvedGaussians<N> ends;
    DatumInCell<F> value[ResolvedGaussians<N>::steps + 1][max_channels];
    SampledSegment<F> found;
    F least_variance;  ///< of the error beside what `found` says
  };

  [[gnu::flatten]] void look(Look& s) noexcept {
    D place[3];
    rays_.place(at, place);
    samples_.anchor(place);
    const F left = convert<float>(rays_.end - at);
    s.last = F(4.0001f) * step_ >= left;
    s.step = select(s.last, F(0.25f) * left, step_);
    s.length = select(s.last, left, F(4) * step_);
    if (any(alive & !known_)) find_front();
    F offset[steps];
    for (int j = 0; j < steps; ++j) offset[j] = s.step * F(static_cast<float>(j + 1));
    samples_.template sample<steps>(offset, s.value + 1);
    F sum(0);
    for (int c = 0; c < fields_.channels; ++c) {
      s.value[0][c] = front_value_[c];
      for (int j = 0; j <= steps; ++j) sum += s.value[j][c].corner + s.value[j][c].rest;
    }
    const M there = alive & !is_nan(sum);
    look_at_blocks(place, s.length);
    s.ends.end[0] = front_;
    s.ends.find(mixture_, near_, s.value, around_, s.step, alive);
    M matters(false), unresolved = !there;
    for (int j = 0; j < steps; ++j) {
      matters = matters | s.ends.matters[j];
      unresolved = unresolved | s.ends.unresolved[j];
    }
    s.empty = there & !matters;
    s.resolved = alive & !unresolved;
    if (none(s.resolved & !s.empty)) return;
    F densest(0);
    for (int j = 0; j <= steps; ++j) densest = max(densest, s.ends.end[j].extinction);
    const F depth = s.step * densest;
    s.resolved = s.resolved & (depth <= F(1));
    s.found = sampled_segment(s.ends.end, s.step);
    F variance(0);
    for (int a = 0; a < 3; ++a) {
      const F cells = s.step * abs(direction_[a]);
      // What the mean squares are for short steps.
      F weight = F(1.25f * 0.03f) * cells * cells * cells;
      const M longer = alive & (cells > F(0.5f));
      if (any(longer)) {
        weight = select(longer, charged_error_mean_square(cells), weight);
      }
      variance += weight * (s.ends.bending[a] * s.ends.bending[a]);
    }
    // Each of the four ends is a little beside where it should be.
    const F beside = F(position_error) / (s.step * fastest_) * s.ends.steepest;
    variance = multiply_add(F(4) * beside, beside, variance);
    // Two rules agree by chance now and then.
    const F chance = F(min_share) * s.ends.coarse;
    variance = multiply_add(chance, chance, variance);
    s.least_variance = s.step * s.step * variance;
  }

  /// Goes behind the steps of these lanes. `change`: of a step's length, what would do.
  void take(M lanes, const Look& s, const F& change) noexcept {
    at = select(lanes, select(s.last, rays_.end, at + convert<double>(s.length)), at);
    set_front(lanes, s.ends.end[steps], s.value[steps]);
    known_ = known_ | lanes;
    // Over empty steps one may go on to where something can matter; the next look tells whether.
    const F leap = select(s.empty, F(0.25f) * s.ends.clearance(), F(0));
    const F grown = select(s.empty, F(2), min(change, s.ends.longer()));
    step_ = select(lanes & !s.last, min(max(grown, leap) * s.step, longest_), step_);
  }

  /// Notes what rays beside these have to do with the steps that are to be taken.
  void note(M lanes, const Look& s, F transparency) noexcept {
    if (waves_ == nullptr) return;
    const M at_ends = lanes & (s.last | !(seen_ > F(0)));
    const F length = transparency * transparency * s.length;
    seen_ += select(lanes, length, F(0));
    for (int a = 0; a < 3; ++a) {
      const F bending = transparency * s.ends.bending[a];
      bends_[a] += select(lanes, s.length * (bending * bending), F(0));
      bends_at_ends_[a] += select(at_ends, bending * bending, F(0));
    }
    const I block = rays_.block_at(at + convert<double>(F(0.5f) * s.length));
    const F waves = gather(waves_, select(lanes, block, I(0)));
    max_frequency_ = max(max_frequency_, select(lanes, waves, F(0)));
  }
  /// RayResult::neighbor_deviation and longest_step of what was noted, in units of the largest
  /// color.
  F neighbor_deviation() const noexcept {
    F variance(0);
    for (int a = 0; a < 3; ++a) {
      variance += variance_between_rays(bends_at_ends_[a], bends_[a] / max(seen_, F(1e-30f)), seen_,
                                        abs(direction_[a]));
    }
    return sqrt(variance);
  }
  F longest_step_between() const noexcept { return F(1) / max_frequency_; }

  /// Has these lanes look again, in finer steps; from the first in which something matters. Those
  /// that are returned cannot.
  M retry(M lanes, const Look& s, const F& change) noexcept {
    M before = lanes;
    const F finer = s.ends.finer();
    for (int j = 0; j < steps; ++j) {
      const M here = before & s.ends.matters[j];
      before = before & !here;
      if (j > 0 && any(here)) {
        const F passed = s.step * F(static_cast<float>(j));
        at = select(here, at + convert<double>(passed), at);
        set_front(here, {}, s.value[j]);
      }
      // To where it can begin to matter, if that is further than four steps that see it.
      const F wanted = max(finer, F(0.2495f) * s.ends.approach(j));
      const F least = select(s.resolved, min(change, F(0.84f)), j == 0 ? F(0.5f) : F(1));
      step_ = select(here, min(wanted, least) * s.step, step_);
    }
    step_ = select(before, F(0.5f) * s.step, step_);
    return lanes & !(step_ >= F(shortest_step / longest_step) * longest_);
  }

 private:
  static constexpr int steps = ResolvedGaussians<N>::steps;
  /// Cells along the axis on which they are the most: four of them are less than a block's width;
  /// nor are the longest in step with the cells, so that spans one behind the other have to do with
  /// different places in cells. Shorter ones change from look to look.
  static constexpr float longest_step = 1.87f;
  static constexpr float shortest_step = 0x1p-13f;
  /// Cells: what step_positions.h says of so short ways, as a standard deviation at most.
  static constexpr float position_error = 1e-6f;
  /// Fraction that counts as the least standard deviation, of the largest error of Simpson's rule
  /// on four steps over a Gaussian, which is 0.27 times the fourth power of how far it moves in
  /// one.
  static constexpr float min_share = 0.01f;

  void find_front() noexcept {
    const F here(0);
    DatumInCell<F> value[1][max_channels];
    samples_.template sample<1>(&here, value);
    StepEnd<F> found{};
    for (int i = 0; i < mixture_.count; ++i) {
      ResolvedGaussians<N>::add_at(mixture_.primitive[i], value[0], found);
    }
    set_front(!known_, found, value[0]);
    known_ = known_ | alive;
  }

  void set_front(M lanes, const StepEnd<F>& end, const DatumInCell<F>* value) noexcept {
    front_.extinction = select(lanes, end.extinction, front_.extinction);
    front_.emission.r = select(lanes, end.emission.r, front_.emission.r);
    front_.emission.g = select(lanes, end.emission.g, front_.emission.g);
    front_.emission.b = select(lanes, end.emission.b, front_.emission.b);
    for (int c = 0; c < fields_.channels; ++c) {
      front_value_[c] = {select(lanes, value[c].corner, front_value_[c].corner),
                         select(lanes, value[c].rest, front_value_[c].rest)};
    }
  }

  /// Looks up in the blocks how the data vary around the lanes' positions, and which primitives may
  /// matter on the way.
  PELLUCID_ALWAYS_INLINE void look_at_blocks(const D* place, F length) noexcept {
    F from[3];
    for (int a = 0; a < 3; ++a) from[a] = convert<float>(place[a]);
    // Where the steps end in another block their way is in several.
    I here[3], there[3];
    F to[3];
    for (int a = 0; a < 3; ++a) to[a] = multiply_add(length, direction_[a], from[a]);
    rays_.find_block(from, here);
    rays_.find_block(to, there);
    M leaves[3];
    F blocks(1);
    for (int a = 0; a < 3; ++a) {
      leaves[a] = alive & (here[a] != there[a]);
      blocks += select(leaves[a], F(1), F(0));
    }
    const I block = index_of(here);
    const F step = F(0.25f) * length;
    F speed[3], planes[3];  // of one step
    for (int a = 0; a < 3; ++a) {
      speed[a] = abs(direction_[a]);
      planes[a] = speed[a] * step + F(1);
    }
    const I upper_half(static_cast<std::int32_t>(0xffff0000u));
    for (int c = 0; c < fields_.channels; ++c) {
      I packed[4];
      load_records<4>(variation_, block * I(fields_.channels) + I(c), packed);
      const auto low = [](I x) noexcept { return float_of_bits(x << 16); };
      const auto high = [&](I x) noexcept { return float_of_bits(x & upper_half); };
      const F oscillation[3] = {low(packed[0]), high(packed[0]), low(packed[1])},
              twist[3] = {low(packed[3]), low(packed[3]), low(packed[3])};
      F(&second_difference)[3] = around_.second_difference[c];
      second_difference[0] = high(packed[1]);
      second_difference[1] = low(packed[2]);
      second_difference[2] = high(packed[2]);
      F on_the_way(0);
      for (int a = 0; a < 3; ++a) {
        // An axis along which nothing moves does not count, even if unbounded.
        const F range = blocks * oscillation[a] + select(leaves[a], second_difference[a], F(0));
        on_the_way += select(speed[a] > F(0), speed[a] * range, F(0));
      }
      around_.oscillation[c] =
          min(on_the_way * F(1 + 32 * rounding_unit<float>),
              derivative_variation(second_difference, twist, speed, planes, step));
    }
    near_.clear();
    add_primitives(block, alive);
    // A straight way between two places of a block stays in it.
    if (any(blocks > F(1))) add_blocks_on_the_way(from, length);
    near_.finish(alive);
  }

  /// The blocks of the other ends of the steps, and those that may lie between.
  void add_blocks_on_the_way(const F* from, F length) noexcept {
    I before[3], here[3];
    for (int j = 0; j <= steps; ++j) {
      F there[3];
      for (int a = 0; a < 3; ++a) {
        there[a] = multiply_add(F(0.25f * static_cast<float>(j)) * length, direction_[a], from[a]);
      }
      rays_.find_block(there, here);
      if (j > 0) {
        I moved(0);
        for (int a = 0; a < 3; ++a) {
          moved += select(alive & (here[a] != before[a]), I(1), I(0));
        }
        const M beyond = moved > I(0);
        if (any(beyond)) add_primitives(index_of(here), beyond);
        if (any(moved > I(1))) {
          // Past an edge or a corner: any that has some of its places from before, some from here.
          for (int which = 1; which < 7; ++which) {
            I between[3];
            for (int a = 0; a < 3; ++a) between[a] = (which >> a & 1) != 0 ? here[a] : before[a];
            add_primitives(index_of(between), moved > I(1));
          }
        }
      }
      for (int a = 0; a < 3; ++a) before[a] = here[a];
    }
  }
  I index_of(const I* block) const noexcept {
    return select(alive, grid_.index_of_block(block), I(0));
  }

  void add_primitives(I block, M lanes) noexcept {
    std::int32_t of_lane[N];
    block.store(of_lane);
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      near_.add(l, primitives_[of_lane[l]]);
    }
  }

  const PacketGrid& grid_;
  const MultichannelGrid& fields_;
  const SteppedMixture& mixture_;
  const PrimitiveSet* primitives_;
  const std::int32_t* variation_;
  const float* waves_;  ///< of blocks; null: nothing is noted
  RaysInBlocks<N> rays_;
  MultichannelSamples<N> samples_;
  F direction_[3];            ///< cells by world length
  F fastest_;                 ///< the same along the axis on which it is the most
  F longest_, step_;          ///< world length
  M known_{false};            ///< whether front_ and front_value_ are those at `at`
  LocalVariation<N> around_;  ///< where the lanes stand
  LanePrimitives<N> near_;    ///< on the way of four steps
  StepEnd<F> front_{};
  DatumInCell<F> front_value_[max_channels];
  // What was noted: length, by the square of what is seen of it, and likewise squares of
  // ResolvedGaussians::bending over length, and those where the rays begin and end; and the largest
  // of 1 / the longest step.
  F seen_, bends_[3], bends_at_ends_[3], max_frequency_;
};

}  // namespace pellucid
#endif
