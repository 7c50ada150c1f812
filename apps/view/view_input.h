// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pellucid/scene/volume.h"
#include "viewer.h"

namespace pellucid::view {

/// Reads a scene, a volume, a mesh or "builtin:NAME[:POINTS]" for pages that have no command line:
/// what its options change is as it is without them. Throws Error.
ViewedScene view_input(const std::string& input, const ParallelFor& parallel);

}  // namespace pellucid::view
