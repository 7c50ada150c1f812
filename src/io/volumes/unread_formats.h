// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace pellucid {

/// Throws Error that names the format of a file or a folder that looks like one that is read, and
/// says what to do: stores of Zarr in a zip archive, stores of N5, files of MINC.
void refuse_unread_format(const std::filesystem::path& path);

/// Throws Error for a file that no format takes: it is a mesh, or its extension is not known.
[[noreturn]] void refuse_unknown_format(const std::filesystem::path& path);

}  // namespace pellucid
