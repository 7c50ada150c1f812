// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// What follows the rays of a frame, made for its data, transfer function and method.
class RayTracer {
 public:
  RayTracer() = default;
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;
  virtual ~RayTracer() = default;

  /// What the rays (in the world, directions of length 1) gather. Safe to call from any thread.
  /// `share`: of the tolerance, what they may be off by; less than 1 where others are to be taken
  /// from them, by what surroundings() tell.
  virtual std::vector<RayResult> trace(const std::vector<Ray<double>>& world,
                                       double share) const = 0;

  /// What there is to find out between rays.
  struct Surroundings {
    const Volume& volume;  ///< whose grid it is
    ClassifiedBlocks blocks;
    double longest_step;  ///< voxels: how far apart rays may be at most
  };
  /// None: nothing is known of what is between rays.
  virtual std::optional<Surroundings> surroundings() const { return std::nullopt; }
};

/// What is to be followed: a layer of a scene that check_method() accepts. Both must outlive the
/// tracer; what is needed of the data's blocks is made on so many threads.
struct TracerTask {
  const Scene& scene;
  const Layer& layer;  ///< the one that is followed, in its place (moved_into_place())
  const RenderOptions& options;
  RayTolerance wanted;
  int threads = 1;
};

/// Of any number of layers, of any kind, with clips: the general path. The layers must outlive it.
std::unique_ptr<const RayTracer> make_layered_tracer(const TracerTask& task,
                                                     const std::vector<Layer>& layers);
/// Of a volume with a transfer function. Null where the layer or the scene has clips and packets do
/// not suit the rays.
std::unique_ptr<const RayTracer> make_univariate_tracer(const TracerTask& task);
/// Of channels with a multivariate transfer function.
std::unique_ptr<const RayTracer> make_multivariate_tracer(const TracerTask& task);
/// Of a mesh with either function.
std::unique_ptr<const RayTracer> make_mesh_tracer(const TracerTask& task);
/// The same, by one of the methods for comparison.
std::unique_ptr<const RayTracer> make_mesh_sampler(const TracerTask& task);

}  // namespace pellucid
