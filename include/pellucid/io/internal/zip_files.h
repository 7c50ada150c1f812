// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace pellucid {

/// Writes a zip archive of files, each by its name without its folder. The same files give the same
/// archive. Throws Error if one cannot be read, or the archive cannot be written; then none is
/// left.
void write_zip(const std::filesystem::path& path, const std::vector<std::filesystem::path>& files);

}  // namespace pellucid
