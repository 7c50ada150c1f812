// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "volumes/components.h"

namespace pellucid {

/// Whether a file is a header of Inviwo or Voreen: lines "Key: value", one of which names the file
/// of values.
bool is_dat_header(const std::filesystem::path& path);

/// Such a header (.dat) and its file of values. Of Voreen the spacing (SliceThickness), of Inviwo
/// basis vectors and offset, which span the cells that the values are the centres of. Throws Error.
VolumeFile open_dat(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
