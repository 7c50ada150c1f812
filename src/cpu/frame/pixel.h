// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "frame.h"
#include "pellucid/cpu/render.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/image_view.h"

namespace pellucid {

/// Puts the pixel into the image, and what it is off by into the report.
void store_pixel(const Frame& frame, const RayResult& result, std::size_t pixel,
                 const ImageView& image, RenderReport& report);

/// Adds the counts of a pixel's rays.
void add_work(RenderReport& sum, const RayResult& result);

/// Adds a part of a report: that of one tile, or the whole.
void add(RenderReport& sum, const RenderReport& part);

}  // namespace pellucid
