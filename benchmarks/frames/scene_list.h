// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tests/scenes/peers.h"

namespace pellucid::bench {

using scenes::NamedScene;

struct SceneSelection {
  ImageSize size;
  bool all_views = false;            ///< every scene of tests/scenes instead of one view of each
  bool tiny = false;                 ///< small data, for trying the program out
  std::vector<std::string> filters;  ///< parts of the names wanted; none: all

  bool wants(const std::string& name) const;
};

/// Calls visit(scene) for the chosen scenes, one after another, so that scans need not be in memory
/// together. Scans whose file is missing are passed over; their names are returned.
template <class Visit>
std::vector<std::string> for_each_scene(const SceneSelection& selection, Visit&& visit);

std::vector<std::vector<NamedScene> (*)(const SceneSelection&)> scene_groups();
std::vector<std::string> missing_scans();

template <class Visit>
std::vector<std::string> for_each_scene(const SceneSelection& selection, Visit&& visit) {
  for (const auto group : scene_groups()) {
    for (const NamedScene& named : group(selection)) {
      if (selection.wants(named.name)) visit(named);
    }
  }
  return missing_scans();
}

}  // namespace pellucid::bench
