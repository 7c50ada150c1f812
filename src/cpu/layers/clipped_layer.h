// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "clip_intervals.h"
#include "layer_setup.h"

namespace pellucid {

/// A visible layer of a frame, with the clips of its own and of the scene.
struct ClippedLayer {
  std::shared_ptr<const LayerSetup> setup;
  std::vector<Clip> clips;
};

}  // namespace pellucid
