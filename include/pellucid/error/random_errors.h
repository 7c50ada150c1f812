// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/error/budget.h"

namespace pellucid {

/// What samples of trilinear data do not know of these.
struct SmoothError {
  /// The standard deviation of what a bend of the data makes of a step, in units of the bend over a
  /// cell times the step: at a random place of a cell the data are off the curve that they follow
  /// on the whole by t²/2 - t/2 + 1/12 of the bend, whose mean square is 1/720; twice the root.
  static constexpr double deviation_of_bend = 0.025;
};

/// Errors of a ray's spans that have nothing to do with each other: their squares add up, and the
/// pixel is charged with so many times the root of the sum. An estimate, not a bound.
///
/// Only the growth of that root is charged for each span, so that spans whose errors add up may
/// come between. T: a double, or a float, of several rays at once.
template <class T>
class RandomErrors {
 public:
  /// How many standard deviations are charged. Over all pixels of tests/packet's scenes the true
  /// error is no more than two.
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

 private:
  T sum_{}, root_{};
};

}  // namespace pellucid
