// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/cut_cells.h"

#include <algorithm>
#include <utility>

#include "cut_arrays.h"
#include "cut_order.h"

namespace pellucid {

std::shared_ptr<const MeshChannels> cut_into_tetrahedra(const UnstructuredGrid& grid,
                                                        std::span<const MeshArrayChoice> choices,
                                                        const ParallelFor& parallel) {
  const bool with_cells = std::ranges::any_of(choices, [&](const MeshArrayChoice& choice) {
    return chosen_array(grid, choice).centering == Centering::cell;
  });
  CellCut cut = cut_cells(grid, with_cells, parallel);
  put_in_spatial_order(cut, parallel);

  std::vector<MeshChannel> channels;
  channels.reserve(choices.size());
  for (const MeshArrayChoice& choice : choices) {
    channels.push_back(chosen_channel(grid, choice, cut));
  }
  const auto mesh = std::make_shared<const TetrahedralMesh>(
      TetrahedralMesh::Description{std::move(cut.points), std::move(cut.tetrahedra), grid.name,
                                   std::move(cut.numbers)},
      parallel);
  return std::make_shared<const MeshChannels>(mesh, std::move(channels));
}

}  // namespace pellucid
