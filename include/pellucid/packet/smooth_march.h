// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/packet_samples.h"
#include "pellucid/packet/sampler_transfer.h"
#include "pellucid/segment/sampled.h"
#include "pellucid/traverse/block_classes.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes that go through smooth blocks (SmoothBlocks) in steps, four at a time: how long
/// these are is each lane's own matter, from longest_step halved as often as its errors demand.
///
/// Steps that keep in step with the cells are avoided: what trilinear data lie below the curve
/// through their points between two of these would be missed by all samples alike, and by the
/// difference of two rules as well. So of a few lengths that is taken which meets the planes of
/// each axis at places as unlike each other as can be.
template <class Value, int N>
class SmoothMarch {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  M walking{false};  ///< whether a lane has anything left of its smooth stretch
  D at, end;         ///< of it: world length from the entry into the grid

  SmoothMarch(const PellucidPacketJob& job, const PacketGrid<Value>& grid,
              const double (&origin)[3][N], const double (&direction)[3][N]) noexcept
      : transfer_(*static_cast<const SamplerTransfer*>(job.samples)),
        smooth_(*static_cast<const SmoothBlocks*>(job.smooth)),
        samples_(grid) {
    at = end = D(0);
    F cells_per_length(0);
    F d[3];
    for (int a = 0; a < 3; ++a) {
      origin_[a] = D::load(origin[a]);
      direction_[a] = D::load(direction[a]);
      d[a] = convert<float>(direction_[a]);
      cells_per_length += d[a] * d[a];
    }
    samples_.set_direction(direction_);
    cells_per_length = sqrt(cells_per_length);
    if (!smooth_.any) return;
    // Along the ray the data's derivative by its length changes by so much over the length of a
    // cell, at most.
    F bend(0);
    for (int a = 0; a < 3; ++a) {
      bend += d[a] * d[a] * F(smooth_.bend[a]) +
              F(2) * abs(d[(a + 1) % 3] * d[(a + 2) % 3]) * F(smooth_.twist[a]);
    }
    for (int level = 0; level < levels; ++level) {
      const float longest =
          static_cast<float>(SmoothBlocks::longest_step) / static_cast<float>(1 << level);
      step_[level] = unlike(d, cells_per_length, F(longest) / cells_per_length);
      const F cells = step_[level] * cells_per_length;
      // Of a step shorter than a cell most have no bend, and it errs by that much less.
      const F part = select(cells < F(1), cells * sqrt(cells), F(1));
      const F amplitude = bend / (cells_per_length * cells_per_length) *
                          F(static_cast<float>(smooth_.roughness * SmoothError::deviation_of_bend));
      const F one = step_[level] * part * amplitude;
      least_variance_[level] = F(4) * one * one;
    }
  }

  /// Begins, or goes on with, the stretches of the lanes; `wavy`: those of them which are that.
  void enter(M lanes, M wavy, D begin, D to) noexcept {
    coarsest_ = select(lanes, select(wavy, I(1), I(0)), coarsest_);
    level_ = max(level_, coarsest_);
    known_ = known_ & !(lanes & (begin != at));
    at = select(lanes, begin, at);
    end = select(lanes, to, end);
    walking = walking | lanes;
  }

  struct Steps {
    F length;  ///< world length of all four
    M last;    ///< whether they end the stretch
    SampledSegment<F> found;
    F least_variance;  ///< of the error beside what `found` says
    M valid;           ///< false: there is vacuum
  };

  /// Four steps of each lane. Those that are taken are to be told to take().
  [[gnu::flatten]] Steps look() noexcept {
    Steps s;
    D place[3];
    for (int a = 0; a < 3; ++a) place[a] = origin_[a] + at * direction_[a];
    samples_.anchor(place);
    const F left = convert<float>(end - at);
    F step = step_[0], least = least_variance_[0];
    for (int l = 1; l < levels; ++l) {
      step = select(level_ == I(l), step_[l], step);
      least = select(level_ == I(l), least_variance_[l], least);
    }
    s.last = F(4.0001f) * step >= left;
    step = select(s.last, F(0.25f) * left, step);
    s.length = select(s.last, left, F(4) * step);
    s.least_variance = least;
    if (any(walking & !known_)) find_front();
    F offset[4], value[4];
    for (int i = 0; i < 4; ++i) offset[i] = step * F(static_cast<float>(i + 1));
    samples_.template sample<4>(offset, value);
    s.valid = !is_nan(((value[0] + value[1]) + (value[2] + value[3])) + front_.extinction);
    Material<F> material[5];
    material[0] = front_;
    for (int i = 0; i < 4; ++i) {
      material[i + 1] = material_at(transfer_, select(s.valid, value[i], F(transfer_.support_min)));
    }
    s.found = sampled_segment(material, step);
    back_ = material[4];
    return s;
  }

  /// Goes behind the steps of these lanes. `easy`: those which could do with longer ones.
  void take(M lanes, const Steps& s, M easy) noexcept {
    at = select(lanes, select(s.last, end, at + convert<double>(s.length)), at);
    set_front(lanes, back_);
    walking = walking & !(lanes & s.last);
    level_ = select(lanes & easy & (level_ > coarsest_), level_ - I(1), level_);
  }

  /// Halves the steps of these lanes; of those whose are the shortest returns which they are.
  M finer(M lanes) noexcept {
    const M finest = lanes & (level_ >= I(levels - 1));
    level_ = select(lanes & !finest, level_ + I(1), level_);
    return finest;
  }

 private:
  static constexpr int levels = 5, choices = 8;
  /// The material where the lanes stand; that of NaN, which is none, in vacuum.
  void find_front() noexcept {
    const F here(0);
    F value;
    samples_.template sample<1>(&here, &value);
    const M vacuum = is_nan(value);
    Material<F> found = material_at(transfer_, select(vacuum, F(transfer_.support_min), value));
    found.extinction = select(vacuum, value, found.extinction);
    set_front(!known_, found);
    known_ = known_ | walking;
  }

  void set_front(M lanes, const Material<F>& m) noexcept {
    front_.extinction = select(lanes, m.extinction, front_.extinction);
    front_.color.r = select(lanes, m.color.r, front_.color.r);
    front_.color.g = select(lanes, m.color.g, front_.color.g);
    front_.color.b = select(lanes, m.color.b, front_.color.b);
  }

  /// A length a little below `step` of which no small multiple is close to whole cells along an
  /// axis that matters.
  static F unlike(const F* d, F cells_per_length, F step) noexcept {
    F best = step, least(std::numeric_limits<float>::infinity());
    for (int c = 0; c < choices; ++c) {
      // 2^(-c/10)
      static constexpr float share[choices] = {1,          0.9330330f, 0.8705506f, 0.8122524f,
                                               0.7578583f, 0.7071068f, 0.6597540f, 0.6155722f};
      const F candidate = F(share[c]) * step;
      F cost(0);
      for (int a = 0; a < 3; ++a) {
        const F cells = abs(candidate * d[a]);
        // The distance from whole numbers, and of the double: as 1/|sin| but for a factor.
        const F once = abs(cells - floor(cells + F(0.5f)));
        const F twice = abs(F(2) * cells - floor(F(2) * cells + F(0.5f)));
        const F weight = (d[a] * d[a]) / (cells_per_length * cells_per_length);
        cost +=
            weight * (F(1) / max(F(3) * once, F(1e-3f)) + F(0.25f) / max(F(3) * twice, F(1e-3f)));
      }
      cost = cost * F(1 + 0.03f * static_cast<float>(c));
      best = select(cost < least, candidate, best);
      least = min(cost, least);
    }
    return best;
  }

  const SamplerTransfer& transfer_;
  const SmoothBlocks& smooth_;
  PacketSamples<Value, N> samples_;
  D origin_[3], direction_[3];
  F step_[levels], least_variance_[levels];
  I level_, coarsest_;        ///< how often the longest step is halved, and at least has to be
  M known_{false};            ///< whether `front_` is that at `at`
  Material<F> front_, back_;  ///< of the steps that were looked at
};

}  // namespace pellucid
#endif
