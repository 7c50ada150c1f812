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
class RayBudget {
 public:
  /// tolerance >= 0, of the pixel; length >= 0, of the ray inside the data.
  PELLUCID_HD RayBudget(double tolerance, double length) noexcept
      : opacity_pot_(0.5 * tolerance), length_pot_(0.5 * tolerance), length_(length) {}

  /// How large the error x of the next span may be: of a span of this length and at most this
  /// opacity, behind this transparency (> 0).
  PELLUCID_HD double allowance(double length, double opacity, double transparency) const noexcept {
    return (opacity_pot_ * opacity + length_pot_ * share(length)) / transparency;
  }

  /// Goes past a span that cost `error` (x of above; 0 where nothing was there).
  PELLUCID_HD void spend(double length, double opacity, double transparency,
                         double error) noexcept {
    if (error > 0) {
      const double cost = transparency * error;
      const double from_opacity = opacity_pot_ * opacity, from_length = length_pot_ * share(length);
      const double sum = from_opacity + from_length;
      // What one pot does not have is taken from the other: together they lose all that is spent.
      double part = sum > 0 ? cost * (from_opacity / sum) : 0;
      part = clamp(part, min(cost - length_pot_, opacity_pot_), opacity_pot_);
      opacity_pot_ = max(opacity_pot_ - part, 0.0);
      length_pot_ = max(length_pot_ - (cost - part), 0.0);
      spent_ += cost;
    }
    length_ = max(length_ - length, 0.0);
  }

  PELLUCID_HD double spent() const noexcept { return spent_; }
  PELLUCID_HD double left() const noexcept { return opacity_pot_ + length_pot_; }
  /// Of the ray, behind the spans gone past.
  PELLUCID_HD double length_left() const noexcept { return length_; }

 private:
  PELLUCID_HD double share(double length) const noexcept {
    return length < length_ ? length / length_ : 1.0;
  }

  double opacity_pot_, length_pot_;
  double length_;
  double spent_ = 0;
};

}  // namespace pellucid
