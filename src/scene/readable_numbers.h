// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>

namespace pellucid {

/// Extinctions and colors of transfer functions and of scene files lie up to the first; data values
/// up to the second.
inline constexpr double largest_number = 1e30, largest_data_value = 2.1e37;

/// Returns the decimal with this many digits behind the point of scientific notation that is
/// nearest.
inline double rounded(double value, int digits) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits).ptr;
  std::from_chars(text, end, value);
  return value;
}

/// Returns the nearest multiple of a power of ten that divides the range into 100 to 1000 parts.
inline double readable(double value, double range) {
  if (value == 0) return 0;
  const double digits = std::floor(std::log10(std::abs(value))) - std::floor(std::log10(range)) + 2;
  return digits < 0 ? 0 : rounded(value, static_cast<int>(std::min(digits, 16.0)));
}

inline double two_digits(double value) {
  return rounded(value, 1);
}

}  // namespace pellucid
