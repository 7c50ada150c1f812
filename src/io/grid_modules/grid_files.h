// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "pellucid/io/internal/module.h"
#include "volumes/components.h"

namespace pellucid {

/// A format whose library is loaded as a module, and called in a process of its own.
struct GridFormat {
  Module module;
  const char* wanted;  ///< what a volume is among a file's arrays
};

/// Opens a file by the format's module. `format` must outlive what is returned. Throws Error.
VolumeFile open_grid(const std::filesystem::path& path, const ReadOptions& options,
                     const GridFormat& format);
/// Lists the arrays of a file. Of the options only axes count. Throws Error.
std::vector<VolumeArray> list_grid_arrays(const std::filesystem::path& path,
                                          const GridFormat& format, const ReadOptions& options);

}  // namespace pellucid
