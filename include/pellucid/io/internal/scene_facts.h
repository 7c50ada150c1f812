// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pellucid/scene/scene.h"

namespace pellucid {

/// A part of a scene: its name for messages, and its values as a line of text.
struct SceneFact {
  std::string name;
  std::string text;
};

/// Returns all that makes the picture of a scene beside its data, part by part. Two scenes have the
/// same text where all numbers of the part are the same to the bit; functions and pictures are told
/// by a checksum. The number of layers comes first.
std::vector<SceneFact> scene_facts(const Scene& scene);

}  // namespace pellucid
