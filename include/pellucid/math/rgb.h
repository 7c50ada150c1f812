// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// Linear RGB. The variable's name says whether it is a color (of the particles, not premultiplied)
/// or a radiance (premultiplied).
template <class T>
struct Rgb {
  T r{}, g{}, b{};

  PELLUCID_HD friend constexpr Rgb operator+(Rgb p, Rgb q) noexcept {
    return {p.r + q.r, p.g + q.g, p.b + q.b};
  }
  PELLUCID_HD friend constexpr Rgb operator-(Rgb p, Rgb q) noexcept {
    return {p.r - q.r, p.g - q.g, p.b - q.b};
  }
  PELLUCID_HD friend constexpr Rgb operator*(Rgb p, T s) noexcept {
    return {p.r * s, p.g * s, p.b * s};
  }
  PELLUCID_HD friend constexpr Rgb operator*(T s, Rgb p) noexcept { return p * s; }
  PELLUCID_HD constexpr Rgb& operator+=(Rgb q) noexcept { return *this = *this + q; }
  PELLUCID_HD friend constexpr bool operator==(const Rgb& p, const Rgb& q) noexcept {
    return p.r == q.r && p.g == q.g && p.b == q.b;
  }
};

/// Returns the largest absolute value of the three.
template <class T>
PELLUCID_HD T largest_component(const Rgb<T>& c) noexcept {
  return max(abs(c.r), max(abs(c.g), abs(c.b)));
}

}  // namespace pellucid
