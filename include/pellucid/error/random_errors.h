// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/error/budget.h"

namespace pellucid {

/// The mean square that simpson_error_mean_square() has where its four steps have nothing to do
/// with each other.
inline constexpr float uncorrelated_error_limit = 38.0f / (9 * 720);

/// What samples of trilinear data do not know of these: the mean square, over where in a cell they
/// begin, of what four steps of Simpson's rule err because of a bend of 1 along one axis, of which
/// a step takes so many cells; in units of the step squared.
///
/// At the place t of a cell the data are off the curve that they follow on the whole by B = t²/2 -
/// t/2 + 1/12. The mean of B(t) B(t + s) is K(s) = (1 - 30 s² (1 - s)²) / 720, s modulo 1, and the
/// weights 1 4 2 4 1, each a third, have lags of which that is summed. Where steps are short, they
/// follow B itself: what they err is that of one corner, at a random place, per cell. From half a
/// cell to a whole one this is down to half of the mean square.
template <class T>
T simpson_error_mean_square(T cells) noexcept {
  const auto correlation = [&](float lag) noexcept {
    const T at = T(lag) * cells, s = at - floor(at), w = s * (T(1) - s);
    return T(1) - T(30) * w * w;
  };
  const T alike = T(38) + T(48) * correlation(1) + T(40) * correlation(2) + T(16) * correlation(3) +
                  T(2) * correlation(4);
  return min(alike * T(1.0f / (9 * 720)), T(0.03f) * cells * cells * cells);
}

/// The same where the bend changes so much on the way that no step has to do with the next.
template <class T>
T uncorrelated_error_mean_square(T cells) noexcept {
  return min(T(uncorrelated_error_limit), T(0.03f) * cells * cells * cells);
}

/// What is charged: how much the bend changes on the way is not known.
template <class T>
T charged_error_mean_square(T cells) noexcept {
  return simpson_error_mean_square(cells) + T(0.25f) * uncorrelated_error_mean_square(cells);
}

/// What trilinear data do within cells, which rays beside each other do not have in common: of a
/// ray's picture, the variance by the data's bends along one axis, of which `speed` planes are met
/// by length. `inside`: their mean square over the length `seen`, times what they make of the
/// extinction; `at_ends`: the same where the ray begins and ends.
///
/// Over a whole cell what trilinear data lie off the curve that they follow comes to nothing, up to
/// how much the bends change within it. What is left is of the cells where a ray begins and ends,
/// and all of it where it runs along the cells: at most the root of 1/720 of a bend.
template <class T>
T variance_between_rays(T at_ends, T inside, T seen, T speed) noexcept {
  constexpr float of_ends = 1.5e-4f, of_cell = 1e-6f, along = 1.0f / 720;
  const T across = T(of_ends) * at_ends + T(of_cell) * inside * (speed * seen);
  return min(across / max(speed * speed, T(1e-12f)), T(along) * inside * (seen * seen));
}

/// Errors of a ray's spans that have nothing to do with each other: their squares add up, and the
/// pixel is charged with so many times the root of the sum. An estimate, not a bound.
///
/// Only the growth of that root is charged for each span, so that spans whose errors add up may
/// come between. T: a double, or a float, of several rays at once.
template <class T>
class RandomErrors {
 public:
  /// How many standard deviations are charged. Over random scenes made for that the true error was
  /// never more than these.
  static constexpr int deviations = 4;

  /// How large the variance of the next span may be, which stands for this share of what is still
  /// to come, if `left` is left to pay for all of it.
  T largest_variance(T left, T share) const noexcept {
    const T most = root_ + max(left, T(0)) * T(1.0f / deviations);
    return max((most * most - sum_) * share, T(0));
  }

  /// What a span of this variance adds to the charge.
  T charge(T variance) const noexcept {
    const T root = sqrt(sum_ + variance);
    // root - root_, but for the cancellation.
    return select(variance > T(0), T(deviations) * (variance / (root + root_)), T(0));
  }

  void add(T variance) noexcept {
    sum_ += variance;
    root_ = sqrt(sum_);
  }

  /// Of several rays at once, lane by lane.
  friend RandomErrors select(mask_t<T> mask, const RandomErrors& a,
                             const RandomErrors& b) noexcept {
    RandomErrors r;
    r.sum_ = select(mask, a.sum_, b.sum_);
    r.root_ = select(mask, a.root_, b.root_);
    return r;
  }

 private:
  T sum_{}, root_{};
};

/// What sampled stretches of a ray cost: random errors, and what rounding makes of them for sure.
/// T: of several rays at once.
template <class T>
class SampledErrors {
 public:
  /// How large the variance of the next stretch may be: of this length and opacity, where so much
  /// is left of the ray, if its rounding costs so much. Both in the pixel.
  T largest_variance(const RayBudget<T>& budget, T rounding, T opacity, T length,
                     T left) const noexcept {
    const T share = T(0.5f) * (opacity + min(length / left, T(1)));
    return random_.largest_variance(budget.remaining() - rounding, share);
  }

  /// Goes past these stretches, where the budget stands at any place in front of them.
  void charge(mask_t<T> lanes, RayBudget<T>& budget, T variance, T rounding, T opacity, T length,
              T left, T transparency) noexcept {
    const T cost = random_.charge(variance) + rounding;
    random_.add(select(lanes, variance, T(0)));
    budget.set_remaining_length(select(lanes, left, budget.remaining_length()));
    budget.spend(
        select(lanes, length, T(0)), opacity, transparency,
        select(lanes, cost / max(transparency, T(std::numeric_limits<scalar_t<T>>::min())), T(0)));
  }

  /// Lane by lane.
  friend SampledErrors select(mask_t<T> mask, const SampledErrors& a,
                              const SampledErrors& b) noexcept {
    SampledErrors r;
    r.random_ = select(mask, a.random_, b.random_);
    return r;
  }

 private:
  RandomErrors<T> random_;
};

}  // namespace pellucid
