// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

/// The value of a projected layer along one ray.
struct RayValue {
  /// NaN where the ray meets no data; of a sum 0.
  double value = std::numeric_limits<double>::quiet_NaN();
  /// Proved bounds on the exact value. If nothing is known of an extreme, what it may be.
  double lower = 0, upper = 0;
  double length = 0, length_error = 0;  ///< of the ray in the data; of sums only
  bool has_data = false;
  /// True if rounding decides whether the ray meets data, or which of two values they have: nothing
  /// is known.
  bool is_unknown = false;
  long cells = 0;  ///< visited
};

/// The values of one projected layer along the rays of a frame, in a form in which parts of rays
/// can be joined: numbers of each ray, row by row.
struct ProjectedRays {
  LayerProjection projection = LayerProjection::maximum;
  /// Results by ray: of extremes the value and its bounds, infinite where there are no data; joined
  /// by the larger number, of minima by the smaller. Of means and sums the sum and its bounds;
  /// joined by addition.
  std::vector<double> value, lower, upper;
  std::vector<double> length, length_error;  ///< of means; joined by addition
  std::vector<double> data, unknown;         ///< 0 or 1; joined by the larger

  /// Returns the value of a ray of which all parts are joined.
  RayValue at(std::size_t ray) const;
};

/// Projects a layer of a scene along the rays of its pixels, one for each, in the region of the
/// options if there is one. Uses of the options also the threads, progress and the stop token.
/// Throws Error as render() does, also if the layer is not projected, and Cancelled.
ProjectedRays project_layer(const Scene& scene, std::size_t layer, const RenderOptions& options);

/// Shows the projected layers of a scene.
class ProjectionColors {
 public:
  /// Shares the functions of the scene's layers.
  explicit ProjectionColors(const Scene& scene);
  ~ProjectionColors();

  /// Returns the indices of the visible projected layers, in their order.
  const std::vector<std::size_t>& layers() const noexcept { return layers_; }
  /// Puts the layers' values along a ray, in this order, over what other layers gather on it.
  void put_over(const std::vector<RayValue>& values, RayResult& ray) const;

 private:
  struct Colors;

  std::vector<std::size_t> layers_;
  std::unique_ptr<const Colors> colors_;
};

}  // namespace pellucid
