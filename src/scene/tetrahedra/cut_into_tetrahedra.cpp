// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/tetrahedralize.h"

#include <numeric>
#include <utility>

#include "chosen_channels.h"
#include "tetrahedra_arrays.h"
#include "tetrahedra_order.h"

namespace pellucid {

void check_choices(const UnstructuredGrid& grid, std::span<const MeshArrayChoice> choices) {
  for (const MeshArrayChoice& choice : choices) chosen_array(grid, choice);
}

TetrahedralizedCells ordered_tetrahedra(const UnstructuredGrid& grid, const ParallelFor& parallel) {
  TetrahedralizedCells cells = tetrahedralize_cells(grid, true, parallel);
  put_in_spatial_order(cells, parallel);
  return cells;
}

std::vector<MeshChannel> chosen_channels(const UnstructuredGrid& grid,
                                         std::span<const MeshArrayChoice> choices,
                                         const TetrahedralizedCells& cells) {
  std::vector<MeshChannel> channels;
  channels.reserve(choices.size());
  for (const MeshArrayChoice& choice : choices) {
    channels.push_back(chosen_channel(grid, choice, cells));
  }
  return channels;
}

std::vector<std::int32_t> numbers_of_cells(const UnstructuredGrid& grid) {
  if (!grid.cell_numbers.empty()) return grid.cell_numbers;
  std::vector<std::int32_t> numbers(grid.shapes.size());
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

std::shared_ptr<const MeshChannels> cut_into_tetrahedra(const UnstructuredGrid& grid,
                                                        std::span<const MeshArrayChoice> choices,
                                                        const ParallelFor& parallel) {
  check_choices(grid, choices);
  TetrahedralizedCells cells = ordered_tetrahedra(grid, parallel);
  std::vector<MeshChannel> channels = chosen_channels(grid, choices, cells);
  const auto mesh = std::make_shared<const TetrahedralMesh>(
      TetrahedralMesh::Description{std::move(cells.points), std::move(cells.tetrahedra), grid.name,
                                   std::move(cells.numbers), std::move(cells.cell),
                                   numbers_of_cells(grid)},
      parallel);
  return std::make_shared<const MeshChannels>(mesh, std::move(channels));
}

}  // namespace pellucid
