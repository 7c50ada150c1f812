// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "device_cache.h"
#include "frame/frame.h"

namespace pellucid {

/// Returns why the CPU has to follow the rays of a frame in place of a device; empty if it has not.
std::string reason_for_cpu(const Frame& frame, const RenderOptions& options);

/// Renders a frame, for which there is no reason_for_cpu(), on a device: its pixels into the image,
/// what it did into the report. Pixels that the device leaves go to the CPU. Throws Cancelled, and
/// Error if the device fails.
void render_on_device(const Frame& frame, const RenderOptions& options, CachedDevice& device,
                      const ImageView& image, RenderReport& report);

}  // namespace pellucid
