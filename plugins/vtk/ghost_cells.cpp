// SPDX-License-Identifier: Apache-2.0
#include "ghost_cells.h"

#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkRectilinearGrid.h>

#include <span>

#include "vtk_scene/hidden_places.h"

namespace pellucid::plugin {
namespace {

static_assert(duplicate_cell == vtkDataSetAttributes::DUPLICATECELL &&
              refined_cell == vtkDataSetAttributes::REFINEDCELL &&
              hidden_cell == vtkDataSetAttributes::HIDDENCELL &&
              hidden_point == vtkDataSetAttributes::HIDDENPOINT);

std::span<const unsigned char> values_of(vtkUnsignedCharArray& array) {
  return {array.GetPointer(0), static_cast<std::size_t>(array.GetNumberOfValues())};
}

GhostFlags flags_of(vtkUnsignedCharArray* array) {
  if (array == nullptr) return std::nullopt;
  return values_of(*array);
}

Vec3<double> point_of(vtkDataSet& data, const std::array<int, 3>& sides,
                      const std::array<int, 3>& at) {
  const vtkIdType row = sides[0] + 1, slab = row * (sides[1] + 1);
  double point[3];
  data.GetPoint(at[0] + row * at[1] + slab * at[2], point);
  return {point[0], point[1], point[2]};
}

}  // namespace

bool is_grid(vtkDataSet& data) {
  return vtkImageData::SafeDownCast(&data) != nullptr ||
         vtkRectilinearGrid::SafeDownCast(&data) != nullptr;
}

std::array<int, 3> cells_along(vtkDataSet& data) {
  std::array<int, 3> sides{};
  if (auto* const image = vtkImageData::SafeDownCast(&data)) image->GetDimensions(sides.data());
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(&data)) grid->GetDimensions(sides.data());
  for (int& side : sides) --side;
  return sides;
}

std::optional<GhostCells> ghosts_of(vtkDataSet& data, KeptOwnCells& kept) {
  const vtkSmartPointer<vtkUnsignedCharArray> flags(data.GetCellGhostArray());
  if (flags == nullptr || flags->GetNumberOfValues() != data.GetNumberOfCells()) {
    return std::nullopt;
  }
  const std::array<int, 3> sides = cells_along(data);
  const OwnCells own = *kept.find({flags, flags->GetMTime(), sides}, [](const GhostRecipe& recipe) {
    return own_cells(values_of(*std::get<0>(recipe)), std::get<2>(recipe));
  });
  return GhostCells{own, sides, [&data, sides](const std::array<int, 3>& index) {
                      return point_of(data, sides, index);
                    }};
}

vtkBoundingBox own_bounds(vtkDataSet& data, KeptOwnCells& kept) {
  const std::optional<GhostCells> ghosts = ghosts_of(data, kept);
  if (!ghosts) return vtkBoundingBox(data.GetBounds());
  vtkBoundingBox box;
  const OwnCells& own = ghosts->own;
  if (own.count == 0) return box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      at[a] = (corner >> a & 1U) != 0 ? own.last[a] + 1 : own.first[a];
    }
    const Vec3<double> point = ghosts->point(at);
    box.AddPoint(point.x, point.y, point.z);
  }
  return box;
}

GhostTimes ghost_times(vtkDataSet& data) {
  GhostTimes found;
  found.flags = {data.GetPointGhostArray(), data.GetCellGhostArray()};
  for (std::size_t i = 0; i < 2; ++i) {
    if (found.flags[i] != nullptr) found.times[i] = found.flags[i]->GetMTime();
  }
  return found;
}

std::vector<bool> hidden_places(vtkDataSet& data, bool of_cells) {
  return vtk_scene::hidden_places(flags_of(data.GetPointGhostArray()),
                                  flags_of(data.GetCellGhostArray()), cells_along(data), of_cells,
                                  data.GetClassName());
}

}  // namespace pellucid::plugin
