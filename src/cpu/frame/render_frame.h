// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device/device_cache.h"
#include "layers/layer_setups.h"
#include "pellucid/cpu/render.h"
#include "pellucid/cpu/renderer.h"

namespace pellucid {

/// Throws Error unless render() takes the scene and the options.
void check_frame(const Scene& scene, const RenderOptions& options);

/// Returns an image of the scene's size with the outputs of the options, all of them 0.
Image make_image(ImageSize size, const FrameOutputs& outputs);

/// Renders a frame that passed its checks, with what is kept of others, into memory of its size.
/// `threads` > 0. The options' outputs are those for which there is memory.
RenderReport render_frame(const ImageView& image, const Scene& scene, const RenderOptions& options,
                          int threads, LayerSetups& kept, DeviceCache& devices);

/// Renders pixels again, as Renderer::render_pixels() does.
RenderResult render_pixels(const Scene& scene, const RenderOptions& options,
                           const std::vector<PixelRequest>& requests, int threads,
                           LayerSetups& kept);

}  // namespace pellucid
