// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/scene.h"
#include "ray_tracer.h"

namespace pellucid {

/// What every pixel of the frame shares.
struct Frame {
  /// `scene` must outlive the frame. The blocks of its data are made on so many threads where the
  /// method needs them.
  Frame(const Scene& scene, const RenderOptions& options, int threads);

  const Scene& scene;
  std::vector<Layer> layers;  ///< the visible ones, in their places
  CameraFrame<double> camera;
  double tolerance;  ///< what rays may be off by
  double reserved;   ///< of the tolerance: what the transfer function is off by
  std::unique_ptr<const RayTracer> tracer;
};

}  // namespace pellucid
