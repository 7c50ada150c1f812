// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pellucid {

/// Throws Error where a file of NetCDF's classic formats (versions 1, 2 and 5) is shorter than its
/// header says by the lengths of axes: its library gives zeros there, or what it read before. Files
/// of other formats are passed over.
void check_net_cdf_size(const std::filesystem::path& path);

}  // namespace pellucid
