// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid::bench {

/// The reference image of a scene, from the folder if it was made before: the file's name is a hash
/// of the data, the transfer function, the camera and the size. An empty folder: always rendered.
Image cached_reference(const Scene& scene, const std::filesystem::path& folder);

}  // namespace pellucid::bench
