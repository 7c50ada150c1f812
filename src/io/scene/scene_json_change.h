// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "pellucid/io/scene_json.h"

namespace pellucid {

/// Changes the function of a layer that has its data by description.function_change. Throws Error,
/// also if there is a change and the layer has no function of one variable.
void change_function(const LayerDescription& description, Layer& layer);

/// Returns the description's function; an opacity table is changed for the layer's data. Throws
/// Error.
std::optional<TransferFunctionDescription> changed_table(const LayerDescription& description,
                                                         const Layer& layer);

/// Writes the changed function of a layer into its description, which then has no change. Throws
/// Error.
void write_changed_function(const Layer& layer, LayerDescription& description);

}  // namespace pellucid
