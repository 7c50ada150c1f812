// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "pellucid/render/integrate_multivariate_ray.h"
#include "pellucid/render/sample_ray.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/multivariate_blocks_storage.h"
#include "ray_tracer.h"
#include "sampling_rule.h"
#include "threads.h"

namespace pellucid {
namespace {

/// Which extinction may be left out all along a ray: what it costs there is a share of the
/// tolerance.
double negligible_extinction(const TracerTask& task) {
  constexpr double share = 1.0 / 32;
  const auto corners = grid_volume(task.scene).world_corners();
  double diagonal = 0;
  for (const Vec3<double>& corner : corners) {
    diagonal = std::max(diagonal, length(corner - corners.front()));
  }
  return share * task.wanted.tolerance / (diagonal * std::max(task.wanted.largest_color, 1.0));
}

class MultivariateTracer : public RayTracer {
 public:
  explicit MultivariateTracer(const TracerTask& task)
      : integration_(task.scene.integration),
        channels_(*task.scene.channels),
        transfer_function_(*task.scene.multivariate),
        wanted_(task.wanted),
        depth_(task.options.depth),
        grid_(multichannel_grid(channels_)),
        transfer_(transfer_function_.view()),
        step_(integration_.step * channels_.grid().voxel_size()) {
    if (integration_.method == Method::preintegrated) {
      throw Error(
          "integration: the method preintegrated looks up a table of one variable, but the scene "
          "has channels; take another method");
    }
    if (integration_.method != Method::exact) return;
    storage_ = MultivariateBlocksStorage(channels_, transfer_function_, negligible_extinction(task),
                                         parallel_for(task.threads));
    blocks_ = storage_.view();
  }

  std::vector<RayResult> trace(const std::vector<Ray<double>>& world) const override {
    std::vector<RayResult> results;
    results.reserve(world.size());
    for (const Ray<double>& ray : world) {
      results.push_back(trace_one(channels_.grid().grid_from_world().ray(ray)));
    }
    return results;
  }

 private:
  RayResult trace_one(const Ray<double>& ray) const {
    if (integration_.method == Method::exact) {
      return integrate_multivariate_ray(grid_, &*blocks_, ray, transfer_,
                                        transfer_function_.largest_extinction(), wanted_, depth_);
    }
    return sample_multivariate_ray(grid_, ray, transfer_, sampling_rule(integration_.method), step_,
                                   transfer_function_.largest_color(), stop_tolerance<double>(),
                                   depth_);
  }

  const Integration& integration_;
  const Channels& channels_;
  const MultivariateTransferFunction& transfer_function_;
  RayTolerance wanted_;
  bool depth_;
  MultichannelGrid grid_;
  Multivariate<double> transfer_;
  double step_;  ///< of the sampling methods, world length
  MultivariateBlocksStorage storage_;
  std::optional<MultivariateBlocks> blocks_;  ///< of the exact method
};

}  // namespace

std::unique_ptr<const RayTracer> make_multivariate_tracer(const TracerTask& task) {
  return std::make_unique<MultivariateTracer>(task);
}

}  // namespace pellucid
