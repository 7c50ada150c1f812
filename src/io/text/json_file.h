// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "json_document.h"

namespace pellucid {

/// A JSON document with its name for messages. Nodes of it must not outlive it.
struct JsonFile {
  nlohmann::json value;
  std::string name;

  scene_json::Node root() const { return {value, name}; }
};

/// Reads JSON as programs in Python write it: the words NaN, Infinity and -Infinity become strings.
/// Throws Error with line and column; also for more than 64 levels of nesting.
JsonFile parse_data_json(std::string_view text, const std::string& name);
/// Returns the same of a file, of 256 MiB at most.
JsonFile read_data_json(const std::filesystem::path& path);

/// Returns `folder` / `relative`, where a file names `relative`. Throws Error that begins with
/// `name` for a path that is absolute or leaves the folder.
std::filesystem::path path_inside(const std::filesystem::path& folder, const std::string& relative,
                                  const std::string& name);

}  // namespace pellucid
