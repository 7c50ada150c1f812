// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/limits.h"
#include "pellucid/field/sample.h"
#include "pellucid/field/value_type.h"

namespace pellucid {

/// Several fields on one structured grid, each in its own type. A view; owns nothing. A cell with a
/// NaN corner in any field is vacuum.
struct MultichannelGrid {
  const void* data[max_channels]{};  ///< x fastest
  ValueType type[max_channels]{};
  int channels = 0;  ///< 1 … max_channels
  GridAxis<double> axis[3];

  /// Calls body(StructuredGrid<Value, double>) with the channel's own type and returns its result.
  template <class Body>
  PELLUCID_HD auto visit_channel(int channel, Body&& body) const noexcept {
    return visit_values(type[channel], data[channel],
                        [&](const auto* values) noexcept { return body(grid_of(values)); });
  }

  /// Computes the values at a place. Returns false in vacuum.
  template <class T>
  PELLUCID_HD bool sample_at(const GridPlace<T>& place, T* values) const noexcept {
    T sum = T(0);
    for (int c = 0; c < channels; ++c) {
      values[c] =
          visit_channel(c, [&](const auto& grid) noexcept { return sample_value<T>(grid, place); });
      sum += values[c];
    }
    return !is_nan(sum);
  }
  /// Computes the same at a position in grid coordinates, clamped into the box.
  template <class T>
  PELLUCID_HD bool sample(Vec3<double> position_grid, T* values) const noexcept {
    return sample_at(place_in_grid<T>(axis, position_grid), values);
  }

 private:
  template <class Value>
  PELLUCID_HD StructuredGrid<Value, double> grid_of(const Value* values) const noexcept {
    return {values, {axis[0], axis[1], axis[2]}};
  }
};

}  // namespace pellucid
