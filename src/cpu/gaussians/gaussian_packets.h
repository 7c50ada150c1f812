// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "gaussian_packet_job.h"
#include "pellucid/packet/steps/resolved_gaussians.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/scene/internal/block_variation_storage.h"
#include "pellucid/scene/internal/multivariate_blocks_storage.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {

/// Integrates rays through several channels in packets, in binary32, in the machine's best
/// instruction set; in the grade `estimated`.
class GaussianPackets {
 public:
  /// Null where rays have to go one by one: no such instructions, the grade `proved`, tables among
  /// the terms, a tolerance below 1e-5, a rectilinear grid, a single layer of values, numbers whose
  /// squares binary32 has not, or primitives so narrow that binary32 does not place the data in
  /// them. All that is given is referred to. `negligible`: the extinction that `blocks` leave out,
  /// and which may be left out a second time; both are charged.
  static std::unique_ptr<const GaussianPackets> make(
      const Channels& channels, const MultivariateTransferFunction& transfer_function,
      const MultivariateBlocks& blocks, const MultichannelGrid& grid, const RayTolerance& wanted,
      double negligible, InstructionSet instruction_set, const ParallelFor& parallel);

  /// Integrates the rays; `error` is infinite where they are to go one by one. `share`: fraction of
  /// the tolerance that they may use, besides the part for what is left out. `waves` as in the job.
  void trace(const std::vector<PellucidRay>& rays, double share, const float* waves, bool depth,
             PellucidRayResult* results) const;

 private:
  GaussianPackets(const Channels& channels, std::vector<SteppedGaussian> primitives,
                  const ParallelFor& parallel, const PellucidGaussianPacketJob& job,
                  GaussianPacketKernel kernel);

  std::vector<SteppedGaussian> primitives_;
  SteppedMixture mixture_;
  BlockVariationStorage variation_;
  PellucidGaussianPacketJob job_;
  GaussianPacketKernel kernel_;
};

}  // namespace pellucid
