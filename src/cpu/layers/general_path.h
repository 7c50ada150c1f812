// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "layer_merge.h"
#include "medium_parts.h"
#include "ray_tracer.h"

namespace pellucid {

class MultivariateRayIntegrator;

/// The general path. In: any number of layers of any kind, with clips. Out: what a part of a ray
/// gathers, within its tolerance, in both grades. Each layer turns a ray into a stream of stretches
/// on which its channels are polynomials (layer_stream.h). The streams are merged (layer_merge.h):
/// between two ends of any stretch, a MultivariateRayIntegrator integrates the layers that are
/// present (medium_parts.h). Called by SceneTracer for all that no faster tracer is for. Used by
/// one thread.
class GeneralPath {
 public:
  /// `layers` and `lights` must outlive the object.
  GeneralPath(const std::vector<ClippedLayer>& layers,
              const std::vector<LightSource<double>>& lights, const RayTolerance& wanted);
  GeneralPath(const GeneralPath&) = delete;
  GeneralPath& operator=(const GeneralPath&) = delete;

  /// Returns what the part gathers, off by at most `tolerance`; what clips' positions are off by is
  /// not counted.
  RayResult integrate(const RayPart& part, double tolerance);
  /// Returns the position at which the optical depth, counted from the begin of the part, reaches
  /// `depth`; where the data end if it never does.
  double find_depth(const RayPart& part, double depth);

 private:
  RayResult follow(const RayPart& part, double tolerance, double target, double* position);
  bool add(const MergedPart& part, const Ray<double>& ray, MultivariateRayIntegrator& integrator);

  RayTolerance wanted_;
  const std::vector<LightSource<double>>& lights_;
  LayerMerge merge_;
  MediumParts parts_;
  std::vector<std::vector<double>> at_mark_;  ///< transparency, by layer and isosurface
  MultivariateTransfer<double> nothing_{};    ///< before the first stretch
  double largest_extinction_ = 0;
};

}  // namespace pellucid
