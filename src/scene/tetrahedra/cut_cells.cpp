// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/cut_cells.h"

#include <numeric>
#include <utility>

#include "cut_arrays.h"
#include "cut_order.h"

namespace pellucid {
namespace {

/// Returns the cell numbers of the file, or those by order: a cell without a tetrahedron counts
/// too.
std::vector<std::int32_t> cell_numbers(const UnstructuredGrid& grid) {
  if (!grid.cell_numbers.empty()) return grid.cell_numbers;
  std::vector<std::int32_t> numbers(grid.shapes.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace

std::shared_ptr<const MeshChannels> cut_into_tetrahedra(const UnstructuredGrid& grid,
                                                        std::span<const MeshArrayChoice> choices,
                                                        const ParallelFor& parallel) {
  for (const MeshArrayChoice& choice : choices) chosen_array(grid, choice);  // throws at once
  CellCut cut = cut_cells(grid, true, parallel);
  put_in_spatial_order(cut, parallel);

  std::vector<MeshChannel> channels;
  channels.reserve(choices.size());
  for (const MeshArrayChoice& choice : choices) {
    channels.push_back(chosen_channel(grid, choice, cut));
  }
  const auto mesh = std::make_shared<const TetrahedralMesh>(
      TetrahedralMesh::Description{std::move(cut.points), std::move(cut.tetrahedra), grid.name,
                                   std::move(cut.numbers), std::move(cut.cell), cell_numbers(grid)},
      parallel);
  return std::make_shared<const MeshChannels>(mesh, std::move(channels));
}

}  // namespace pellucid
