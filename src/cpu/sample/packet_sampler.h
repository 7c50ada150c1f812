// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "pellucid/packet/light.h"
#include "pellucid/packet/sampler_interface.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/volume.h"
#include "pellucid/simd/instruction_set.h"
#include "pellucid/transfer/preintegrated.h"
#include "pellucid/traverse/block_classes.h"
#include "ray_tracer.h"
#include "sampler_records.h"

namespace pellucid {

/// Samples rays at a fixed step in packets, in the machine's best instruction set.
class PacketSamplerTracer {
 public:
  /// Makes a sampler; null where rays have to go one by one: no such instructions, a rectilinear
  /// grid, a single layer of values, NaN among them, steps too many for an int, or numbers whose
  /// squares binary32 has not. All that is given is referred to. `preintegrated`: for this step,
  /// null for the midpoint rule; `light`: null where there is none. `step` in world length; `stop`:
  /// the transparency at which a ray ends.
  static std::unique_ptr<const PacketSamplerTracer> make(
      const Volume& volume, const BlockClasses& classes, const PiecewiseLinear<float>& transfer,
      const PreintegratedTable* preintegrated, const PacketLight* light, double step, double stop,
      std::optional<InstructionSet> instruction_set);

  /// Samples rays in grid coordinates, their parameter the world arc length. Without
  /// half_opacity_depth.
  std::vector<RayResult> trace(const std::vector<RayPart>& in_grid) const;

 private:
  using Kernel = void (*)(const PellucidSamplerJob*);

  PacketSamplerTracer(const Volume& volume, const BlockClasses& classes,
                      const PiecewiseLinear<float>& transfer,
                      const PreintegratedTable* preintegrated, const PacketLight* light,
                      double step, double stop, Kernel kernel);

  const Volume& volume_;
  SamplerRecords records_;
  PreintegratedTable preintegrated_;
  PellucidSamplerJob job_{};
  Kernel kernel_;
};

}  // namespace pellucid
