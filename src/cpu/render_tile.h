// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "frame.h"
#include "pixel.h"

namespace pellucid {

/// Renders the pixels of the tile into the image, and adds them to the report. What a pixel becomes
/// depends on nothing but the frame and its place: neither on the tile nor on the thread.
void render_tile(const Frame& frame, const Tile& tile, const ImageView& image,
                 RenderReport& report);

}  // namespace pellucid
