// SPDX-License-Identifier: Apache-2.0
#include "volume_axes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

bool are_uniform(const std::vector<double>& positions, double spacing, double rounding) {
  const double largest = std::max(std::abs(positions.front()), std::abs(positions.back()));
  const double tolerance = 1e-6 * spacing + 4 * rounding * largest;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double expected = positions.front() + static_cast<double>(i) * spacing;
    if (!(std::abs(positions[i] - expected) <= tolerance)) return false;
  }
  return true;
}

}  // namespace

void place_axis(Volume::Description& description, int axis, std::vector<double> positions,
                double rounding) {
  const std::string what =
      description.name + ": the positions along " + std::string(1, "xyz"[axis]);
  for (const double position : positions) {
    if (!std::isfinite(position)) throw Error(what + " are not all finite; mend the file");
  }
  Vec3<double>& direction = description.placement.direction.column[axis];
  if (positions.size() > 1 && positions.back() < positions.front()) {
    for (double& position : positions) position = -position;
    direction = direction * -1.0;
  }
  const auto turn = std::ranges::adjacent_find(
      positions, [](double before, double after) { return !(after > before); });
  if (turn != positions.end()) {
    throw Error(what + " do not go on in one direction at number " +
                std::to_string(turn - positions.begin() + 1) +
                "; sort them, with the data, and drop repeats");
  }
  const bool cell = description.centering == Centering::cell;
  const std::size_t count = positions.size() - (cell ? 1 : 0);
  description.dimensions[static_cast<std::size_t>(axis)] = static_cast<int>(count);
  const double spacing = positions.size() < 2 ? 1
                                              : (positions.back() - positions.front()) /
                                                    static_cast<double>(positions.size() - 1);
  if (!are_uniform(positions, spacing, rounding)) {
    description.coordinates[static_cast<std::size_t>(axis)] = std::move(positions);
    return;
  }
  description.placement.spacing[axis] = spacing;
  const double first = positions.front() + (cell ? spacing / 2 : 0);
  description.placement.origin = description.placement.origin + direction * first;
}

}  // namespace pellucid
