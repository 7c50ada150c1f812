// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device/kept_devices.h"
#include "layers/layer_setups.h"
#include "pellucid/cpu/render.h"
#include "pellucid/cpu/renderer.h"

namespace pellucid {

/// Renders a frame with what is kept of others. `threads` > 0. As pellucid::render().
Image render_frame(const Scene& scene, const RenderOptions& options, int threads, LayerSetups& kept,
                   KeptDevices& devices, RenderReport* report);

/// Renders pixels again, as Renderer::render_pixels() does.
Image render_pixels(const Scene& scene, const RenderOptions& options,
                    const std::vector<PixelRequest>& requests, int threads, LayerSetups& kept,
                    RenderReport* report);

}  // namespace pellucid
