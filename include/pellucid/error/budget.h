// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// Shares the tolerance of a pixel among the spans of its ray, front to back, so that whatever the
/// spans are, their errors sum to no more (specification, 2.3).
///
/// By theorem (3) a span whose error is x, behind a transparency T, changes the pixel by at most
/// T x. Two pots hold half of the tolerance each. A span of opacity α takes at most the share α of
/// the first, because it takes the share α of the light that is left; a span of length l at most
/// the share l / (length left) of the second. Shares of what is left never empty a pot: every
/// sequence of spans, however long, stays within the tolerance, and what a span leaves unspent is
/// there for those behind it. Dense spans live on the first pot, thin ones on the second. A span
/// that takes more than its shares takes it from those behind it.
///
/// The ray may end as soon as a share of what is left in both pots pays for all that is behind.
///
/// T: double, or a double of several rays at once.
template <class T>
class RayBudget {
 public:
  RayBudget() = default;
  /// tolerance >= 0, of the pixel; length >= 0, of the ray inside the data.
  PELLUCID_HD RayBudget(T tolerance, T length) noexcept
      : opacity_pot_(T(0.5) * tolerance), length_pot_(T(0.5) * tolerance), length_(length) {}

  /// How large the error x of the next span may be: of a span of this length and at most this
  /// opacity, behind this transparency (> 0).
  PELLUCID_HD T allowance(T length, T opacity, T transparency) const noexcept {
    return shares(length, opacity).sum() / transparency;
  }
  /// Goes past a span that cost `error` (x of above; 0 where nothing was there).
  PELLUCID_HD void spend(T length, T opacity, T transparency, T error) noexcept {
    const T cost = transparency * error;
    if (any(cost > T(0))) {
      spend(length, shares(length, opacity), cost);
    } else {
      length_ = max(length_ - length, T(0));
    }
  }

  /// What a span may take of each pot.
  struct Shares {
    T of_opacity, of_length;
    PELLUCID_HD T sum() const noexcept { return of_opacity + of_length; }
  };
  PELLUCID_HD Shares shares(T length, T opacity) const noexcept {
    return {opacity_pot_ * opacity, length_pot_ * share(length)};
  }
  /// Goes past a span whose shares these are and that costs so much, transparency · error: at most
  /// their sum, or left(), or all is lost.
  PELLUCID_HD void spend(T length, const Shares& from, T cost) noexcept {
    const T sum = from.sum();
    // What one pot does not have is taken from the other: together they lose all that is spent.
    T part = select(sum > T(0), cost * (from.of_opacity / sum), T(0));
    part = clamp(part, min(cost - length_pot_, opacity_pot_), opacity_pot_);
    opacity_pot_ = max(opacity_pot_ - part, T(0));
    length_pot_ = max(length_pot_ - (cost - part), T(0));
    spent_ += cost;
    length_ = max(length_ - length, T(0));
  }

  /// A bound on what lies behind the spans gone past: as little as light can come from there.
  PELLUCID_HD T rest_behind(T transparency, T largest_extinction, T largest_color) const noexcept {
    return transparency * min(largest_extinction * length_, T(1)) * largest_color;
  }

  /// How much of what is left may go for what lies behind a ray's end. Where that is opaque the
  /// pixel is off by nearly all of it, while other errors are far below what is charged for them:
  /// with all of what is left by up to 0.97 of the tolerance, with a quarter by 0.1 to 0.4
  /// (docs/notes/2026-11-performance.md). Rays go further through thin media: up to 15 % more time.
  static constexpr double share_for_rest = 0.25;

  /// Whether `rest`, a bound on what lies behind, may be left out: it is at most that share, or the
  /// ray is beyond its tolerance already and it is next to nothing.
  PELLUCID_HD mask_t<T> pays_for(T rest, T tolerance) const noexcept {
    const auto next_to_nothing = rest <= T(1.0 / 64) * tolerance;
    return (rest <= T(share_for_rest) * left()) | ((spent_ > tolerance) & next_to_nothing);
  }

  /// The least that a span is worth trying for, however little is left: a ray that is beyond its
  /// tolerance, because rounding takes more than that, must come to its end. T error as of
  /// allowance().
  PELLUCID_HD static T least_allowance(T tolerance, T share_of_length) noexcept {
    return T(1.0 / 64) * tolerance * share_of_length;
  }

  // For spans that are tried together before those in front of them are folded:

  /// What one of them may take of the second pot for each unit of its length, and what there is in
  /// the first one for all of them. Shares of the first are taken one after the other, from front
  /// to back; those of spans that are good enough are reserved until they are spent.
  PELLUCID_HD T for_length() const noexcept {
    return length_ > T(0) ? length_pot_ / length_ : length_pot_;
  }
  PELLUCID_HD T for_opacity() const noexcept { return max(opacity_pot_ - reserved_, T(0)); }
  PELLUCID_HD void reserve(T from_opacity) noexcept { reserved_ += from_opacity; }
  /// Goes past a span whose shares were these: none of the pots loses more than that if `error` is
  /// at most their sum by the transparency that they were given for, or a lower one. No share of
  /// another span is touched.
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

  /// Goes past stretches in which nothing was, up to where so much is left of the ray.
  PELLUCID_HD void pass_to(T length_left) noexcept { length_ = length_left; }

  /// Of several rays at once, lane by lane.
  friend RayBudget select(mask_t<T> mask, const RayBudget& a, const RayBudget& b) noexcept {
    RayBudget r;
    r.opacity_pot_ = select(mask, a.opacity_pot_, b.opacity_pot_);
    r.length_pot_ = select(mask, a.length_pot_, b.length_pot_);
    r.length_ = select(mask, a.length_, b.length_);
    r.spent_ = select(mask, a.spent_, b.spent_);
    r.reserved_ = select(mask, a.reserved_, b.reserved_);
    return r;
  }

  PELLUCID_HD T spent() const noexcept { return spent_; }
  PELLUCID_HD T left() const noexcept { return opacity_pot_ + length_pot_; }
  /// Of the ray, behind the spans gone past.
  PELLUCID_HD T length_left() const noexcept { return length_; }

 private:
  PELLUCID_HD T share(T length) const noexcept {
    const auto part = length < length_;
    return select(part, length / select(part, length_, T(1)), T(1));
  }

  T opacity_pot_{}, length_pot_{};
  T length_{};
  T spent_{};
  T reserved_{};  ///< of the first pot
};

}  // namespace pellucid
