// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>

#include "pellucid/scene/tetrahedralize.h"

namespace pellucid {
namespace {

/// Returns the positions of the cells' corners along an axis, in the grid's own coordinates: at the
/// values, or at the faces between them.
std::vector<double> corners_along(const Volume::Description& d, std::size_t axis) {
  if (!d.coordinates[axis].empty()) return d.coordinates[axis];
  const bool cell = d.centering == Centering::cell;
  std::vector<double> at(static_cast<std::size_t>(d.dimensions[axis]) + (cell ? 1 : 0));
  for (std::size_t i = 0; i < at.size(); ++i) at[i] = static_cast<double>(i) - (cell ? 0.5 : 0.0);
  return at;
}

}  // namespace

UnstructuredGrid to_unstructured(const Volume& volume) {
  const Volume::Description& d = volume.description();
  const std::array<std::vector<double>, 3> at{corners_along(d, 0), corners_along(d, 1),
                                              corners_along(d, 2)};
  UnstructuredGrid grid;
  grid.name = d.name;
  grid.corners = grid_hexahedra({static_cast<int>(at[0].size()), static_cast<int>(at[1].size()),
                                 static_cast<int>(at[2].size())});
  grid.shapes.assign(grid.corners.size() / 8, CellShape::hexahedron);
  grid.points.reserve(at[0].size() * at[1].size() * at[2].size());
  for (const double z : at[2]) {
    for (const double y : at[1]) {
      for (const double x : at[0]) grid.points.push_back(volume.world_from_grid().point({x, y, z}));
    }
  }
  grid.arrays.push_back({"value", d.centering, 1, volume.data()});
  return grid;
}

}  // namespace pellucid
