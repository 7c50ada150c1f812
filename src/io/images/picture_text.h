// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pellucid {

/// Returns a text of the metadata of a .png or .exr; none: it has none, or the file is cut off or
/// damaged anywhere: all of it is decoded.
std::optional<std::string> picture_text(const std::filesystem::path& path, const std::string& key);

}  // namespace pellucid
