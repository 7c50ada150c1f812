// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "pellucid/io/read_volume.h"

namespace pellucid {

/// A field as a scene names it: a file, or a built-in field with its size.
struct FieldSource {
  std::filesystem::path file;  ///< empty: built-in
  ReadOptions options;
  std::string builtin;  ///< one of builtin_field_names()
  int points = 128;     ///< per axis; built-in
};

/// "builtin:NAME" and "builtin:NAME:POINTS" are built-in fields; anything else is a file's path.
/// Throws Error for an unknown name or a wrong number of points.
FieldSource parse_field_source(std::string_view text);

/// Reads the file or makes the built-in field. Throws Error.
Volume load_field(const FieldSource& source);

}  // namespace pellucid
