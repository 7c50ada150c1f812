// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// The error budget of a ray. It distributes the tolerance of a pixel among the spans of the ray,
/// front to back, so that the errors of any sequence of spans sum to at most the tolerance
/// (specification, 2.3).
///
/// By theorem (3) a span with error x behind transparency T changes the pixel by at most T x. The
/// budget has two halves, the opacity budget and the length budget:
///
/// - A span of opacity α may use the fraction α of the remaining opacity budget, because it absorbs
///   the fraction α of the remaining light.
/// - A span of length l may use the fraction l / (remaining length) of the remaining length budget.
///
/// A fraction of the remainder never exhausts a budget, so every sequence of spans, however long,
/// stays within the tolerance. What a span does not use remains for the spans behind it; a span
/// that exceeds its share reduces theirs. Dense spans rely on the opacity budget, thin ones on the
/// length budget.
///
/// A ray may terminate when the upper bound on its remainder is below a fixed fraction of the
/// remaining budget.
///
/// T: double, or a batch of several rays.
template <class T>
class RayBudget {
 public:
  RayBudget() = default;
  /// Begins a ray. `tolerance` >= 0 is that of the pixel; `length` >= 0 that of the ray inside the
  /// data.
  PELLUCID_HD RayBudget(T tolerance, T length) noexcept
      : opacity_pot_(T(0.5) * tolerance), length_pot_(T(0.5) * tolerance), length_(length) {}

  /// Returns the largest error x permitted for the next span, given its length, an upper bound on
  /// its opacity, and the transparency in front of it (> 0).
  PELLUCID_HD T allowance(T length, T opacity, T transparency) const noexcept {
    return span_share(length, opacity).sum() / transparency;
  }
  /// Charges a span with error x = `error` (0 for an empty span), and moves behind it.
  PELLUCID_HD void spend(T length, T opacity, T transparency, T error) noexcept {
    const T cost = transparency * error;
    if (any(cost > T(0))) {
      spend(length, span_share(length, opacity), cost);
    } else {
      length_ = max(length_ - length, T(0));
    }
  }

  /// The parts of the opacity budget and of the length budget that a span may use.
  struct SpanShare {
    T opacity_part, length_part;
    PELLUCID_HD T sum() const noexcept { return opacity_part + length_part; }
  };
  /// Returns the share of a span.
  PELLUCID_HD SpanShare span_share(T length, T opacity) const noexcept {
    return {opacity_pot_ * opacity, length_pot_ * length_fraction(length)};
  }
  /// Charges `cost` = transparency · error to a span with the share `from`, and moves behind it.
  /// The cost must be at most the share's sum, or remaining(); otherwise the budget is exhausted.
  PELLUCID_HD void spend(T length, const SpanShare& from, T cost) noexcept {
    const T sum = from.sum();
    // What one budget lacks is taken from the other: together they lose the whole cost.
    T part = select(sum > T(0), cost * (from.opacity_part / sum), T(0));
    part = clamp(part, min(cost - length_pot_, opacity_pot_), opacity_pot_);
    opacity_pot_ = max(opacity_pot_ - part, T(0));
    length_pot_ = max(length_pot_ - (cost - part), T(0));
    spent_ += cost;
    length_ = max(length_ - length, T(0));
  }

  /// Returns an upper bound on the radiance of the remainder of the ray.
  PELLUCID_HD T remainder_bound(T transparency, T largest_extinction,
                                T largest_color) const noexcept {
    return transparency * min(largest_extinction * length_, T(1)) * largest_color;
  }

  /// Fraction of the remaining budget that early termination may use.
  ///
  /// If the remainder is opaque, the pixel's error is nearly the whole bound, while other errors
  /// are far below what is charged for them: with the whole remaining budget the error reaches 0.97
  /// of the tolerance, with a quarter of it 0.1 to 0.4 (docs/notes/2026-11-performance.md). Rays go
  /// further through thin media, for up to 15 % more time.
  static constexpr double termination_fraction = 0.25;

  /// Returns whether the ray may terminate, given the bound `rest` on its remainder: if it is at
  /// most that fraction of the remaining budget, or if the ray has exceeded its tolerance and it is
  /// below 1/64 of the tolerance.
  PELLUCID_HD mask_t<T> allows_termination(T rest, T tolerance) const noexcept {
    const auto next_to_nothing = rest <= T(1.0 / 64) * tolerance;
    return (rest <= T(termination_fraction) * remaining()) |
           ((spent_ > tolerance) & next_to_nothing);
  }

  /// Returns a lower limit for the allowance of a span, however little budget remains. With it a
  /// ray finishes that has exceeded its tolerance because rounding takes more.
  PELLUCID_HD static T minimum_allowance(T tolerance, T share_of_length) noexcept {
    return T(1.0 / 64) * tolerance * share_of_length;
  }

  // For spans that are tested together, before those in front of them are composited:

  /// Returns the length budget that such a span may use per unit of its length.
  PELLUCID_HD T allowance_per_length() const noexcept {
    return length_ > T(0) ? length_pot_ / length_ : length_pot_;
  }
  /// Returns the opacity budget for all of them. Their shares are taken one after the other, front
  /// to back; the shares of accepted spans are reserved until they are spent.
  PELLUCID_HD T unreserved_opacity_budget() const noexcept {
    return max(opacity_pot_ - reserved_, T(0));
  }
  /// Reserves a part of the opacity budget.
  PELLUCID_HD void reserve(T from_opacity) noexcept { reserved_ += from_opacity; }
  /// Charges a span with these reserved shares, and moves behind it. Neither budget loses more than
  /// its share if `error` is at most their sum divided by the transparency for which they were
  /// computed, or by a lower one. Shares of other spans are not affected.
  PELLUCID_HD void spend_reserved(T length, T from_opacity, T from_length, T transparency,
                                  T error) noexcept {
    reserved_ = max(reserved_ - from_opacity, T(0));
    const T cost = transparency * error, sum = from_opacity + from_length;
    const T part = sum > T(0) ? cost * (from_opacity / sum) : T(0);
    opacity_pot_ = max(opacity_pot_ - part, T(0));
    length_pot_ = max(length_pot_ - (cost - part), T(0));
    spent_ += cost;
    length_ = max(length_ - length, T(0));
  }

  /// Skips empty spans: sets the remaining length of the ray.
  PELLUCID_HD void set_remaining_length(T remaining_length) noexcept { length_ = remaining_length; }

  /// Selects lane by lane.
  friend RayBudget select(mask_t<T> mask, const RayBudget& a, const RayBudget& b) noexcept {
    RayBudget r;
    r.opacity_pot_ = select(mask, a.opacity_pot_, b.opacity_pot_);
    r.length_pot_ = select(mask, a.length_pot_, b.length_pot_);
    r.length_ = select(mask, a.length_, b.length_);
    r.spent_ = select(mask, a.spent_, b.spent_);
    r.reserved_ = select(mask, a.reserved_, b.reserved_);
    return r;
  }

  /// Returns the sum of all charges, as an error of the pixel.
  PELLUCID_HD T spent() const noexcept { return spent_; }
  /// Returns the remaining budget.
  PELLUCID_HD T remaining() const noexcept { return opacity_pot_ + length_pot_; }
  /// Returns the length of the ray behind the spans charged so far.
  PELLUCID_HD T remaining_length() const noexcept { return length_; }

 private:
  PELLUCID_HD T length_fraction(T length) const noexcept {
    const auto part = length < length_;
    return select(part, length / select(part, length_, T(1)), T(1));
  }

  T opacity_pot_{}, length_pot_{};
  T length_{};
  T spent_{};
  T reserved_{};  ///< part of the opacity budget
};

}  // namespace pellucid
