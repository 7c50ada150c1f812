// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "clipped_layer.h"
#include "ray_tracer.h"

namespace pellucid {

/// Returns the tracer of all visible layers of a scene. In: their set-ups with their clips. Out:
/// what rays gather. A ray is cut where a layer may begin or end: where one layer is alone, its own
/// tracer follows it, in packets where it can; everything else goes the general path
/// (general_path.h). So layers side by side cost what each costs by itself. The parts are
/// composited front to back, and share the tolerance.
///
/// With a method other than `exact`, the only layer's sampler in packets follows whole rays, where
/// it has one; everything else is sampled ray by ray (sample/sampled_path.h).
std::unique_ptr<const RayTracer> make_scene_tracer(std::vector<ClippedLayer> layers,
                                                   const std::vector<Light>& lights,
                                                   const RayTolerance& wanted, bool depth);

}  // namespace pellucid
