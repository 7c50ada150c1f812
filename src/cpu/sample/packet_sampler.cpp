// SPDX-License-Identifier: Apache-2.0
#include "packet_sampler.h"

#include <algorithm>
#include <vector>

#include "packet_setup.h"

namespace pellucid {
namespace {

using SamplerKernel = void (*)(const PellucidSamplerJob*);

SamplerKernel sampler_of(InstructionSet set) {
  return PELLUCID_KERNEL_OF(set, pellucid_sample_packets);
}

}  // namespace

std::unique_ptr<const PacketSamplerTracer> PacketSamplerTracer::make(
    const Volume& volume, const BlockClasses& classes, const PiecewiseLinear<float>& transfer,
    const PreintegratedTable* preintegrated, const PacketLight* light, double step, double stop,
    std::optional<InstructionSet> instruction_set) {
  const SamplerKernel kernel = sampler_of(packet_instruction_set(instruction_set));
  double largest_extinction = 0;
  for (int i = 0; i < transfer.count; ++i) {
    largest_extinction = std::max<double>(largest_extinction, transfer.material[i].extinction);
  }
  if (kernel == nullptr || volume.statistics().nan > 0 || !is_moderate(step) ||
      !has_few_steps(volume, step) || !suits_packets(volume, largest_extinction)) {
    return nullptr;
  }
  return std::unique_ptr<const PacketSamplerTracer>(
      new PacketSamplerTracer(volume, classes, transfer, preintegrated, light, step, stop, kernel));
}

PacketSamplerTracer::PacketSamplerTracer(const Volume& volume, const BlockClasses& classes,
                                         const PiecewiseLinear<float>& transfer,
                                         const PreintegratedTable* preintegrated,
                                         const PacketLight* light, double step, double stop,
                                         SamplerKernel kernel)
    : volume_(volume),
      records_(transfer),
      preintegrated_(preintegrated != nullptr ? *preintegrated : PreintegratedTable{}),
      kernel_(kernel) {
  PellucidPacketJob& of_grid = job_.grid_and_rays;
  set_grid(volume, of_grid);
  of_grid.classes = classes.block;
  job_.rule = preintegrated != nullptr ? pellucid_preintegrated : pellucid_midpoint;
  job_.preintegrated = &preintegrated_;
  job_.light = light;
  job_.transfer = &records_.view();
  job_.step = step;
  job_.stop = stop;
}

std::vector<RayResult> PacketSamplerTracer::trace(const std::vector<RayPart>& in_grid) const {
  return trace_samples(volume_, job_, kernel_, in_grid);
}

}  // namespace pellucid
