// SPDX-License-Identifier: Apache-2.0
#include "axis_meaning.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "pellucid/scene/error.h"
#include "position_names.h"

namespace pellucid {

namespace {

AxisRole space_role(std::size_t place) {
  constexpr std::array roles{AxisRole::x, AxisRole::y, AxisRole::z};
  return roles[place];
}

/// Gives each meaning of space to one axis, the one with the stronger evidence.
void take_space(std::span<const AxisEvidence> evidence, NamedAxes& named) {
  for (std::size_t place = 0; place < 3; ++place) {
    bool is_tied = false;
    for (std::size_t a = 0; a < evidence.size(); ++a) {
      if (evidence[a].role != space_role(place)) continue;
      auto& taken = named.space[place];
      if (taken && evidence[*taken].strength == evidence[a].strength) is_tied = true;
      if (!taken || evidence[*taken].strength < evidence[a].strength) {
        taken = a;
        is_tied = false;
      }
    }
    if (is_tied) named.space[place].reset();
    for (std::size_t a = 0; a < evidence.size(); ++a) {
      const bool is_other = evidence[a].role == space_role(place) && named.space[place] != a;
      if (!is_other) continue;
      named.roles[a] = AxisRole::unknown;
      named.is_twofold = true;
    }
  }
}

/// Fills what is missing of x, y and z with axes that have no meaning, those of one entry last.
void fill_space(std::span<const std::int64_t> shape, NamedAxes& named) {
  for (std::size_t a = 0; a < named.roles.size(); ++a) {
    if (named.roles[a] == AxisRole::unknown) named.unknown.push_back(a);
  }
  const auto missing =
      static_cast<std::size_t>(std::count(named.space.begin(), named.space.end(), std::nullopt));
  for (std::size_t i = 0; i < named.unknown.size() && named.unknown.size() > missing;) {
    if (shape[named.unknown[i]] == 1) {
      named.unknown.erase(named.unknown.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  for (auto& axis : named.space) {
    if (axis || named.unknown.empty()) continue;
    axis = named.unknown.back();
    named.by_place.push_back(*axis);
    named.unknown.pop_back();
  }
}

/// Returns what several entries along an axis are.
const char* entries_of(AxisRole role) {
  switch (role) {
    case AxisRole::time:
      return "steps";
    case AxisRole::member:
      return "members";
    case AxisRole::channel:
      return "channels";
    default:
      return "components";
  }
}

[[noreturn]] void refuse_images(std::span<const AxisText> axes, const NamedAxes& named,
                                std::size_t place) {
  const std::string end = std::string(" and not ") + axis_letters[place] +
                          ": images, no volume; save it with an axis of depth";
  constexpr std::array named_roles{std::pair{AxisRole::time, "time"},
                                   std::pair{AxisRole::member, "members of an ensemble"},
                                   std::pair{AxisRole::channel, "channels"}};
  for (const auto& [role, what] : named_roles) {
    const auto axis = std::ranges::find(named.roles, role);
    if (axis == named.roles.end()) continue;
    const auto number = static_cast<std::size_t>(axis - named.roles.begin());
    throw Error("an array whose axis " + axes[number].name + " is " + what + end);
  }
  throw Error("an array without an axis that could be " + std::string(1, axis_letters[place]));
}

void note_places(std::span<const AxisText> axes, const NamedAxes& named, VolumeAxes& volume) {
  for (std::size_t place = 0; place < 3; ++place) {
    const std::size_t axis = volume.space[place];
    if (std::ranges::find(named.by_place, axis) == named.by_place.end()) continue;
    volume.notes.push_back("its axis " + axes[axis].name + " is taken for " + axis_letters[place] +
                           "; nothing says what it is");
  }
  for (const std::size_t axis : named.unknown) {
    volume.notes.push_back("its axis " + axes[axis].name +
                           " is taken for components; nothing says what it is");
  }
}

/// Tells which of several axes of time is the one of --time.
void note_times(std::span<const AxisText> axes, std::span<const std::int64_t> shape,
                const NamedAxes& named, VolumeAxes& volume) {
  std::string others;
  for (const std::size_t axis : named.components) {
    if (axis == named.time || named.roles[axis] != AxisRole::time || shape[axis] == 1) continue;
    others += (others.empty() ? "" : ", ") + axes[axis].name;
  }
  if (others.empty()) return;
  volume.notes.push_back("its axis " + axes[*named.time].name +
                         " is the time (--time); its other axes of time (" + others +
                         ") are taken for components");
}

}  // namespace

NamedAxes named_axes(std::span<const AxisText> axes, std::span<const std::int64_t> shape) {
  NamedAxes named;
  std::vector<AxisEvidence> evidence;
  const bool has_width = std::ranges::any_of(axes, [](const AxisText& axis) {
    return axis.coordinate.empty() && is_image_width(axis.name);
  });
  for (const AxisText& axis : axes) {
    evidence.push_back(axis_evidence(axis));
    // The height of an image, beside its width.
    if (has_width && evidence.back().role == AxisRole::z && is_image_height(axis.name)) {
      evidence.back().role = AxisRole::y;
    }
  }
  const bool has_space = std::ranges::any_of(evidence, [](const AxisEvidence& of) {
    return of.role == AxisRole::x || of.role == AxisRole::y || of.role == AxisRole::z;
  });
  for (std::size_t a = 0; a < axes.size(); ++a) {
    // Of axes a, b, c or r, s, t a letter says nothing.
    if (!has_space && is_bare_letter(axes[a].name) && evidence[a].is_by_name()) evidence[a] = {};
    named.roles.push_back(evidence[a].role);
  }
  named.is_known =
      std::ranges::any_of(named.roles, [](AxisRole role) { return role != AxisRole::unknown; });
  take_space(evidence, named);
  std::pair strongest{-1, -1};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (evidence[a].role != AxisRole::time) continue;
    // A standard name says more than any other evidence, a name less.
    const int rank = time_rank(axes[a]);
    const int strength = rank == 3 ? 10 : rank == 0 ? 0 : evidence[a].strength;
    if (std::pair{strength, rank} <= strongest) continue;
    strongest = {strength, rank};
    named.time = a;
  }
  fill_space(shape, named);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const bool is_component = named.roles[a] == AxisRole::time ||
                              named.roles[a] == AxisRole::member ||
                              named.roles[a] == AxisRole::channel;
    const bool is_left = std::ranges::find(named.unknown, a) != named.unknown.end();
    if (is_component || is_left) named.components.push_back(a);
  }
  return named;
}

std::optional<VolumeAxes> volume_axes(std::span<const AxisText> axes,
                                      std::span<const std::int64_t> shape) {
  NamedAxes named = named_axes(axes, shape);
  if (!named.is_known) return std::nullopt;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (named.roles[a] == AxisRole::corner && shape[a] > 1) {
      throw Error("bounds of cells (axis " + axes[a].name + "), no array of values");
    }
  }
  VolumeAxes volume;
  // Bands of an image, as slices of a volume.
  const auto band = std::ranges::find(named.roles, AxisRole::channel);
  const bool is_alone = named.components.size() == 1 && band != named.roles.end();
  if (is_alone && !named.space[2] && named.space[0] && named.space[1]) {
    const auto axis = static_cast<std::size_t>(band - named.roles.begin());
    volume.notes.push_back("its axis " + axes[axis].name + " is taken for z");
    named.space[2] = axis;
    named.components.clear();
  }
  for (std::size_t place = 0; place < 3; ++place) {
    if (!named.space[place]) refuse_images(axes, named, place);
    volume.space[place] = *named.space[place];
  }
  note_places(axes, named, volume);
  note_times(axes, shape, named, volume);
  volume.time = named.time;
  for (const std::size_t axis : named.components) {
    if (shape[axis] == 1) continue;
    volume.components.push_back(axis);
    volume.holds += (volume.holds.empty() ? "" : " of ") + std::to_string(shape[axis]) + " " +
                    entries_of(named.roles[axis]) + " (axis " + axes[axis].name + ")";
  }
  volume.component_count(shape);
  return volume;
}

VolumeAxes volume_axes(const ArrayAxes& axes, std::span<const std::int64_t> shape) {
  VolumeAxes volume;
  volume.space = axes.space;
  if (!axes.components) return volume;
  volume.components = {*axes.components};
  if (axes.are_steps) volume.time = axes.components;
  volume.holds = std::to_string(shape[*axes.components]) +
                 (axes.are_steps ? " steps (axis " : " components (axis ") +
                 std::to_string(*axes.components) + ")";
  return volume;
}

int VolumeAxes::component_count(std::span<const std::int64_t> shape) const {
  std::int64_t count = 1;
  for (const std::size_t axis : components) {
    if (count > std::numeric_limits<int>::max() / shape[axis]) {
      throw Error("an array of too many components");
    }
    count *= shape[axis];
  }
  return static_cast<int>(count);
}

int VolumeAxes::components_of_a_step(std::span<const std::int64_t> shape) const {
  std::int64_t inside = 1;
  for (std::size_t i = components.size(); i-- > 0 && components[i] != time;) {
    inside *= shape[components[i]];
  }
  return static_cast<int>(inside);
}

AxisPositions positions_along(const AxisText& axis) {
  AxisPositions positions;
  positions.name = axis.name;
  positions.units = text_of(axis.coordinate, "units");
  positions.down = grows_down(axis);
  positions.may_be_down = may_grow_down(axis);
  return positions;
}

}  // namespace pellucid
