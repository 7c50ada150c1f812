// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <vector>

#include "pellucid/render/ray_result.h"
#include "pellucid/render/transfer_tables.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/block_classes.h"
#include "ray_tracer.h"

namespace pellucid {

/// Data and options of single rays.
struct SingleRays {
  const Volume& volume;
  const TransferTables& transfer;
  const ClassifiedBlocks* blocks;  ///< null: none is classified
  bool depth;                      ///< whether the depth of half opacity is asked for
};

/// Returns whether this build follows single rays. Without, a layer that does not suit packets
/// takes the general path.
bool has_single_rays() noexcept;

/// Follows rays in grid coordinates one by one: where packets do not suit them. After a request to
/// stop the results do not matter.
std::vector<RayResult> trace_single_rays(const SingleRays& of, const std::vector<RayPart>& in_grid,
                                         const RayTolerance& wanted, const std::stop_token& stop);

}  // namespace pellucid
