// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "volumes/components.h"

namespace pellucid {

/// Inviwo's XML header (.ivf) and its file of values, which may be gzipped. Its BasisAndOffset
/// spans the cells that the values are the centres of, in the world that WorldTransform says.
/// Throws Error, also for several files of values.
VolumeFile open_ivf(const std::filesystem::path& path, const ReadOptions& options);

}  // namespace pellucid
