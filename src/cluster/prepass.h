// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "pellucid/cluster/brick_tree.h"
#include "pellucid/cluster/communicator.h"
#include "pellucid/scene/internal/absorbing_blocks.h"
#include "pellucid/scene/sub_volume.h"

namespace pellucid {

/// Some layers of the blocks of a grid: blocks first … end - 1 along z.
struct SurveySlab {
  int first = 0, end = 0;
  IndexBox values;  ///< that these blocks need
  int skipped = 0;  ///< blocks of the part's own grid below `first`
};
/// Returns the slabs that a rank looks at, one after the other: each of at most `most_values`
/// values, if a single layer of blocks has no more. Blocks lie in them as in the whole grid.
std::vector<SurveySlab> slabs_of(const Volume::Description& description, int rank, int ranks,
                                 std::size_t most_values);

/// Regions in which a uniform grid absorbs.
class Survey {
 public:
  /// Prepares weights. `frame_from_grid`, `bounds`: of the weights, which have so many cells.
  Survey(const Volume::Description& description, const Affine<double>& frame_from_grid,
         const Box<double>& bounds, const std::array<int, 3>& cells);

  /// Returns the number of blocks along each axis.
  static std::array<int, 3> blocks_of(const Volume::Description& description);

  /// Adds what was found in a slab: `found` is of the slab's own grid.
  void add(const SurveySlab& slab, const AbsorbingBlocks& found);
  /// Joins what all ranks found.
  void join(Communicator& ranks);

  /// Returns the corners of a box in the world around all blocks that absorb (visible_corners());
  /// none if nothing absorbs. `world_from_grid`: of the whole, with the layer's transform.
  std::optional<std::array<Vec3<double>, 8>> corners(const Affine<double>& world_from_grid) const;
  /// Adds to weights: half is the share of the volume, half of what absorbs.
  void add_to(BrickWeights& weights) const;

 private:
  Volume::Description description_;
  Affine<double> frame_from_grid_;
  Box<double> bounds_;
  std::array<int, 3> cells_;
  std::vector<double> absorbing_, all_;  ///< number of blocks in each cell of the weights
  std::array<double, 3> first_, last_;   ///< of the blocks that absorb
};

}  // namespace pellucid
