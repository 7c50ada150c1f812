// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/base/config.h"

namespace pellucid {

/// The number type of a field's values.
enum class ValueType : std::uint8_t { u8, i8, u16, i16, u32, i32, f32, f64 };

/// Calls body(const Value*) with the values in their own type and returns its result.
template <class Body>
PELLUCID_HD auto visit_values(ValueType type, const void* values, Body&& body) noexcept {
  switch (type) {
    case ValueType::u8:
      return body(static_cast<const std::uint8_t*>(values));
    case ValueType::i8:
      return body(static_cast<const std::int8_t*>(values));
    case ValueType::u16:
      return body(static_cast<const std::uint16_t*>(values));
    case ValueType::i16:
      return body(static_cast<const std::int16_t*>(values));
    case ValueType::u32:
      return body(static_cast<const std::uint32_t*>(values));
    case ValueType::i32:
      return body(static_cast<const std::int32_t*>(values));
    case ValueType::f32:
      return body(static_cast<const float*>(values));
    case ValueType::f64:
      break;
  }
  return body(static_cast<const double*>(values));
}

}  // namespace pellucid
