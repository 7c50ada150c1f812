// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/tetrahedralize.h"

#include <numeric>
#include <utility>

#include "tetrahedra_arrays.h"
#include "tetrahedra_order.h"

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
  TetrahedralizedCells cells = tetrahedralize_cells(grid, true, parallel);
  put_in_spatial_order(cells, parallel);

  std::vector<MeshChannel> channels;
  channels.reserve(choices.size());
  for (const MeshArrayChoice& choice : choices) {
    channels.push_back(chosen_channel(grid, choice, cells));
  }
  const auto mesh = std::make_shared<const TetrahedralMesh>(
      TetrahedralMesh::Description{std::move(cells.points), std::move(cells.tetrahedra), grid.name,
                                   std::move(cells.numbers), std::move(cells.cell),
                                   cell_numbers(grid)},
      parallel);
  return std::make_shared<const MeshChannels>(mesh, std::move(channels));
}

}  // namespace pellucid
