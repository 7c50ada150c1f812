// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid {

/// Names of the views along the axes of an LPS world, and "oblique".
const std::vector<std::string>& view_names();

/// A perspective camera on the named side of a box (world_corners) that just holds it, with 3 % to
/// spare. In a world of LPS, "front" looks at a face, "left" at the patient's left side, and "top"
/// and "bottom" have the face up. "oblique" is default_camera(). The name is one of view_names().
Camera view_camera(const std::array<Vec3<double>, 8>& corners, std::string_view name,
                   ImageSize size);

}  // namespace pellucid
