// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/io/scene_json.h"

namespace pellucid {

/// Returns whether the data of a layer are placed in the space of a patient (LPS), as their files
/// say.
bool is_of_patient(const LayerDescription& layer);

}  // namespace pellucid
