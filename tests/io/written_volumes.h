// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid::test {

/// 5 x 4 x 3 values of a type with its extremes among them; of each component others.
template <class Value>
std::vector<Value> awkward_values(int component = 0) {
  std::vector<Value> values(60);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<Value>(i + 61 * static_cast<std::size_t>(component));
  }
  if constexpr (std::is_floating_point_v<Value>) {
    values[3] = std::numeric_limits<Value>::denorm_min();
    values[4] = static_cast<Value>(-1e37);
    values[17] = std::numeric_limits<Value>::quiet_NaN();
  } else {
    values[3] = std::numeric_limits<Value>::lowest();
    values[4] = std::numeric_limits<Value>::max();
  }
  return values;
}

/// Axes that are turned by the rotation whose columns are (2, 1, -2)/3 and so on: orthonormal, and
/// with a reflection.
inline Mat3<double> oblique() {
  constexpr double third = 1.0 / 3;
  return {{{2 * third, 1 * third, -2 * third},
           {-1 * third, -2 * third, -2 * third},
           {-2 * third, 2 * third, -1 * third}}};
}

inline Volume::Description awkward_description(Centering centering = Centering::point) {
  Volume::Description description;
  description.dimensions = {5, 4, 3};
  description.centering = centering;
  description.placement = {{-83.3, 0.1, 206.25}, {0.361328, 1.5, 0.1}, oblique()};
  description.name = "made by the test";
  return description;
}

template <class Value>
std::vector<Volume> awkward_volumes(int components, const Volume::Description& description) {
  std::vector<Volume> volumes;
  for (int c = 0; c < components; ++c) {
    volumes.emplace_back(description, DataArray<Value>(awkward_values<Value>(c)));
  }
  return volumes;
}

}  // namespace pellucid::test
