// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command.h"
#include "pellucid/cpu/renderer.h"
#include "scene_state.h"
#include "server/page_server.h"

namespace pellucid::view {

/// Renders the scene small, with another function of one layer, and returns a binary message: the
/// header {"type": "thumbnail", "layer", "function", "width", "height"}, and pixels as frames have
/// them. Throws Error.
PageMessage thumbnail_message(const SceneState& state, const AskThumbnail& ask, Renderer& renderer);

}  // namespace pellucid::view
