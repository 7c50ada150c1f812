// SPDX-License-Identifier: Apache-2.0
#include "grid_field.h"

namespace pellucid::reference {

GridField::GridField(const std::vector<const Volume*>& volumes, const DerivedChannels& derived)
    : derived_(derived) {
  grids_.reserve(volumes.size());
  for (const Volume* volume : volumes) grids_.emplace_back(*volume);
}

Real GridField::visit(const RealRay& ray, const Visit& visit) const {
  for (const Crossing& crossing : grids_.front().crossings(ray)) {
    if (!visit({crossing.t_begin, crossing.t_end, chords(crossing)})) break;
  }
  return 0;
}

std::vector<Chord> GridField::chords(const Crossing& crossing) const {
  std::vector<Chord> result;
  result.reserve(grids_.size());
  for (const Grid& grid : grids_) {
    const std::optional<Chord> chord = grid.chord(crossing);
    if (!chord) return {};
    result.push_back(*chord);
  }
  const auto grid = [&](int channel) -> const Grid& {
    return grids_[static_cast<std::size_t>(channel)];
  };
  if (derived_.gradient_of) {
    for (const Chord& component : grid(*derived_.gradient_of).gradient(crossing, derived_.kind)) {
      result.push_back(component);
    }
  }
  if (derived_.magnitude_of) {
    result.push_back(grid(*derived_.magnitude_of).gradient_magnitude(crossing));
  }
  return result;
}

}  // namespace pellucid::reference
