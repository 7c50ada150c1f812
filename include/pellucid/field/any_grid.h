// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/base/device_call.h"
#include "pellucid/field/structured_grid.h"
#include "pellucid/field/value_type.h"

namespace pellucid {

/// Stands for a number type that is known at run time.
struct AnyValue {};

/// A structured grid with data of any of the types: code for a device is compiled once for all of
/// them. Its numbers are those of the grid of the data's own type.
template <>
struct StructuredGrid<AnyValue, double> {
  const void* data = nullptr;  ///< x fastest
  ValueType type = ValueType::f32;
  GridAxis<double> axis[3];

  /// Returns the corners of cell (i, j, k), converted to Number. Double holds all types, so that a
  /// way through it rounds once.
  template <class Number>
  PELLUCID_HD CellCorners<Number> corners(int i, int j, int k) const noexcept {
    CellCorners<double> wide;
    load_corners(i, j, k, wide);
    CellCorners<Number> result;
    for (int n = 0; n < 8; ++n) result.value[n] = static_cast<Number>(wide.value[n]);
    return result;
  }

  /// Calls body(StructuredGrid<Value, double>) with the data's own type and returns its result.
  template <class Body>
  PELLUCID_HD auto visit(Body&& body) const noexcept {
    return visit_values(type, data,
                        [&](const auto* values) noexcept { return body(grid_of(values)); });
  }

 private:
  PELLUCID_HD PELLUCID_DEVICE_CALL void load_corners(int i, int j, int k,
                                                     CellCorners<double>& result) const noexcept {
    visit([&](const auto& grid) noexcept { result = grid.template corners<double>(i, j, k); });
  }
  template <class Value>
  PELLUCID_HD StructuredGrid<Value, double> grid_of(const Value* values) const noexcept {
    return {values, {axis[0], axis[1], axis[2]}};
  }
};
using AnyGrid = StructuredGrid<AnyValue, double>;

}  // namespace pellucid
