// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/scene.h"

namespace pellucid {

/// A transfer function that gives a good first picture of the volume, from its histogram and its
/// size in the world. Never throws for a valid volume (a constant or all-NaN one included).
TransferFunction default_transfer_function(const Volume& volume);

/// A perspective camera that sees the whole volume, obliquely from the front.
Camera default_camera(const Volume& volume, ImageSize size);

}  // namespace pellucid
