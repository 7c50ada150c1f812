// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/scene/scene.h"

namespace pellucid::scenes {

/// 64 bits (FNV-1a) of all that the exact picture depends on: data and placement, transfer
/// function, camera, size and samples. Not of the integration.
std::uint64_t scene_hash(const Scene& scene);

}  // namespace pellucid::scenes
