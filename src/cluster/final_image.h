// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/cluster/ray_pixel.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// Returns the scene of a part of a frame: a pixel for each ray, and the tolerance divided by the
/// number of bricks that a ray may meet.
Scene scene_of_rays(const Scene& scene, int bricks);
/// Returns the pixels of a part that render() made of scene_of_rays().
std::vector<RayPixel> to_ray_pixels(const Image& image);
/// Returns the rays of the pixels that report more than the tolerance.
std::vector<std::size_t> rays_over_tolerance(const Scene& scene, const std::vector<RayPixel>& rays);
/// Makes the image of the composited rays: composites them over the backdrop, and takes the mean of
/// each pixel's. Puts what is known of its errors into the report. `depth`: for each ray, if it is
/// asked for; else empty.
Image final_image(const Scene& scene, const RenderOptions& options,
                  const std::vector<RayPixel>& rays, const std::vector<float>& depth,
                  RenderReport& report);

}  // namespace pellucid
