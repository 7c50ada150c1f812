// SPDX-License-Identifier: Apache-2.0
#include "ghost_cells.h"

#include <algorithm>
#include <limits>

#include "pellucid/scene/error.h"

namespace pellucid::vtk_scene {
namespace {

/// Distance of planes below the faces of cells, in cells.
constexpr double below_face = 0x1p-20;

}  // namespace

OwnCells own_cells(std::span<const unsigned char> flags, const std::array<int, 3>& sides) {
  OwnCells own;
  own.first.fill(std::numeric_limits<int>::max());
  own.last.fill(-1);
  std::size_t cell = 0;
  std::array<int, 3> at{};
  for (at[2] = 0; at[2] < sides[2]; ++at[2]) {
    for (at[1] = 0; at[1] < sides[1]; ++at[1]) {
      for (at[0] = 0; at[0] < sides[0]; ++at[0]) {
        if ((flags[cell++] & duplicate_cell) != 0) continue;
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

std::optional<std::vector<Clip>> clips_at_ghosts(const GhostCells& ghosts,
                                                 const Affine<double>& world_from_data,
                                                 const std::string& name) {
  const auto& [own, sides, point] = ghosts;
  std::vector<Clip> clips;
  if (own.count == 0) return std::nullopt;
  std::int64_t filled = 1;
  for (std::size_t a = 0; a < 3; ++a) filled *= own.last[a] - own.first[a] + 1;
  if (filled != own.count) {
    throw Error(name + ": its cells that are no ghosts do not fill a box; remove vtkGhostType");
  }
  const Vec3<double> corner = point(own.first);
  // The corner moved along an axis.
  const auto at = [&](std::size_t axis, int index) {
    std::array<int, 3> along = ghosts.own.first;
    along[axis] = index;
    return ghosts.point(along);
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

}  // namespace pellucid::vtk_scene
