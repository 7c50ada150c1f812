// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "pellucid/cpu/internal/projected_rays.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/scene/layer.h"

namespace pellucid {

/// Memory that one call keeps from ray to ray. Used by one thread.
struct ProjectionWorkspace {
  ProjectionWorkspace() = default;
  ProjectionWorkspace(const ProjectionWorkspace&) = delete;
  ProjectionWorkspace& operator=(const ProjectionWorkspace&) = delete;
  virtual ~ProjectionWorkspace() = default;
};

/// Projects one layer along rays.
class LayerProjector {
 public:
  LayerProjector() = default;
  LayerProjector(const LayerProjector&) = delete;
  LayerProjector& operator=(const LayerProjector&) = delete;
  virtual ~LayerProjector() = default;

  virtual std::unique_ptr<ProjectionWorkspace> workspace() const = 0;
  /// Returns the value along a ray (world, direction of length 1) from 0 to `end`. The workspace is
  /// one of workspace().
  virtual RayValue project(const Ray<double>& ray, double end,
                           ProjectionWorkspace& workspace) const = 0;
};

/// Parameters of a layer's projector.
struct ProjectorTask {
  const Layer& layer;       ///< in its place; must outlive the projector
  std::vector<Clip> clips;  ///< of the layer and of the scene
  ParallelFor parallel;
};

/// Makes the projector of a layer that check_layer() accepts.
std::unique_ptr<const LayerProjector> make_layer_projector(const ProjectorTask& task);

// By kind of data:
std::unique_ptr<const LayerProjector> make_grid_projector(const ProjectorTask& task);
std::unique_ptr<const LayerProjector> make_mesh_projector(const ProjectorTask& task);

}  // namespace pellucid
