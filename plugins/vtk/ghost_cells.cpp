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

/// Distance of planes below the faces of cells, in cells.
constexpr double below_face = 0x1p-20;

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
  // The corner moved along an axis.
  const auto at = [&](std::size_t axis, int index) {
    std::array<int, 3> along = own.first;
    along[axis] = index;
    return point_of(data, sides, along);
  };
  std::array<Vec3<double>, 3> edge;
  for (std::size_t a = 0; a < 3; ++a) {
    edge[a] = world_from_data.vector(at(a, own.last[a] + 1) - corner);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    Vec3<double> normal = cross(edge[(a + 1) % 3], edge[(a + 2) % 3]);
    if (dot(normal, edge[a]) < 0) normal = -normal;
    const auto face = [&](int index) {
      const Vec3<double> on = at(a, index);
      return world_from_data.point(on + (at(a, index - 1) - on) * below_face);
    };
    const int end = own.last[a] + 1;
    if (own.first[a] > 0) clips.push_back({ClipPlane{face(own.first[a]), normal}});
    if (end < sides[a]) clips.push_back({ClipPlane{face(end), -normal}});
  }
  return clips;
}

vtkBoundingBox own_bounds(vtkDataSet& data, KeptOwnCells& kept) {
  const vtkSmartPointer<vtkUnsignedCharArray> ghosts(ghosts_of(data));
  if (ghosts == nullptr) return vtkBoundingBox(data.GetBounds());
  vtkBoundingBox box;
  const std::array<int, 3> sides = cells_along(data);
  const OwnCells own = *kept.find({ghosts, ghosts->GetMTime(), sides}, own_cells);
  if (own.count == 0) return box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<int, 3> at{};
    for (std::size_t a = 0; a < 3; ++a) {
      at[a] = (corner >> a & 1U) != 0 ? own.last[a] + 1 : own.first[a];
    }
    const Vec3<double> point = point_of(data, sides, at);
    box.AddPoint(point.x, point.y, point.z);
  }
  return box;
}

}  // namespace pellucid::plugin
