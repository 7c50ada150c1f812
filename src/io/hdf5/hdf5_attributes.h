// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "axes/axis_meaning.h"
#include "axes/positions_beside.h"
#include "axes/variable_attributes.h"

namespace pellucid {

/// Returns the attributes of a dataset that are text or plain numbers.
VariableAttributes hdf5_attributes(hid_t dataset);

/// Returns the texts of an attribute, or its numbers as texts; none: it is not there.
std::vector<std::string> hdf5_texts(hid_t object, const std::string& name);

/// Returns the type that whole numbers of up to 32 bits are meant to have: the classic formats of
/// NetCDF have them with a sign alone, and `_Unsigned` says so.
std::string hdf5_meant_type(std::string type, const VariableAttributes& attributes);

/// The words that a dataset has for its axes: ilastik's axis tags, labels, dimension scales.
struct Hdf5Axes {
  std::vector<AxisText> texts;
  std::vector<AxisPositions> positions;  ///< along each axis; without numbers where none are known
  std::vector<std::string> notes;
};
Hdf5Axes hdf5_axes(hid_t dataset, const std::vector<std::int64_t>& shape,
                   const VariableAttributes& attributes, const std::string& name);

/// Returns the datasets beside a dataset of this name and shape, in its group and those around it,
/// that may say its positions. Those that are scales of its axes are left out.
std::vector<ArrayBeside> hdf5_arrays_beside(hid_t dataset, const std::string& name,
                                            const std::vector<std::int64_t>& shape,
                                            const Hdf5Axes& axes);

/// The value of what was never written, and how much that is.
struct Hdf5Fill {
  std::optional<double> value;  ///< where the file states one that is not 0
  std::string note;             ///< on chunks that were never written; may be empty
};
Hdf5Fill hdf5_fill(hid_t dataset, const std::vector<std::int64_t>& shape, const std::string& name);

}  // namespace pellucid
