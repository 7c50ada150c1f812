// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid::scenes {

struct DeviceExample {
  std::string name;
  Scene scene;
};

/// A scene for each function of a card: one variable unlit, with vacuum, lit, with gradient opacity
/// and before a backdrop, several variables, and both kinds of meshes.
std::vector<DeviceExample> device_examples(int size);

}  // namespace pellucid::scenes
