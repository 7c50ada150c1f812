// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "layer_projector.h"
#include "ray_tracer.h"
#include "shown_value.h"

namespace pellucid {

/// Puts projected layers over what another tracer gathers, later layers over earlier ones.
class ProjectedTracer : public RayTracer {
 public:
  /// Takes all layers of a scene. `layers`: the projected ones, in their places. `others`: of all
  /// other layers; null if there are none. `clips`: of the scene. `largest_color`: of all layers
  /// and of the background.
  ProjectedTracer(std::vector<Layer> layers, std::unique_ptr<const RayTracer> others,
                  const std::vector<Clip>& clips, double largest_color,
                  const ParallelFor& parallel);

  bool keeps_to_ranges() const override { return true; }
  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& options) const override {
    return trace(parts, options, nullptr);
  }
  /// Returns the same; `values`, unless null, receives the value of the last layer along each ray.
  std::vector<RayResult> trace(const std::vector<RayPart>& parts, const TraceOptions& options,
                               std::vector<double>* values) const;

 private:
  /// The projected layers of one ray, in one.
  struct Front {
    ShownValue shown;
    long cells = 0;
  };
  Front front_of(const RayPart& part,
                 const std::vector<std::unique_ptr<ProjectionWorkspace>>& workspaces,
                 double* value) const;

  std::vector<Layer> layers_;
  std::vector<std::unique_ptr<const LayerProjector>> projectors_;
  std::vector<ValueColors> colors_;
  std::unique_ptr<const RayTracer> others_;
  double largest_color_;
};

}  // namespace pellucid
