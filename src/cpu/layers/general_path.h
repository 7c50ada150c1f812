// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "bundle.h"
#include "clipped_layer.h"
#include "lit_parts.h"
#include "ray_tracer.h"

namespace pellucid {

class MultivariateRayIntegrator;

/// The general path. In: any number of layers of any kind, with clips. Out: what a part of a ray
/// gathers, within its tolerance, in both grades. Each layer turns a ray into a stream of stretches
/// on which its channels are polynomials (layer_stream.h). The streams are merged: between two ends
/// of any stretch, the layers that are present are one function of all of their channels
/// (bundle.h), a sum of terms, which MultivariateRayIntegrator cuts and integrates; where any of
/// them has light or gradient opacity, lit panels take the place of that function (lit_parts.h).
/// Surfaces are met between the stretches (surface_events.h). Called by SceneTracer for all that no
/// faster tracer is for. Used by one thread.
class GeneralPath {
 public:
  /// `layers` and `lights` must outlive the object.
  GeneralPath(const std::vector<ClippedLayer>& layers,
              const std::vector<LightSource<double>>& lights, const RayTolerance& wanted);
  ~GeneralPath();
  GeneralPath(const GeneralPath&) = delete;
  GeneralPath& operator=(const GeneralPath&) = delete;

  /// Returns what the part gathers, off by at most `tolerance`; what clips' positions are off by is
  /// not counted.
  RayResult integrate(const RayPart& part, double tolerance);
  /// Returns the position at which the optical depth, counted from the begin of the part, reaches
  /// `depth`; where the data end if it never does.
  double find_depth(const RayPart& part, double depth);

 private:
  class ClippedStream;

  RayResult follow(const RayPart& part, double tolerance, double target, double* position);
  long merge(const Ray<double>& ray, Interval<double> inside,
             MultivariateRayIntegrator& integrator);
  void add_lit(const Ray<double>& ray, Interval<double> range, double left_out,
               double position_error, MultivariateRayIntegrator& integrator);
  double meet_surfaces(double t, MultivariateRayIntegrator& integrator);

  RayTolerance wanted_;
  const std::vector<LightSource<double>>& lights_;
  LitParts parts_;
  std::vector<const LayerSource*> sources_;
  std::vector<ClippedStream> streams_;
  Bundles bundles_;
  std::vector<int> key_;                    ///< for each layer the function that is present, or -1
  MultivariateTransfer<double> nothing_{};  ///< before the first stretch
  double largest_extinction_ = 0;
  bool surfaces_ = false;  ///< whether any layer has some
};

}  // namespace pellucid
