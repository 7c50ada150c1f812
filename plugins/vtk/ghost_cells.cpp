// SPDX-License-Identifier: Apache-2.0
#include "ghost_cells.h"

#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkRectilinearGrid.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "pellucid/scene/error.h"

namespace pellucid::plugin {
namespace {

vtkUnsignedCharArray* ghosts_of(vtkDataSet& data) {
  vtkUnsignedCharArray* const ghosts = data.GetCellGhostArray();
  return ghosts != nullptr && ghosts->GetNumberOfValues() == data.GetNumberOfCells() ? ghosts
                                                                                     : nullptr;
}

OwnCells own_cells(const GhostRecipe& recipe) {
  const auto& [ghosts, time, sides] = recipe;
  OwnCells own;
  own.first.fill(std::numeric_limits<int>::max());
  own.last.fill(-1);
  vtkIdType cell = 0;
  std::array<int, 3> at{};
  for (at[2] = 0; at[2] < sides[2]; ++at[2]) {
    for (at[1] = 0; at[1] < sides[1]; ++at[1]) {
      for (at[0] = 0; at[0] < sides[0]; ++at[0]) {
        if ((ghosts->GetValue(cell++) & vtkDataSetAttributes::DUPLICATECELL) != 0) continue;
        ++own.count;
        for (std::size_t a = 0; a < 3; ++a) {
          own.first[a] = std::min(own.first[a], at[a]);
          own.last[a] = std::max(own.last[a], at[a]);
        }
      }
    }
  }
  return own;
}

Vec3<double> point_of(vtkDataSet& data, const std::array<int, 3>& sides,
                      const std::array<int, 3>& at) {
  const vtkIdType row = sides[0] + 1, slab = row * (sides[1] + 1);
  double point[3];
  data.GetPoint(at[0] + row * at[1] + slab * at[2], point);
  return {point[0], point[1], point[2]};
}

}  // namespace

std::array<int, 3> cells_along(vtkDataSet& data) {
  std::array<int, 3> sides{};
  if (auto* const image = vtkImageData::SafeDownCast(&data)) image->GetDimensions(sides.data());
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(&data)) grid->GetDimensions(sides.data());
  for (int& side : sides) --side;
  return sides;
}

std::optional<std::vector<Clip>> clips_at_ghosts(vtkDataSet& data,
                                                 const Affine<double>& world_from_data,
                                                 KeptOwnCells& kept) {
  std::vector<Clip> clips;
  const vtkSmartPointer<vtkUnsignedCharArray> ghosts(ghosts_of(data));
  if (ghosts == nullptr) return clips;
  const std::array<int, 3> sides = cells_along(data);
  const OwnCells own = *kept.find({ghosts, ghosts->GetMTime(), sides}, own_cells);
  if (own.count == 0) return std::nullopt;
  vtkIdType filled = 1;
  for (std::size_t a = 0; a < 3; ++a) filled *= own.last[a] - own.first[a] + 1;
  if (filled != own.count) {
    throw Error(std::string(data.GetClassName()) +
                ": its cells that are no ghosts do not fill a box; remove vtkGhostType");
  }
  const Vec3<double> corner = point_of(data, sides, own.first);
  std::array<Vec3<double>, 3> edge;
  std::array<int, 3> end{};
  for (std::size_t a = 0; a < 3; ++a) end[a] = own.last[a] + 1;
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<int, 3> along = own.first;
    along[a] = end[a];
    edge[a] = world_from_data.vector(point_of(data, sides, along) - corner);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    Vec3<double> normal = cross(edge[(a + 1) % 3], edge[(a + 2) % 3]);
    if (dot(normal, edge[a]) < 0) normal = -normal;
    const Vec3<double> point = world_from_data.point(corner);
    if (own.first[a] > 0) clips.push_back({ClipPlane{point, normal}});
    if (end[a] < sides[a]) clips.push_back({ClipPlane{point + edge[a], -normal}});
  }
  return clips;
}

}  // namespace pellucid::plugin
