// SPDX-License-Identifier: Apache-2.0
//
// Stands in where a page has no threads, and no files but those that it shows.
#include "steps_choice.h"

namespace pellucid::view {

StepsChoice::StepsChoice(SceneDescription, SceneTimes, ParallelFor, Done) {}

StepsChoice::~StepsChoice() = default;

void StepsChoice::wait() {}

}  // namespace pellucid::view
