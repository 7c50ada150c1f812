// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pellucid {

/// Throws Error where the list of a TIFF file's pages leads out of the file: libtiff 4.5 takes the
/// list to end there, and a file that is cut off to have fewer pages. Files that do not begin like
/// TIFF are left to libtiff.
void check_tiff_chain(const std::filesystem::path& file);

}  // namespace pellucid
