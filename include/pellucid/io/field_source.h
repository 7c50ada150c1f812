// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pellucid/io/read_volume.h"

namespace pellucid {

/// A field as named in a scene: a file, or a built-in field with its size.
struct FieldSource {
  std::filesystem::path file;  ///< empty: built-in
  ReadOptions options;
  std::string builtin;  ///< one of builtin_field_names()
  int points = 128;     ///< per axis; built-in
};

/// Parses "builtin:NAME", "builtin:NAME:POINTS" or the path of a file. Throws Error if the name is
/// unknown or the number of points is out of range.
FieldSource parse_field_source(std::string_view text);

/// Reads the file or makes the built-in field. Throws Error.
Volume load_field(const FieldSource& source);

}  // namespace pellucid
