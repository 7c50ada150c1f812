// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pellucid {

/// Throws Error where an OpenVDB file is shorter than its own list of grids says: OpenVDB itself
/// may take such a file's bytes for sizes and ask for any amount of memory.
void check_vdb_size(const std::filesystem::path& path);

}  // namespace pellucid
