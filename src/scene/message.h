// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <charconv>
#include <string>

#include "pellucid/geometry/vec3.h"

namespace pellucid {

/// Returns a number as messages show it: the shortest text that reads back as the same double,
/// whatever the locale.
inline std::string number(double x) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), x).ptr;
  return {text.data(), end};
}

inline std::string tuple(const Vec3<double>& v) {
  return std::string("(") + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ")";
}

}  // namespace pellucid
