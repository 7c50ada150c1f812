// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/base/limits.h"
#include "pellucid/field/sample.h"

namespace pellucid {

/// The number type of a channel's values.
enum class ValueType : std::uint8_t { u8, i8, u16, i16, u32, i32, f32, f64 };

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
    switch (type[channel]) {
      case ValueType::u8:
        return body(grid_of<std::uint8_t>(channel));
      case ValueType::i8:
        return body(grid_of<std::int8_t>(channel));
      case ValueType::u16:
        return body(grid_of<std::uint16_t>(channel));
      case ValueType::i16:
        return body(grid_of<std::int16_t>(channel));
      case ValueType::u32:
        return body(grid_of<std::uint32_t>(channel));
      case ValueType::i32:
        return body(grid_of<std::int32_t>(channel));
      case ValueType::f32:
        return body(grid_of<float>(channel));
      case ValueType::f64:
        break;
    }
    return body(grid_of<double>(channel));
  }

  /// Computes the values at a position in grid coordinates, clamped into the box. Returns false in
  /// vacuum.
  template <class T>
  PELLUCID_HD bool sample(Vec3<double> position_grid, T* values) const noexcept {
    T sum = T(0);
    for (int c = 0; c < channels; ++c) {
      values[c] = visit_channel(
          c, [&](const auto& grid) noexcept { return sample_value<T>(grid, position_grid); });
      sum += values[c];
    }
    return !is_nan(sum);
  }

 private:
  template <class Value>
  PELLUCID_HD StructuredGrid<Value, double> grid_of(int channel) const noexcept {
    return {static_cast<const Value*>(data[channel]), {axis[0], axis[1], axis[2]}};
  }
};

}  // namespace pellucid
