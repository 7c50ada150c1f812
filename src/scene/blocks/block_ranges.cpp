// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>

#include "pellucid/scene/error.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/build_block_records.h"
#include "volume_blocks.h"

namespace pellucid {
namespace {

template <class Value>
void build(const StructuredGrid<Value, double>& grid, const std::string& name,
           const VolumeStatistics& statistics, const ParallelFor& parallel, VolumeBlocks& blocks) {
  constexpr auto largest_count = static_cast<std::size_t>(std::numeric_limits<int>::max());
  std::size_t count = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const int along = block_count(grid.axis[a]);
    count *= static_cast<std::size_t>(along);
    if (count > largest_count) {
      throw Error((name.empty() ? "volume" : name) + ": has more than " +
                  std::to_string(largest_count) + " blocks of " + std::to_string(block_width) +
                  " cells along each axis; crop it, or render it in parts");
    }
    blocks.plane[a].resize(static_cast<std::size_t>(along) + 1);
    find_block_planes(grid.axis[a], blocks.plane[a].data());
    blocks.view.axis[a] = {blocks.plane[a].data(), along + 1, 0};
    const GridAxis<double>& axis = grid.axis[a];
    const int cells = axis.cells(), index = static_cast<int>(a);
    blocks.view.least_width[index] = least_plane_distance(axis);
    blocks.view.mean_width[index] = (axis.plane(cells) - axis.plane(0)) / cells;
  }
  blocks.view.code =
      make_block_code(statistics.minimum, statistics.maximum, std::is_integral_v<Value>);
  blocks.record.resize(count);
  blocks.view.record = blocks.record.data();
  parallel_or_serial(parallel)(static_cast<int>(count), [&](int first, int last) {
    build_block_records(grid, blocks.view.axis, blocks.view.code, first, last,
                        blocks.record.data());
  });
}

}  // namespace

const BlockRecords& Volume::block_records(const ParallelFor& parallel) const {
  if (!blocks_->built) {
    const std::lock_guard lock(blocks_->building);
    if (!blocks_->built) {
      visit([&](const auto& grid) {
        build(grid, description_.name, statistics_, parallel, *blocks_);
      });
      blocks_->built = true;
    }
  }
  return blocks_->view;
}

}  // namespace pellucid
