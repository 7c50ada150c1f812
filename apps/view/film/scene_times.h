// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/io/film.h"

namespace pellucid::view {

/// Takes the times of its steps out of a scene's sources where one "time" of the scene says the
/// same, and returns the times of all sources that follow it. A source that keeps a time of its own
/// follows none; nor does one whose time a track moves.
SceneTimes take_times(SceneDescription& description);

}  // namespace pellucid::view
