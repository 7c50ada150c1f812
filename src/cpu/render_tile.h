// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "between_pixels.h"
#include "frame.h"
#include "pixel.h"

namespace pellucid {

/// Renders the pixels of the tile into the image, and adds them to the report. What a pixel becomes
/// depends on nothing but the frame and its place: neither on the tile nor on the thread.
///
/// With `between` these are pixels of its level `level`: all of the coarser ones must be done.
/// Null: all are traced. Gives how many of them were not final before.
std::size_t render_tile(const Frame& frame, const Tile& tile, int level, BetweenPixels* between,
                        const ImageView& image, RenderReport& report);

}  // namespace pellucid
