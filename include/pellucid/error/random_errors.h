// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/budget.h"

namespace pellucid {

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
T mean_square_of_bend(T cells) noexcept {
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
T mean_square_of_bends(T cells) noexcept {
  return min(T(38.0f / (9 * 720)), T(0.03f) * cells * cells * cells);
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
  T largest(T left, T share) const noexcept {
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

}  // namespace pellucid
