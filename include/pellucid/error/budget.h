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
/// there for those behind it. Dense spans live on the first pot, thin ones on the second.
///
/// The ray may end as soon as what is left in both pots pays for all that is behind.
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
    return (opacity_pot_ * opacity + length_pot_ * share(length)) / transparency;
  }
  /// The same of several spans that lie one behind the other, as if those in front took all that
  /// they may: then none of them has less than this. B: as many numbers of type T, or T.
  template <class B>
  PELLUCID_HD B allowance_ahead(B length, B opacity, T transparency) const noexcept {
    const T per_length = length_ > T(0) ? T(1) / length_ : T(1);
    return (B(opacity_pot_) * opacity + B(length_pot_) * min(length * B(per_length), B(T(1)))) *
           B(T(1) / transparency);
  }

  /// Goes past a span that cost `error` (x of above; 0 where nothing was there).
  PELLUCID_HD void spend(T length, T opacity, T transparency, T error) noexcept {
    const T cost = transparency * error;
    if (any(cost > T(0))) {
      const T from_opacity = opacity_pot_ * opacity, from_length = length_pot_ * share(length);
      const T sum = from_opacity + from_length;
      // What one pot does not have is taken from the other: together they lose all that is spent.
      T part = select(sum > T(0), cost * (from_opacity / sum), T(0));
      part = clamp(part, min(cost - length_pot_, opacity_pot_), opacity_pot_);
      opacity_pot_ = max(opacity_pot_ - part, T(0));
      length_pot_ = max(length_pot_ - (cost - part), T(0));
      spent_ += cost;
    }
    length_ = max(length_ - length, T(0));
  }

  /// Goes past stretches in which nothing was, up to where so much is left of the ray.
  PELLUCID_HD void pass_to(T length_left) noexcept { length_ = length_left; }

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
};

}  // namespace pellucid
