// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "pellucid/io/scene_json.h"

namespace pellucid {

/// Makes the field of a layer its labels, which have no light, if it has no labels yet.
inline void show_as_labels(LayerDescription& layer) {
  if (layer.labels) return;
  layer.labels = LabelSource{std::exchange(layer.field, {}), {}, {}, {}};
  layer.shading.reset();
}
/// Returns whether choose_look() says how a layer is shown.
bool takes_look(const LayerDescription& description);
/// Return the look of such a layer with these data. Throw Error.
Look look_of(const Volume& volume, const LayerDescription& description);
Look look_of(const MeshChannels& mesh, const LayerDescription& description);
/// Return the function of one variable that a description says of a layer, or leaves to these
/// data, before function_change. An opacity table is none. Throw Error.
TransferFunction function_on(const Volume& volume, const LayerDescription& description);
TransferFunction function_on(const MeshChannels& mesh, const LayerDescription& description);

}  // namespace pellucid
