// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "view/command.h"

namespace pellucid::view {

/// Returns the message that lists a folder; a relative one is of the program's working directory:
///
///   {"type": "folder", "path", "parent": (null at the top), "home", "left_out": (how many),
///    "entries": [{"name", "folder": true}, {"name", "bytes", "known"}]}
///
/// Folders come first, names in alphabetical order. Hidden files are left out, what is neither a
/// file nor a folder, and names that are not UTF-8. `known`: whether the name is that of a format.
/// Throws Error if the folder cannot be read.
Json folder_json(const std::string& folder);

}  // namespace pellucid::view
