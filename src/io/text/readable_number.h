// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <string>

namespace pellucid {

/// Returns a number in six digits, for messages.
inline std::string readable_number(double x) {
  constexpr int digits = 6;
  char text[32];
  const auto end =
      std::to_chars(text, text + sizeof text, x, std::chars_format::general, digits).ptr;
  return {text, end};
}

inline std::string in_millimetres(double x) {
  return readable_number(x) + " mm";
}

}  // namespace pellucid
