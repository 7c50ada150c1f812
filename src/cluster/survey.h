// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pellucid/cluster/brick_tree.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/scene/absorbing_blocks.h"
#include "pellucid/scene/sub_volume.h"

namespace pellucid {

/// The part of the blocks of a grid that one rank looks at: blocks first … end - 1 along z.
struct SurveySlab {
  int first = 0, end = 0;
  IndexBox values;  ///< that these blocks need
  int skipped = 0;  ///< blocks of the part's own grid below `first`

  bool empty() const noexcept { return first >= end; }
};
/// Returns the slab of a rank: blocks lie in it as in the whole grid.
SurveySlab slab_of(const Volume::Description& description, int rank, int ranks);

/// Where a grid absorbs, as all ranks find together.
struct Survey {
  std::array<int, 3> count{};  ///< blocks of the whole grid
  std::vector<double> absorbs;  ///< of each, x fastest: 0 or 1
};
/// Joins what the ranks found in their slabs. `found` is of the slab's own grid.
Survey join(Communicator& ranks, const Volume::Description& description, const SurveySlab& slab,
            const AbsorbingBlocks& found);

/// Returns the corners of a box in the world around all blocks that absorb (visible_corners()); none
/// if nothing absorbs. `world_from_grid`: of the whole, with the layer's transform.
std::optional<std::array<Vec3<double>, 8>> corners_of(const Survey& survey,
                                                      const Volume::Description& description,
                                                      const Affine<double>& world_from_grid);

/// Adds the blocks to weights on a lattice over bounds in a frame: half is the share of the volume,
/// half of what absorbs.
void add_weights(const Survey& survey, const Volume::Description& description,
                 const Affine<double>& frame_from_grid, const Box<double>& bounds,
                 BrickWeights& weights);

}  // namespace pellucid
