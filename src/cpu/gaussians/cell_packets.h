// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "culled_mixture_storage.h"
#include "gaussian_packet_job.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {

/// Variation of K (v - c) in a cell: how far it moves, and how much its slope changes from cell to
/// cell; the mean over blocks in which a primitive may matter, spread over all, of the one that
/// moves most. It serves to choose the faster way, and nothing else.
struct GaussianVariation {
  double in_cell = 0, second_difference = 0;
};
GaussianVariation movement_in_cells(const Channels& channels,
                                    const GaussianMixture<double>& mixture,
                                    const MultivariateBlocks& blocks);

/// Integrates rays through several channels in packets, cell by cell, in the machine's best
/// instruction set.
class CellPackets {
 public:
  /// Null where rays have to go one by one: no such instructions, a tolerance below 1e-11, a
  /// rectilinear grid, a single layer of values, numbers whose squares binary32 has not. All that
  /// is given is referred to.
  static std::unique_ptr<const CellPackets> make(
      const Channels& channels, const MultivariateTransferFunction& transfer_function,
      const MultivariateBlocks& blocks, const MultichannelGrid& grid, const RayTolerance& wanted,
      InstructionSet instruction_set);

  void trace(const std::vector<PellucidRay>& rays, double share, bool depth,
             PellucidRayResult* results) const;

 private:
  CellPackets() = default;

  NearMixtureStorage mixture_;
  PellucidGaussianPacketJob job_{};
  GaussianPacketKernel kernel_ = nullptr;
};

}  // namespace pellucid
