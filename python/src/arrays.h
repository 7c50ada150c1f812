// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "common.h"

namespace pellucid::python {

/// Returns the values of an array of any shape in a volume's own type and in C order. Shares the
/// array's memory if it already is such; the array then stays alive as long as the values, and is
/// never written to. Else the values are copied as the file readers do: bool becomes u8, float16
/// f32, integers of 64 bits the smallest type that holds them; `notes` is told if some are rounded.
/// Throws Error that begins with `name` for other types.
VolumeData values_of(const py::array& array, const std::string& name, Notes& notes);

/// An array of three axes as a volume takes it.
struct GridValues {
  VolumeData data;
  /// The axes of the array that are the volume's x, y and z: {2, 1, 0} in C order. Another order
  /// means that the memory is in another order, and was not copied.
  std::array<std::size_t, 3> axes{2, 1, 0};
};

/// Returns the values of an array (z, y, x) without a copy if its memory is dense in any order of
/// the axes. Throws as values_of().
GridValues grid_values_of(const py::array& array, const std::string& name, Notes& notes);

/// Returns a read-only array that views the data of a volume or a channel; `owner` stays alive.
py::array view_of(const VolumeData& data, std::vector<py::ssize_t> shape, const py::handle& owner);

/// Returns a contiguous array of doubles with `columns` columns, or for `columns` 0 of one axis.
/// Throws Error that begins with `what`.
py::array_t<double> doubles_of(const py::handle& object, py::ssize_t columns,
                               const std::string& what);

}  // namespace pellucid::python
