// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "pellucid/packet/multivariate_sampler_interface.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/internal/multivariate_blocks_storage.h"
#include "pellucid/simd/instruction_set.h"
#include "ray_tracer.h"
#include "sampled_multivariate_storage.h"

namespace pellucid {

/// Samples rays through several channels by the midpoint rule in packets, in the machine's best
/// instruction set.
class MultivariatePacketSampler {
 public:
  /// Makes a sampler; null where rays have to go one by one: no such instructions, a rectilinear
  /// grid, a single layer of values, steps too many for an int, numbers whose squares binary32 has
  /// not, or primitives so narrow that binary32 does not place the data in them. All that is given
  /// is referred to. `step` in world length; `stop`: the transparency at which a ray ends.
  static std::unique_ptr<const MultivariatePacketSampler> make(
      const Channels& channels, const MultivariateTransferFunction& transfer_function, double step,
      double stop, std::optional<InstructionSet> instruction_set, const ParallelFor& parallel);

  /// Samples rays in grid coordinates, their parameter the world arc length. Without
  /// half_opacity_depth.
  std::vector<RayResult> trace(const std::vector<RayPart>& in_grid) const;

 private:
  using Kernel = void (*)(const PellucidMultivariateSamplerJob*);

  MultivariatePacketSampler(const Channels& channels,
                            const MultivariateTransferFunction& transfer_function, double step,
                            double stop, double negligible, Kernel kernel,
                            const ParallelFor& parallel);

  const Volume& volume_;  ///< its grid is that of all
  MultichannelGrid grid_;
  MultivariateBlocksStorage blocks_;
  SampledMultivariateStorage transfer_;
  PellucidMultivariateSamplerJob job_{};
  Kernel kernel_;
};

}  // namespace pellucid
