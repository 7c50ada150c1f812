// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"
#include "pellucid/traverse/block_records.h"

namespace pellucid {

/// Largest distance of rays through smooth blocks that miss nothing between them, in the longest
/// steps of these blocks.
class RaySpacing {
 public:
  /// At most.
  static constexpr double most = 0.9;

  /// Prepares for rays through the box of these blocks.
  explicit RaySpacing(const BlockRecords& records) noexcept;

  /// Returns the largest distance of a ray beside this one (grid coordinates).
  float operator()(const PellucidRay& ray) const noexcept;

 private:
  double facing(const PellucidRay& ray) const noexcept;

  double least_[3], most_[3];  ///< of the box, grid coordinates
};

}  // namespace pellucid
