// SPDX-License-Identifier: Apache-2.0
#include "frame.h"

#include <algorithm>
#include <optional>

#include "pellucid/render/sample_ray.h"
#include "threads.h"

namespace pellucid {
namespace {

/// The largest component of what lies behind the data.
double brightest(const std::optional<Rgb<double>>& background) {
  return background ? std::max({background->r, background->g, background->b}) : 0;
}

/// Rounding a pixel to binary32 costs at most half a unit in its last place.
double storage_error(double value) {
  return std::max(value, 1.0) * 0x1p-24;
}

/// Whether the method has a sampler in packets.
bool goes_in_packets(const Integration& integration) {
  return (integration.method == Method::midpoint || integration.method == Method::preintegrated) &&
         integration.precision != Precision::float64;
}

}  // namespace

Frame::Frame(const Scene& described, const RenderOptions& options, int threads)
    : scene(described),
      camera(make_camera_frame(described.camera, described.size)),
      depth(options.depth),
      transfer(*described.transfer_function),
      reserved(described.transfer_function->approximation_error(brightest(described.background))) {
  const Integration& integration = scene.integration;
  const double storage = storage_error(scene.transfer_function->largest_color());
  wanted.tolerance =
      std::max(integration.tolerance - reserved - storage, 0.25 * integration.tolerance);
  wanted.grade = integration.grade;
  wanted.precision = integration.precision;
  wanted.largest_color =
      std::max(scene.transfer_function->largest_color(), brightest(scene.background));
  step = integration.step * scene.volume->voxel_size();
  const ParallelFor parallel = parallel_for(threads);
  if (integration.method == Method::preintegrated) {
    const VolumeStatistics& data = scene.volume->statistics();
    preintegrated = std::make_unique<PreintegratedStorage>(transfer.tables().wide, data.minimum,
                                                           data.maximum, step, parallel);
  }
  const bool samples = goes_in_packets(integration) && !depth;
  if (integration.method != Method::exact && !samples) return;
  const BlockRecords& records = scene.volume->block_ranges(parallel);
  block_classes =
      BlockClassesStorage(records, transfer.tables(), wanted.largest_color, parallel,
                          samples ? 0 : PacketTracer::most_bending(*scene.volume, wanted));
  blocks = ClassifiedBlocks{records, block_classes.view()};
  if (samples) {
    sampler = PacketSamplerTracer::make(
        *scene.volume, blocks->classes, transfer.tables().single,
        preintegrated ? &preintegrated->view() : nullptr, step,
        stop_tolerance<float>() / std::max(scene.transfer_function->largest_color(), 1.0),
        options.instruction_set);
  } else {
    packets = PacketTracer::make(*scene.volume, *blocks, block_classes.smooth(), transfer.tables(),
                                 wanted, options.instruction_set);
  }
}

}  // namespace pellucid
