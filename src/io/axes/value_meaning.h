// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pellucid/scene/volume.h"
#include "variable_attributes.h"

// The meaning of stored numbers by the attributes of the CF conventions. NetCDF, HDF5 and Zarr
// share it. Needs pellucid::scene alone.

namespace pellucid {

/// value = scale · stored + offset; missing values are NaN.
struct ValueMeaning {
  double scale = 1, offset = 0;
  std::vector<double> missing;  ///< stored numbers
  /// The number that the library writes where nothing is written; missing, too.
  std::optional<double> default_fill;
  double least = -std::numeric_limits<double>::infinity();  ///< smaller ones are missing
  double most = std::numeric_limits<double>::infinity();    ///< larger ones are missing
  bool range_is_scaled = false;  ///< whether least and most are values and not stored numbers

  bool is_scaled() const { return scale != 1 || offset != 0; }
  bool has_range() const;
  /// Returns whether any value may be missing.
  bool may_miss() const { return !missing.empty() || default_fill || has_range(); }
};

/// Returns what attributes say of values of this stored type ("i16"). `name` is the variable's.
/// `notes` is told what is not applied. Throws Error for a scale or an offset that is no number.
ValueMeaning value_meaning(const VariableAttributes& attributes, const std::string& type,
                           const std::string& name, std::vector<std::string>& notes);

/// Returns the type of values that are scaled or missing: "f32" or "f64".
std::string type_with_meaning(const std::string& stored_type);

/// Values of the default fill that were found, and how many.
struct DefaultFills {
  double number = 0;
  std::size_t count = 0;
};

/// Turns components of one file into values. Where nothing is scaled and nothing missing in any of
/// them, they stay as they are. Returns how many values are missing by the default fill.
DefaultFills apply_meaning(std::span<VolumeData> components, const ValueMeaning& meaning);
/// Turns positions, doubles that were stored in this type, into values; missing ones are NaN.
void apply_meaning(std::span<double> positions, const std::string& type,
                   const ValueMeaning& meaning);
/// Returns the note on them: "20 values are -32767, ..."; empty where there are none.
std::string note_of(const DefaultFills& fills, const std::string& name);

/// Returns the names by which other programs call scales, missing values and placements, whatever
/// the case of their letters and what stands between their words.
std::vector<std::string> other_conventions(const std::vector<std::string>& names);

/// Returns one note on each attribute that could change the picture and is not read.
std::vector<std::string> notes_on_unread(const VariableAttributes& attributes,
                                         const std::string& name);
/// Returns a note on such attributes of a group that the variable is in; empty: it has none.
std::string note_on_group(const VariableAttributes& attributes, const std::string& group,
                          const std::string& name);

}  // namespace pellucid
