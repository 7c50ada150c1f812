// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "grid/grid_light.h"
#include "multivariate_sampler.h"
#include "packet_sampler.h"
#include "packet_setup.h"
#include "pellucid/render/sample_ray.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/internal/transfer_tables_storage.h"
#include "preintegrated_storage.h"
#include "ray_tracer.h"
#include "threads.h"

namespace pellucid {
namespace {

double stop_for(double largest_color) {
  return stop_tolerance<float>() / std::max(largest_color, 1.0);
}

/// One variable on a uniform grid.
class UnivariateSampler : public RayTracer {
 public:
  explicit UnivariateSampler(const TracerTask& task)
      : volume_(*std::get<VolumeContent>(task.layer.content).volume),
        transfer_(*std::get<VolumeContent>(task.layer.content).transfer_function) {
    const ParallelFor parallel = parallel_for(task.threads);
    const double step = task.integration.step * volume_.voxel_size();
    if (task.integration.method == Method::preintegrated) {
      const VolumeStatistics& data = volume_.statistics();
      preintegrated_ = std::make_unique<PreintegratedStorage>(transfer_.tables().wide, data.minimum,
                                                              data.maximum, step, parallel);
    }
    classes_ = BlockClassesStorage(volume_.block_records(parallel), transfer_.tables(),
                                   task.wanted.largest_color, parallel);
    if (is_lit(task.layer)) {
      light_ = GridLight::make(task.layer, task.lights, task.wanted);
      if (!light_) return;
    }
    packets_ = PacketSamplerTracer::make(
        volume_, classes_.view(), transfer_.tables().single,
        preintegrated_ ? &preintegrated_->view() : nullptr, light_ ? &light_->view() : nullptr,
        step, stop_for(task.wanted.largest_color), task.options.machine.instruction_set);
  }

  bool has_packets() const { return packets_ != nullptr; }
  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& /*options*/) const override {
    return packets_->trace(parts_in_grid(volume_, parts));
  }

 private:
  const Volume& volume_;
  TransferTablesStorage transfer_;
  BlockClassesStorage classes_;
  std::unique_ptr<const PreintegratedStorage> preintegrated_;  ///< null: the midpoint rule
  std::unique_ptr<const GridLight> light_;                     ///< null: unlit
  std::unique_ptr<const PacketSamplerTracer> packets_;         ///< null: packets do not suit it
};

/// Several variables on a uniform grid.
class MultivariateSamplerTracer : public RayTracer {
 public:
  explicit MultivariateSamplerTracer(const TracerTask& task)
      : channels_(*std::get<ChannelsContent>(task.layer.content).channels),
        packets_(MultivariatePacketSampler::make(
            channels_, *std::get<ChannelsContent>(task.layer.content).transfer_function,
            task.integration.step * channels_.grid().voxel_size(),
            stop_for(task.wanted.largest_color), task.options.machine.instruction_set,
            parallel_for(task.threads))) {}

  bool has_packets() const { return packets_ != nullptr; }
  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& /*options*/) const override {
    return packets_->trace(parts_in_grid(channels_.grid(), parts));
  }

 private:
  const Channels& channels_;
  std::unique_ptr<const MultivariatePacketSampler> packets_;
};

template <class Sampler>
std::unique_ptr<const RayTracer> made(const TracerTask& task) {
  auto sampler = std::make_unique<Sampler>(task);
  if (!sampler->has_packets()) return nullptr;
  return sampler;
}

}  // namespace

std::unique_ptr<const RayTracer> make_packet_sampler(const TracerTask& task) {
  const Method method = task.integration.method;
  if (task.options.outputs.depth || task.integration.precision == Precision::float64 ||
      has_surfaces(task.layer) || extinction_factor_of(task.layer) != nullptr) {
    return nullptr;
  }
  if (const auto* const volume = std::get_if<VolumeContent>(&task.layer.content)) {
    if (volume->mask || (method != Method::midpoint && method != Method::preintegrated)) {
      return nullptr;
    }
    return made<UnivariateSampler>(task);
  }
  if (!std::holds_alternative<ChannelsContent>(task.layer.content) || is_lit(task.layer) ||
      method != Method::midpoint) {
    return nullptr;
  }
  return made<MultivariateSamplerTracer>(task);
}

}  // namespace pellucid
