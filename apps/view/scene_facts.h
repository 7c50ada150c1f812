// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.h"
#include "overlay.h"
#include "scene_state.h"

namespace pellucid::view {

/// Choices within the file of a layer.
struct FileChoices {
  int components = 1;  ///< steps of time, colors
  std::vector<std::string> arrays{};
  std::vector<double> times{};  ///< of a mesh
};

/// Returns the choices of each layer that are known without a look at the values: components.
std::vector<FileChoices> file_choices(const SceneDescription& description);
/// Returns all choices of a layer of a field or a mesh. Reads all of its file. Throws Error.
FileChoices all_choices(const LayerDescription& layer);
/// Returns letters and unit: those of a patient if all layers come from medical files.
Lettering lettering_of(const SceneDescription& description);

/// Returns the message that tells pages what is shown:
///
///   {"type": "scene", "scene": (scene file), "savable", "temporary": (whether its data go with the
///    program), "layers": [{"kind", "channels", "range", "ranges" (of each channel), "steps"
///    (slice_steps_json()), "components", "arrays", "times"}], "box": {"lower", "upper"},
///    "timeline": {"times", "time_unit" (text of the file, may be empty), "times_left_out" (how
///    many no scene can name), "time", "follows" (whether each layer follows the time), "has_film",
///    "seconds", "fps", "frames", "frame", "keyframes": [{"at", "camera", "parts"}], "keyframe"
///    (the one that the frame is), "moves_data" (whether the time moves), "by_steps" (whether each
///    step is shown equally long), "turns", "formats" (in which films are saved here)}, "presets":
///    [...], "sides": [...], "anatomical", "can_undo", "can_redo"}
Json scene_json(const SceneState& state, const std::vector<FileChoices>& choices);

}  // namespace pellucid::view
