// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid::cluster_tests {

struct NamedScene {
  std::string name;
  Scene scene;
  bool slow = false;             ///< left out of the short run
  bool faces_on_values = false;  ///< bricks meet at values of the grid, not between them
  /// To the scene's own tolerance, which one process does not meet everywhere: ranks must not have
  /// more pixels over it.
  bool is_hard = false;
};

/// Scenes of all kinds of layers, looks and cameras, that are rendered in bricks.
std::vector<NamedScene> rank_scenes(int size);

}  // namespace pellucid::cluster_tests
