// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/sub_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

void check_box(const std::array<int, 3>& dimensions, const IndexBox& box, const std::string& name) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (box.first[a] < 0 || box.count[a] < 1 || box.first[a] > dimensions[a] - box.count[a]) {
      throw Error((name.empty() ? "volume" : name) + ": values " + std::to_string(box.first[a]) +
                  " to " + std::to_string(std::int64_t{box.first[a]} + box.count[a] - 1) +
                  " along axis " + std::to_string(a) + " are asked for, but there are " +
                  std::to_string(dimensions[a]) + "; give a part that is inside");
    }
  }
}

/// Returns the positions of the values along a rectilinear axis, in its own coordinates.
std::vector<double> positions(const std::vector<double>& coordinates, Centering centering) {
  if (centering == Centering::point) return coordinates;
  std::vector<double> centres;
  for (std::size_t i = 0; i + 1 < coordinates.size(); ++i) {
    centres.push_back(std::midpoint(coordinates[i], coordinates[i + 1]));
  }
  return centres;
}

/// Returns the index of the last value at or before `lower`, and of the first at or behind `upper`;
/// -1 and the number of values if there is none.
std::pair<double, double> around(double lower, double upper, const std::vector<double>& places) {
  if (places.empty()) return {std::floor(lower), std::ceil(upper)};
  const auto before = std::ranges::upper_bound(places, lower) - places.begin() - 1;
  const auto behind = std::ranges::lower_bound(places, upper) - places.begin();
  return {static_cast<double>(before), static_cast<double>(behind)};
}

}  // namespace

Affine<double> world_from_grid(const Volume::Description& description) noexcept {
  const GridPlacement& placement = description.placement;
  Affine<double> map;
  map.translation = placement.origin;
  for (int a = 0; a < 3; ++a) {
    const bool uniform = description.coordinates[static_cast<std::size_t>(a)].empty();
    map.matrix.column[a] = placement.direction.column[a] * (uniform ? placement.spacing[a] : 1.0);
  }
  return map;
}

IndexBox indices_around(const Volume::Description& description,
                        const std::array<Vec3<double>, 8>& corners, int more) {
  const Affine<double> grid_from_world = inverse(world_from_grid(description));
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // Far beyond the rounding of positions, in cells.
  constexpr double beside = 1e-6;
  IndexBox box;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    double lower = infinity, upper = -infinity;
    for (const Vec3<double>& corner : corners) {
      const double at = grid_from_world.point(corner)[a];
      lower = std::min(lower, at);
      upper = std::max(upper, at);
    }
    const std::vector<double> places =
        positions(description.coordinates[axis], description.centering);
    const double size = places.size() > 1
                            ? (places.back() - places.front()) / static_cast<double>(places.size())
                            : 1;
    const auto [before, behind] = around(lower - beside * size, upper + beside * size, places);
    const int last = description.dimensions[axis] - 1;
    const double first = std::clamp(before - more, 0.0, std::max(last - 1.0, 0.0));
    const double end = std::clamp(behind + more, std::min(first + 1, double{1} * last), 1.0 * last);
    box.first[axis] = static_cast<int>(first);
    box.count[axis] = static_cast<int>(end - first) + 1;
  }
  return box;
}

Volume::Description sub_description(const Volume::Description& description, const IndexBox& box) {
  check_box(description.dimensions, box, description.name);
  Volume::Description part = description;
  part.dimensions = box.count;
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const std::vector<double>& all = description.coordinates[axis];
    if (all.empty()) {
      part.placement.origin =
          part.placement.origin + description.placement.direction.column[a] *
                                      (description.placement.spacing[a] * box.first[axis]);
      continue;
    }
    const int faces = description.centering == Centering::cell ? 1 : 0;
    const auto begin = all.begin() + box.first[axis];
    part.coordinates[axis].assign(begin, begin + box.count[axis] + faces);
  }
  return part;
}

VolumeData sub_values(const VolumeData& values, const std::array<int, 3>& dimensions,
                      const IndexBox& box) {
  check_box(dimensions, box, "");
  const auto size = [](int n) { return static_cast<std::size_t>(n); };
  const std::size_t row = size(box.count[0]);
  return std::visit(
      [&](const auto& all) -> VolumeData {
        std::decay_t<decltype(all)> part(row * size(box.count[1]) * size(box.count[2]));
        auto* to = part.writable().data();
        for (int k = 0; k < box.count[2]; ++k) {
          for (int j = 0; j < box.count[1]; ++j) {
            const std::size_t y = size(box.first[1] + j), z = size(box.first[2] + k);
            const std::size_t from =
                size(box.first[0]) + size(dimensions[0]) * (y + size(dimensions[1]) * z);
            to = std::copy_n(all.data() + from, row, to);
          }
        }
        return part;
      },
      values);
}

Volume sub_volume(const Volume& volume, const IndexBox& box) {
  const Volume::Description& whole = volume.description();
  const Volume part(sub_description(whole, box), sub_values(volume.data(), whole.dimensions, box));
  return part.as_part_of(volume.statistics().minimum, volume.statistics().maximum);
}

}  // namespace pellucid
