// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line.h"
#include "pellucid/io/scene_json.h"

namespace pellucid::cli {

/// The options about light, isosurfaces and slices.
struct LightArguments {
  std::string shading;
  std::vector<std::string> lights, isosurfaces, slices;

  void add_to(CommandLine& command);
  /// Returns the name of an option that is about one layer and was given; empty: there is none.
  std::string option_of_a_layer() const;
  /// Puts the surfaces and the shading over what the layer says. Throws UsageError.
  void apply(LayerDescription& layer) const;
  /// Replaces the lights of the scene if any are given. Throws UsageError.
  void apply(SceneDescription& scene) const;
};

/// Gives the layer the shading and the gradient opacity of a transfer function's file, where it has
/// none of its own; where they do not apply, a note says so. `file` begins the note.
void take_look(const std::optional<Shading>& shading,
               const std::shared_ptr<const GradientOpacity>& gradient_opacity,
               const std::string& file, LayerDescription& layer, std::vector<std::string>& notes);

}  // namespace pellucid::cli
