// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "axes/axis_meaning.h"
#include "axes/value_meaning.h"
#include "axes/variable_notes.h"
#include "zarr_metadata.h"

namespace pellucid {

/// Returns the attributes of a node as those of a variable of NetCDF.
VariableAttributes zarr_attributes(const ZarrNode& node);

/// An array of a store as xarray writes it: a variable of NetCDF.
struct ZarrVariable {
  std::filesystem::path folder;
  ZarrArray array;  ///< of the type that is meant (_Unsigned)
  VariableAttributes attributes;
  ValueMeaning meaning;
  std::vector<std::string> notes;
  /// True if xarray alone takes the fill value, which is 0, for missing.
  bool may_hide_zeros = false;
};
/// Reads what the metadata of a folder say. Throws Error.
ZarrVariable zarr_variable(const std::filesystem::path& folder, const std::string& name);

/// Returns the axes of a variable with the attributes of their coordinates.
std::vector<AxisText> zarr_axis_texts(const ZarrVariable& variable);
/// Returns the positions along an axis, from the variable of its name or one that the attribute
/// `coordinates` names. Throws Error.
AxisPositions zarr_positions(const ZarrVariable& variable, std::size_t axis);
/// Returns notes on attributes of the variable, and of the groups that it is in, that are not read.
std::vector<std::string> zarr_notes(const ZarrVariable& variable, const std::string& name);
/// Returns notes on what a variable of named axes says of its grid and is not read.
std::vector<std::string> zarr_notes(const ZarrVariable& variable, const std::string& name,
                                    const VolumeAxes& axes);

}  // namespace pellucid
