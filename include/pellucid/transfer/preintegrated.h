// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/math/rgb.h"

namespace pellucid {

/// Opacity and radiance of a step of fixed length, as functions of the data at its front and at its
/// back, with linear data in between (Engel, Kraus and Ertl 2001). Bilinear between the table's
/// nodes. A view; owns nothing.
struct PreintegratedTable {
  const float* entry = nullptr;  ///< opacity, radiance; nodes² of them, the back value fastest
  int nodes = 0;                 ///< along each axis, >= 2
  float origin = 0, nodes_per_value = 0;
  float support_min = 0, support_max = 0;  ///< nothing absorbs outside; min > max: nothing absorbs

  static constexpr int fields = 4;
};

template <class T>
struct PreintegratedStep {
  T opacity{};
  Rgb<T> radiance{};
};

/// Returns the step from front to back; vacuum if either is NaN.
template <class T>
PELLUCID_HD PreintegratedStep<T> preintegrated_step(const PreintegratedTable& table, T front,
                                                    T back) noexcept {
  if (!(max(front, back) >= T(table.support_min) && min(front, back) <= T(table.support_max))) {
    return {};
  }
  const T last = T(table.nodes - 1);
  const T f = clamp((front - T(table.origin)) * T(table.nodes_per_value), T(0), last);
  const T b = clamp((back - T(table.origin)) * T(table.nodes_per_value), T(0), last);
  const int i = min(static_cast<int>(f), table.nodes - 2);
  const int j = min(static_cast<int>(b), table.nodes - 2);
  const T s = f - T(i), t = b - T(j);
  T of[PreintegratedTable::fields];
  for (int k = 0; k < PreintegratedTable::fields; ++k) {
    const auto at = [&](int m, int n) {
      return T(table.entry[PreintegratedTable::fields * ((i + m) * table.nodes + j + n) + k]);
    };
    const T near = at(0, 0) + t * (at(0, 1) - at(0, 0)), far = at(1, 0) + t * (at(1, 1) - at(1, 0));
    of[k] = near + s * (far - near);
  }
  return {of[0], {of[1], of[2], of[3]}};
}

}  // namespace pellucid
