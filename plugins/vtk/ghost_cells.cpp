// SPDX-License-Identifier: Apache-2.0
#include "ghost_cells.h"

#include <vtkDataSet.h>
#include <vtkDataSetAttributes.h>
#include <vtkImageData.h>
#include <vtkRectilinearGrid.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "pellucid/scene/error.h"

namespace pellucid::plugin {
namespace {

/// In cells along each axis; the last is one of them.
struct CellBox {
  std::array<int, 3> sides{}, first{}, last{};
  vtkIdType count = 0;  ///< of cells that are no ghosts
};

std::array<int, 3> sides_of(vtkDataSet& data) {
  std::array<int, 3> sides{};
  if (auto* const image = vtkImageData::SafeDownCast(&data)) image->GetDimensions(sides.data());
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(&data)) grid->GetDimensions(sides.data());
  for (int& side : sides) --side;
  return sides;
}

vtkUnsignedCharArray* ghosts_of(vtkDataSet& data) {
  vtkUnsignedCharArray* const ghosts = data.GetCellGhostArray();
  return ghosts != nullptr && ghosts->GetNumberOfValues() == data.GetNumberOfCells() ? ghosts
                                                                                     : nullptr;
}

CellBox own_cells(vtkDataSet& data, vtkUnsignedCharArray& ghosts) {
  CellBox box{sides_of(data)};
  box.first.fill(std::numeric_limits<int>::max());
  box.last.fill(-1);
  vtkIdType cell = 0;
  std::array<int, 3> at{};
  for (at[2] = 0; at[2] < box.sides[2]; ++at[2]) {
    for (at[1] = 0; at[1] < box.sides[1]; ++at[1]) {
      for (at[0] = 0; at[0] < box.sides[0]; ++at[0]) {
        if ((ghosts.GetValue(cell++) & vtkDataSetAttributes::DUPLICATECELL) != 0) continue;
        ++box.count;
        for (std::size_t a = 0; a < 3; ++a) {
          box.first[a] = std::min(box.first[a], at[a]);
          box.last[a] = std::max(box.last[a], at[a]);
        }
      }
    }
  }
  return box;
}

Vec3<double> point_of(vtkDataSet& data, const std::array<int, 3>& sides,
                      const std::array<int, 3>& at) {
  const vtkIdType row = sides[0] + 1, slab = row * (sides[1] + 1);
  double point[3];
  data.GetPoint(at[0] + row * at[1] + slab * at[2], point);
  return {point[0], point[1], point[2]};
}

}  // namespace

std::vector<Clip> clips_at_ghosts(vtkDataSet& data, const Affine<double>& world_from_data) {
  vtkUnsignedCharArray* const ghosts = ghosts_of(data);
  if (ghosts == nullptr) return {};
  const CellBox own = own_cells(data, *ghosts);
  if (own.count == 0 || own.count == data.GetNumberOfCells()) return {};
  vtkIdType filled = 1;
  for (std::size_t a = 0; a < 3; ++a) filled *= own.last[a] - own.first[a] + 1;
  if (filled != own.count) {
    throw Error(std::string(data.GetClassName()) +
                ": its cells that are no ghosts do not fill a box; remove vtkGhostType");
  }
  const Vec3<double> corner = point_of(data, own.sides, own.first);
  std::array<Vec3<double>, 3> edge;
  std::array<int, 3> end{};
  for (std::size_t a = 0; a < 3; ++a) end[a] = own.last[a] + 1;
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<int, 3> along = own.first;
    along[a] = end[a];
    edge[a] = world_from_data.vector(point_of(data, own.sides, along) - corner);
  }
  std::vector<Clip> clips;
  for (std::size_t a = 0; a < 3; ++a) {
    Vec3<double> normal = cross(edge[(a + 1) % 3], edge[(a + 2) % 3]);
    if (dot(normal, edge[a]) < 0) normal = -normal;
    const Vec3<double> point = world_from_data.point(corner);
    if (own.first[a] > 0) clips.push_back({ClipPlane{point, normal}});
    if (end[a] < own.sides[a]) clips.push_back({ClipPlane{point + edge[a], -normal}});
  }
  return clips;
}

bool is_all_ghosts(vtkDataSet& data) {
  vtkUnsignedCharArray* const ghosts = ghosts_of(data);
  return ghosts != nullptr && own_cells(data, *ghosts).count == 0;
}

}  // namespace pellucid::plugin
