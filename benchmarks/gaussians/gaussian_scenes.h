// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/scenes/peers.h"

/// Scenes of several channels behind Gaussian primitives. `points`: data values per axis of fields
/// that are computed.
namespace pellucid::bench {

/// Reads or computes what it shows when it is called: scans need not be in memory together.
struct GaussianScene {
  std::string name;
  std::function<Scene(ImageSize size)> make;
};

/// The field of Marschner and Lobb, in [0,1], behind three primitives of one width.
GaussianScene width_scene(int points, double width);

/// Engine and brain by value and gradient magnitude, a patient's head in three contrasts; without
/// those whose files are missing.
std::vector<GaussianScene> scan_scenes();
/// The names of those.
std::vector<std::string> missing_scan_scenes();

/// The same field behind `count` primitives: each at a value of its own, or all at one, with the
/// extinction of one together.
GaussianScene primitives_scene(int points, int count, bool apart);
/// So many smooth fields behind two primitives that look at all of them.
GaussianScene channels_scene(int points, int channels);

}  // namespace pellucid::bench
