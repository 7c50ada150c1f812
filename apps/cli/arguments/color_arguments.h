// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "command_line.h"
#include "pellucid/io/scene_json.h"

namespace pellucid::cli {

/// The options that change the colors, the range and the opacity of a layer's function.
struct ColorArguments {
  std::string colormap, range;
  std::optional<double> opacity;

  void add_to(CommandLine& command);
  /// Returns the first option that is given and is for the function of one layer; empty: none is.
  std::string option_of_a_layer() const;
  /// Returns whether the range depends on the data.
  bool asks_data() const { return range.find('%') != std::string::npos; }
  /// Puts the change into the description of a layer, whose function is set. Throws UsageError.
  void apply(LayerDescription& layer) const;
};

}  // namespace pellucid::cli
