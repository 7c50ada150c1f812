// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "layers/layer_setups.h"
#include "pellucid/cpu/render.h"
#include "pellucid/scene/scene.h"
#include "ray_tracer.h"

namespace pellucid {

class ProjectedTracer;

/// Pixels first … end - 1 along each side.
struct PixelBox {
  int first_column = 0, end_column = 0, first_row = 0, end_row = 0;

  bool contains(int column, int row) const noexcept {
    return column >= first_column && column < end_column && row >= first_row && row < end_row;
  }
};

/// Data that every pixel of the frame shares.
struct Frame {
  /// Prepares a frame. `scene` must outlive it. Set-ups of layers come from `kept`, and those that
  /// are missing are made on so many threads.
  Frame(const Scene& scene, const RenderOptions& options, int threads, LayerSetups& kept);

  const Scene& scene;
  std::shared_ptr<const RayRegion> region;  ///< null: everything
  CameraFrame<double> camera;
  PixelBox seen;         ///< pixels outside of it have nothing of the region
  double tolerance;      ///< what rays may be off by
  double reserved;       ///< of the tolerance: what the transfer function is off by
  double largest_color;  ///< of the visible layers' functions and the backdrop
  std::unique_ptr<const RayTracer> tracer;
  /// The set-up of the only visible layer, unless it has clips or is projected; null otherwise.
  std::shared_ptr<const LayerSetup> only_layer;
  const ProjectedTracer* projected = nullptr;  ///< the tracer, if there are projected layers
};

}  // namespace pellucid
