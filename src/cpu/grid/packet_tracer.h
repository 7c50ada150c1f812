// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "frame/ray_spacing.h"
#include "grid_light.h"
#include "pellucid/packet/interface.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/scene/internal/binned_transfer_storage.h"
#include "pellucid/scene/internal/block_classes_storage.h"
#include "pellucid/scene/volume.h"
#include "pellucid/simd/instruction_set.h"
#include "pellucid/traverse/block_classes.h"
#include "ray_tracer.h"
#include "sample/sampler_records.h"

namespace pellucid {

/// The least tolerance for which rays go in packets: below it, most cells would be handed back.
inline constexpr double min_packet_tolerance = 1e-5;

/// Integrates rays in packets, in the machine's best instruction set; what packets hand back, here.
class PacketTracer {
 public:
  /// For BlockClassesStorage. Not where only what is proved counts.
  static StepLimits step_limits(const Volume& volume, const TransferTables& transfer,
                                const RayTolerance& wanted, double share_throughout);

  /// Null where rays have to go one by one: no such instructions, a rectilinear grid, a single
  /// layer of values, one precision wanted, a very small tolerance, or numbers
  /// whose squares binary32 has not. All that is given is referred to. `light`: null if unlit; with
  /// it `smooth` is none.
  /// Throws Error where the machine has not the instruction set that is asked for.
  static std::unique_ptr<const PacketTracer> make(
      const Volume& volume, const ClassifiedBlocks& blocks, const SmoothBlocks& smooth,
      const TransferTables& transfer, const RayTolerance& wanted,
      std::optional<InstructionSet> instruction_set, const GridLight* light = nullptr);

  /// Parts of rays in grid coordinates, their parameter the world arc length; neighbours are packed
  /// together, and what becomes of a ray does not depend on them. `share`: of the tolerance, what
  /// the parts may be off by. `depth`: whether half_opacity_depth is asked for.
  std::vector<RayResult> trace(const std::vector<RayPart>& in_grid, double share, bool depth) const;
  /// Returns whether smooth blocks are sampled.
  bool goes_in_steps() const noexcept { return smooth_.longest_step > 0; }
  /// RayResult::longest_step of no ray is longer.
  double most_between_rays() const noexcept { return RaySpacing::most * smooth_.longest_step; }

 private:
  using Kernel = void (*)(const PellucidPacketJob*);

  PacketTracer(const Volume& volume, const ClassifiedBlocks& blocks, const SmoothBlocks& smooth,
               const TransferTables& transfer, const RayTolerance& wanted, Kernel kernel,
               const GridLight* light);
  /// Integrates rays that meet the grid's box between their ends.
  std::vector<PellucidRayResult> integrate(const std::vector<PellucidRay>& rays, double share,
                                           bool depth) const;
  static void integrate_cell(const PellucidCellContext* context, std::int32_t ray,
                             const PellucidCell* cell, PellucidCellResult* result);

  const Volume& volume_;
  RaySpacing rays_apart_;
  const TransferTables& transfer_;
  const RayTolerance& wanted_;
  BinnedTransferStorage binned_;
  SamplerRecords samples_;
  SmoothBlocks smooth_;
  PellucidPacketJob job_{};
  Kernel kernel_;
  const GridLight* light_;
};

}  // namespace pellucid
