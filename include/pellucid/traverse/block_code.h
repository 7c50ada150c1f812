// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/traverse/block_record.h"

namespace pellucid {

/// Returns the largest float that is not above x, infinities included; x is no NaN. Where the
/// nearest float is above, its predecessor f - (φ|f| + η) (Rump, Zimmermann, Boldo, Melquiond,
/// "Computing predecessor and successor in rounding to nearest", BIT 49, 2009): exact, but where
/// |f| lies from 2^-126 to 2^-124, where it may be one further down.
PELLUCID_HD inline float float_below(double x) noexcept {
  constexpr double largest = std::numeric_limits<float>::max();
  if (x > largest) return std::numeric_limits<float>::max();
  if (x < -largest) return -std::numeric_limits<float>::infinity();
  const float f = static_cast<float>(x);
  if (static_cast<double>(f) <= x) return f;
  constexpr float u = rounding_unit<float>, phi = u * (1 + 2 * u);
  return f - (phi * abs(f) + std::numeric_limits<float>::denorm_min());
}
PELLUCID_HD inline float float_above(double x) noexcept {
  return -float_below(-x);
}

/// Returns the upper half of the least float, of those that are 0 in their lower half, that is not
/// below x >= 0; infinite where there is none, and for NaN.
PELLUCID_HD inline std::uint16_t upper_half_above(double x) noexcept {
  constexpr std::uint16_t infinity = 0x7f80;
  if (!(x <= static_cast<double>(std::numeric_limits<float>::max()))) return infinity;
  const auto bits = __builtin_bit_cast(std::uint32_t, float_above(x) + 0.0f);
  return static_cast<std::uint16_t>((bits + 0xffff) >> 16);
}

/// Returns a code whose number is not above x, which lies between the volume's minimum and maximum:
/// the largest such, or one close below where its number is a rounding error from x; exact where
/// codes are.
PELLUCID_HD inline std::uint16_t code_below(const BlockCode& code, double x) noexcept {
  if (!(code.step > 0)) return 0;
  int c =
      static_cast<int>(clamp((x - code.minimum) / code.step, 0.0, static_cast<double>(code.last)));
  while (c > 0 && code.value(c) > x) --c;
  return static_cast<std::uint16_t>(c);
}
/// Returns the same from above.
PELLUCID_HD inline std::uint16_t code_above(const BlockCode& code, double x) noexcept {
  if (!(code.step > 0)) return 0;
  int c =
      static_cast<int>(clamp((x - code.minimum) / code.step, 0.0, static_cast<double>(code.last)));
  while (c < code.last && code.value(c) < x) ++c;
  return static_cast<std::uint16_t>(c);
}

/// Returns the code for data from minimum to maximum, finite; `integral`: whole numbers.
PELLUCID_HD inline BlockCode make_block_code(double minimum, double maximum,
                                             bool integral) noexcept {
  BlockCode code{minimum, 0, 0};
  if (!(minimum < maximum)) return code;
  const double range = maximum - minimum;
  if (integral && range <= BlockCode::highest) {
    code.step = 1;
    code.last = static_cast<int>(range);
    return code;
  }
  code.last = BlockCode::highest;
  code.step = range / BlockCode::highest;
  while (code.value(code.last) < maximum) {
    code.step += 4 * rounding_unit<double> * code.step + std::numeric_limits<double>::denorm_min();
  }
  return code;
}

}  // namespace pellucid
