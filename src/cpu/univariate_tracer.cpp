// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "layers/clip_intervals.h"
#include "packet_sampler.h"
#include "packet_setup.h"
#include "packet_tracer.h"
#include "pellucid/render/integrate_ray.h"
#include "pellucid/render/sample_preintegrated.h"
#include "pellucid/scene/block_classes_storage.h"
#include "pellucid/scene/transfer_tables_storage.h"
#include "preintegrated_storage.h"
#include "ray_tracer.h"
#include "sampling_rule.h"
#include "threads.h"

namespace pellucid {
namespace {

/// Whether the method has a sampler in packets.
bool goes_in_packets(const Integration& integration) {
  return (integration.method == Method::midpoint || integration.method == Method::preintegrated) &&
         integration.precision != Precision::float64;
}

/// Composites the next part of a ray behind those so far. The error of a part bounds what it does
/// to everything behind it (RayResult::error), so that errors add up behind transparencies.
void add_behind(RayResult& ray, const RayResult& part) {
  const double transparency = 1 - ray.opacity;
  ray.radiance += transparency * part.radiance;
  ray.error += transparency * part.error;
  ray.opacity += transparency * part.opacity;
  ray.optical_depth += part.optical_depth;
  ray.proved = ray.proved && part.proved;
  ray.cells += part.cells;
  ray.evaluations += part.evaluations;
  ray.spans += part.spans;
}

class UnivariateTracer : public RayTracer {
 public:
  explicit UnivariateTracer(const TracerTask& task);

  /// Whether clips can be cut out of the rays: those in packets are parts of rays anyway.
  bool can_clip() const { return packets_ != nullptr && !depth_; }

  std::optional<Surroundings> surroundings() const override;
  std::vector<RayResult> trace(const std::vector<Ray<double>>& world, double share) const override {
    std::vector<Ray<double>> rays;
    rays.reserve(world.size());
    for (const Ray<double>& ray : world) rays.push_back(volume_.grid_from_world().ray(ray));
    if (!clips_.empty()) return trace_clipped(world, rays);
    return packets_ || sampler_ ? trace_in_packets(rays, share) : trace_one_by_one(rays);
  }

 private:
  std::vector<RayResult> trace_in_packets(const std::vector<Ray<double>>& rays, double share) const;
  std::vector<RayResult> trace_one_by_one(const std::vector<Ray<double>>& rays) const;
  /// Integrates what the clips keep of each ray.
  std::vector<RayResult> trace_clipped(const std::vector<Ray<double>>& world,
                                       const std::vector<Ray<double>>& rays) const;
  template <class Value>
  RayResult trace_one(const StructuredGrid<Value, double>& grid, const Ray<double>& ray) const;

  const Integration& integration_;
  const Volume& volume_;
  const TransferFunction& transfer_function_;
  RayTolerance wanted_;
  bool depth_;   ///< whether the depth of half opacity is asked for
  double step_;  ///< of the sampling methods, world length
  TransferTablesStorage transfer_;
  BlockClassesStorage block_classes_;
  std::optional<ClassifiedBlocks> blocks_;       ///< none: the method has no use for them
  std::unique_ptr<const PacketTracer> packets_;  ///< null: rays go one by one, or are sampled
  std::unique_ptr<const PreintegratedStorage> preintegrated_;  ///< null: another method
  std::unique_ptr<const PacketSamplerTracer> sampler_;         ///< null: rays go one by one
  std::vector<Clip> clips_;                                    ///< of the layer and of the scene
};

UnivariateTracer::UnivariateTracer(const TracerTask& task)
    : integration_(task.scene.integration),
      volume_(*std::get<VolumeContent>(task.layer.content).volume),
      transfer_function_(*std::get<VolumeContent>(task.layer.content).transfer_function),
      wanted_(task.wanted),
      depth_(task.options.depth),
      step_(integration_.step * volume_.voxel_size()),
      transfer_(transfer_function_),
      clips_(task.layer.clips) {
  clips_.insert(clips_.end(), task.scene.clips.begin(), task.scene.clips.end());
  const ParallelFor parallel = parallel_for(task.threads);
  if (integration_.method == Method::preintegrated) {
    const VolumeStatistics& data = volume_.statistics();
    preintegrated_ = std::make_unique<PreintegratedStorage>(transfer_.tables().wide, data.minimum,
                                                            data.maximum, step_, parallel);
  }
  const bool samples = goes_in_packets(integration_) && !depth_;
  if (integration_.method != Method::exact && !samples) return;
  const BlockRecords& records = volume_.block_records(parallel);
  std::function<StepLimits(double)> limits;
  if (!samples && wanted_.grade != Grade::proved) {
    limits = [this](double share_throughout) {
      return PacketTracer::step_limits(volume_, transfer_.tables(), wanted_, share_throughout);
    };
  }
  block_classes_ =
      BlockClassesStorage(records, transfer_.tables(), wanted_.largest_color, parallel, limits);
  blocks_ = ClassifiedBlocks{records, block_classes_.view()};
  if (samples) {
    sampler_ = PacketSamplerTracer::make(
        volume_, blocks_->classes, transfer_.tables().single,
        preintegrated_ ? &preintegrated_->view() : nullptr, step_,
        stop_tolerance<float>() / std::max(transfer_function_.largest_color(), 1.0),
        task.options.instruction_set);
  } else {
    packets_ = PacketTracer::make(volume_, *blocks_, block_classes_.smooth(), transfer_.tables(),
                                  wanted_, task.options.instruction_set);
  }
}

std::optional<RayTracer::Surroundings> UnivariateTracer::surroundings() const {
  // Vacuum ends anywhere between rays; and where half of the opacity is reached goes in leaps.
  if (!packets_ || !packets_->goes_in_steps() || depth_ || !clips_.empty() ||
      volume_.statistics().nan > 0) {
    return std::nullopt;
  }
  return Surroundings{volume_, *blocks_, packets_->most_between_rays()};
}

std::vector<RayResult> UnivariateTracer::trace_in_packets(const std::vector<Ray<double>>& rays,
                                                          double share) const {
  std::vector<RayResult> results(rays.size());
  const int count = static_cast<int>(rays.size());
  if (sampler_) {
    sampler_->trace(rays.data(), count, results.data());
    return results;
  }
  packets_->trace(rays.data(), count, share, depth_, results.data());
  return results;
}

std::vector<RayResult> UnivariateTracer::trace_clipped(const std::vector<Ray<double>>& world,
                                                       const std::vector<Ray<double>>& rays) const {
  std::vector<RayResult> results(rays.size(), missing_ray());
  // Parts of one ray, front to back, share its tolerance: rays of one part, and all others.
  std::vector<PellucidRay> parts[2];
  std::vector<std::size_t> ray_of[2];
  std::size_t most = 1;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Interval<double> inside =
        volume_.visit([&](const auto& grid) { return grid_interval(grid.axis, rays[i]); });
    if (inside.empty()) continue;
    ClipIntervals intervals(inside);
    for (const Clip& clip : clips_) intervals.cut(clip, world[i]);
    results[i].error =
        std::max(wanted_.largest_color, 1.0) *
        std::min(transfer_.tables().largest_extinction * intervals.error_in(inside), 1.0);
    const std::size_t group = intervals.kept.size() > 1 ? 1 : 0;
    most = std::max(most, intervals.kept.size());
    const Vec3<double>&o = rays[i].origin, &d = rays[i].direction;
    for (const Interval<double>& part : intervals.kept) {
      parts[group].push_back({{o.x, o.y, o.z}, {d.x, d.y, d.z}, part.begin, part.end});
      ray_of[group].push_back(i);
    }
  }
  for (std::size_t group = 0; group < 2; ++group) {
    if (parts[group].empty()) continue;
    const std::vector<RayResult> found =
        packets_->trace_parts(parts[group], group == 0 ? 1 : 1 / static_cast<double>(most));
    for (std::size_t n = 0; n < found.size(); ++n) add_behind(results[ray_of[group][n]], found[n]);
  }
  return results;
}

std::vector<RayResult> UnivariateTracer::trace_one_by_one(
    const std::vector<Ray<double>>& rays) const {
  std::vector<RayResult> results;
  results.reserve(rays.size());
  volume_.visit([&](const auto& grid) {
    for (const Ray<double>& ray : rays) results.push_back(trace_one(grid, ray));
  });
  return results;
}

template <class Value>
RayResult UnivariateTracer::trace_one(const StructuredGrid<Value, double>& grid,
                                      const Ray<double>& ray) const {
  if (integration_.method == Method::exact) {
    return integrate_ray(grid, blocks_ ? &*blocks_ : nullptr, ray, transfer_.tables(), wanted_,
                         depth_);
  }
  const double largest_color = transfer_function_.largest_color();
  const SamplingRule rule = sampling_rule(integration_.method);
  const auto sample = [&]<class T>(const PiecewiseLinear<T>& transfer) {
    if (preintegrated_) {
      return sample_preintegrated<T>(grid, ray, preintegrated_->view(), step_, largest_color,
                                     stop_tolerance<T>(), depth_);
    }
    return sample_ray<T>(grid, ray, transfer, rule, step_, largest_color, stop_tolerance<T>(),
                         depth_);
  };
  return integration_.precision == Precision::float64 ? sample(transfer_.tables().wide)
                                                      : sample(transfer_.tables().single);
}

}  // namespace

std::unique_ptr<const RayTracer> make_univariate_tracer(const TracerTask& task) {
  auto tracer = std::make_unique<UnivariateTracer>(task);
  const bool clipped = !task.layer.clips.empty() || !task.scene.clips.empty();
  if (clipped && !tracer->can_clip()) return nullptr;
  return tracer;
}

}  // namespace pellucid
