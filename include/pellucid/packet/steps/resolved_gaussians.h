// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/steps/step_positions.h"
#include "pellucid/segment/sampled.h"
#include "pellucid/simd/batch.h"
#include "pellucid/transfer/gaussian.h"

namespace pellucid {

/// A Gaussian primitive for steps in lanes, in binary32.
struct SteppedGaussian {
  Gaussian<float> gaussian;
  /// The distance |K (v - c)| from which on it does not matter; below 0 where it never does.
  float reach = 0;
  float rounding = 0;  ///< how far K (v - c) may be off because numbers of it are rounded
  float center_rest[max_channels] = {};  ///< what binary32 leaves of the center
};

/// A sum of them. A view; owns nothing.
struct SteppedMixture {
  const SteppedGaussian* primitive = nullptr;
  int count = 0;
};

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set

/// Variation of the channels on the way of each lane: bounds for four steps from where it stands,
/// or for any one of them.
template <int N>
struct LocalVariation {
  /// Variation of the derivative along the ray in a step, per world length.
  Batch<float, N> oscillation[max_channels];
  /// The largest jump of the derivative by each axis's grid coordinate.
  Batch<float, N> second_difference[max_channels][3];
};

/// Which primitives may matter to the ray of each lane.
template <int N>
class LanePrimitives {
 public:
  using M = BatchMask<N>;

  void clear() noexcept {
    for (PrimitiveSet& set : of_lane_) set.bits = 0;
  }
  PELLUCID_ALWAYS_INLINE void add(int lane, PrimitiveSet set) noexcept {
    of_lane_[lane].bits |= set.bits;
  }
  /// Finishes these lanes, after all additions.
  void finish(M lanes) noexcept {
    any_.bits = 0;
    all_.bits = ~0ULL;
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      const unsigned long long set = of_lane_[__builtin_ctz(left)].bits;
      any_.bits |= set;
      all_.bits &= set;
    }
  }

  bool of_any(int primitive) const noexcept { return any_.contains(primitive); }
  PELLUCID_ALWAYS_INLINE M lanes(int primitive, M of) const noexcept {
    if (all_.contains(primitive)) return of;
    unsigned found = 0;
    for (unsigned left = bits(of); left != 0; left &= left - 1) {
      const int l = __builtin_ctz(left);
      if (of_lane_[l].contains(primitive)) found |= 1u << l;
    }
    return M::from_bits(found);
  }

 private:
  PrimitiveSet of_lane_[N], any_, all_;
};

/// Values of a sum of Gaussians at the five ends of four steps of one length, and whether the steps
/// resolve it: no primitive comes and goes between two ends unseen, and none changes much from one
/// to the next.
///
/// Between two ends data leave their chord by at most a quarter of the step times the oscillation
/// of their derivative (traverse/curvature_bounds.h), so that each row of a primitive's p = K (v -
/// c) leaves its own by at most step/4 Σ |K| · oscillation, entry by entry, and p by their root of
/// squares e. On the chord from p to q no place is nearer to 0 than (|p| + |q| - |q - p|) / 2. So a
/// primitive that matters nowhere on the step is known not to, and p moves by at most |q - p| + 2 e
/// on any other.
template <int N>
class ResolvedGaussians {
 public:
  using F = Batch<float, N>;
  using M = BatchMask<N>;
  static constexpr int steps = 4;

  StepEnd<F> end[steps + 1];  ///< end[0] is left as it is
  M matters[steps];           ///< whether a primitive does, somewhere on the step
  M unresolved[steps];
  F most;      ///< how far a primitive that matters moves in a step, at most
  F rounding;  ///< how far the extinction may be off because numbers are rounded
  F steepest;  ///< how much the extinction changes on a step where it changes most
  F coarse;    ///< the extinction, times the fourth power of how far the primitive moves in a step
  F bending[3];  ///< what a bend of the data along an axis makes of the extinction, by its largest
                 ///<   deviation from the curve, in cells squared (error/random_errors.h)

  /// Return the factor of the step that resolves everything: finer() at most 1, longer() any.
  F finer() const noexcept { return min(longer(), F(1)); }
  F longer() const noexcept { return F(0.8f * coarsest) / max(most, F(1e-30f)); }
  /// The share of step j, from its front on, on which none matters of those that do on it.
  F approach(int j) const noexcept { return ahead_[j] / max(fastest_[j], F(1e-30f)); }
  /// On how many steps behind the last one none matters, if data go on as on that.
  F clearance() const noexcept { return clear_ / max(fastest_behind_, F(1e-30f)); }

  /// `value[j][c]`: channel c at end j.
  PELLUCID_ALWAYS_INLINE void find(const SteppedMixture& mixture,
                                   const LanePrimitives<N>& primitives,
                                   const DatumInCell<F> (*value)[max_channels],
                                   const LocalVariation<N>& variation, F step, M on) noexcept {
    for (int j = 0; j < steps; ++j) {
      matters[j] = unresolved[j] = M(false);
      ahead_[j] = F(far_away);
      fastest_[j] = F(0);
      end[j + 1] = {};
    }
    clear_ = F(far_away);
    fastest_behind_ = most = rounding = steepest = coarse = F(0);
    for (F& b : bending) b = F(0);
    for (int i = 0; i < mixture.count; ++i) {
      if (!primitives.of_any(i)) continue;
      add(mixture.primitive[i], value, variation, step, primitives.lanes(i, on));
    }
  }

  /// Adds what a primitive is at one place.
  static void add_at(const SteppedGaussian& of, const DatumInCell<F>* value,
                     StepEnd<F>& end) noexcept {
    if (!(of.reach > 0)) return;
    F square(0);
    for (int row = 0; row < of.gaussian.rows; ++row) {
      F p;
      place_row(of, row, value, p);
      square = multiply_add(p, p, square);
    }
    end.add(extinction(of, square, square < F(of.reach * of.reach)), color(of));
  }

 private:
  /// The most that p may move in a step of a primitive that matters.
  static constexpr float coarsest = 1.2f;
  static constexpr float far_away = 1e6f;

  /// At |p|² where it is near: nothing where it does not matter, for numbers that are not normal
  /// take many times as long.
  PELLUCID_ALWAYS_INLINE static F extinction(const SteppedGaussian& of, F square, M near) noexcept {
    return select(near, F(of.gaussian.peak) * exp(F(0) - select(near, square, F(0))), F(0));
  }
  static Rgb<F> color(const SteppedGaussian& of) noexcept {
    const Rgb<float>& c = of.gaussian.color;
    return {F(c.r), F(c.g), F(c.b)};
  }

  PELLUCID_ALWAYS_INLINE void add(const SteppedGaussian& of,
                                  const DatumInCell<F> (*value)[max_channels],
                                  const LocalVariation<N>& variation, F step, M on) noexcept {
    const F off_chord = F(0.25f) * step *
                        moved_at_most(of, [&](int c) noexcept { return variation.oscillation[c]; });
    F away[steps + 1], between[steps];
    find_distances(of, value, away, between);
    const F reach(of.reach);
    M somewhere(false);
    F moves_most(0);
    for (int j = 0; j < steps; ++j) {
      // What rounding makes of it.
      const F slack = F(4 * rounding_unit<float>) * (away[j] + away[j + 1] + between[j]);
      const F nearest = F(0.5f) * (away[j] + away[j + 1] - between[j]) - (off_chord + slack);
      // Written so that NaN matters.
      const M here = on & !(nearest >= reach);
      const F moves = between[j] + F(2) * off_chord;
      const M too_far = here & !(moves <= F(coarsest));
      somewhere = somewhere | here;
      matters[j] = matters[j] | here;
      unresolved[j] = unresolved[j] | too_far;
      moves_most = max(moves_most, select(here, moves, F(0)));
      ahead_[j] = min(ahead_[j], select(here, max(away[j] - reach, F(0)), F(far_away)));
      fastest_[j] = max(fastest_[j], select(here, moves + F(2) * off_chord, F(0)));
    }
    clear_ = min(clear_, select(on, max(away[steps] - reach, F(0)), F(far_away)));
    fastest_behind_ = max(fastest_behind_, select(on, between[steps - 1] + F(4) * off_chord, F(0)));
    if (none(somewhere)) return;
    most = max(most, moves_most);
    F largest(0);
    for (int j = 0; j <= steps; ++j) {
      const M near = somewhere & (away[j] < reach);
      const F square = select(near, away[j] * away[j], F(0));
      const F here = extinction(of, square, near);
      if (j > 0) end[j].add(here, color(of));
      // 2 |p| <= 1 + |p|²: the slope by p.
      largest = max(largest, multiply_add(here, square, here));
    }
    largest = select(somewhere, largest, F(0));
    rounding = multiply_add(largest, F(of.rounding), rounding);
    steepest = multiply_add(largest, moves_most, steepest);
    const F squared = moves_most * moves_most;
    coarse = multiply_add(largest, squared * squared, coarse);
    for (int a = 0; a < 3; ++a) {
      const F second_difference =
          moved_at_most(of, [&](int c) noexcept { return variation.second_difference[c][a]; });
      bending[a] = multiply_add(largest, second_difference, bending[a]);
    }
  }

  /// Returns a bound on how far p moves where channel c moves by at most change(c) >= 0: row by
  /// row.
  template <class Change>
  PELLUCID_ALWAYS_INLINE static F moved_at_most(const SteppedGaussian& of,
                                                Change&& change) noexcept {
    const Gaussian<float>& g = of.gaussian;
    F square(0);
    for (int row = 0; row < g.rows; ++row) {
      F sum(0);
      for (int c = 0; c < g.channels; ++c) {
        sum = multiply_add(F(abs(g.matrix[row][c])), change(c), sum);
      }
      if (g.rows == 1) return sum;
      square = multiply_add(sum, sum, square);
    }
    return sqrt(square) * F(1 + 16 * rounding_unit<float>);
  }

  // In p: how far primitives that matter are from doing so at the front of each step, at least, and
  // how far they move in it, at most; and the same of all, behind the last one.
  F ahead_[steps], fastest_[steps], clear_, fastest_behind_;

  /// |p| at the ends, and between ends.
  PELLUCID_ALWAYS_INLINE static void find_distances(const SteppedGaussian& of,
                                                    const DatumInCell<F> (*value)[max_channels],
                                                    F* away, F* between) noexcept {
    F p[steps + 1];
    const int rows = of.gaussian.rows;
    if (rows == 1) {
      for (int j = 0; j <= steps; ++j) {
        place_row(of, 0, value[j], p[j]);
        away[j] = abs(p[j]);
      }
      for (int j = 0; j < steps; ++j) between[j] = abs(p[j + 1] - p[j]);
      return;
    }
    for (int j = 0; j <= steps; ++j) away[j] = F(0);
    for (int j = 0; j < steps; ++j) between[j] = F(0);
    for (int row = 0; row < rows; ++row) {
      for (int j = 0; j <= steps; ++j) {
        place_row(of, row, value[j], p[j]);
        away[j] = multiply_add(p[j], p[j], away[j]);
      }
      for (int j = 0; j < steps; ++j) {
        const F d = p[j + 1] - p[j];
        between[j] = multiply_add(d, d, between[j]);
      }
    }
    for (int j = 0; j <= steps; ++j) away[j] = sqrt(away[j]);
    for (int j = 0; j < steps; ++j) between[j] = sqrt(between[j]);
  }

  PELLUCID_ALWAYS_INLINE static void place_row(const SteppedGaussian& of, int row,
                                               const DatumInCell<F>* value, F& p) noexcept {
    const Gaussian<float>& g = of.gaussian;
    p = F(0);
    for (int c = 0; c < g.channels; ++c) {
      const F away = (value[c].corner - F(g.center[c])) + (value[c].rest - F(of.center_rest[c]));
      p = multiply_add(F(g.matrix[row][c]), away, p);
    }
  }
};
#endif

}  // namespace pellucid
