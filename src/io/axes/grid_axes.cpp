// SPDX-License-Identifier: Apache-2.0
#include "grid_axes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "pellucid/scene/error.h"
#include "text/text.h"
#include "volumes/volume_axes.h"
#include "zarr/ome_zarr.h"

namespace pellucid {

namespace {

/// Degrees east and degrees north are one unit.
std::string bare_unit(const std::string& unit) {
  return in_small_letters(unit).starts_with("degree") ? "degree" : unit;
}

/// Returns the metres of a unit as OME names it, or as others spell it: "metres", "Meter".
std::optional<double> length_of(const std::string& unit) {
  if (const auto metres = metres_of(unit)) return metres;
  std::string small = in_small_letters(unit);
  if (small.size() > 5 && small.ends_with('s')) small.pop_back();
  if (small.ends_with("metre")) small.replace(small.size() - 5, 5, "meter");
  return small.size() > 2 ? metres_of(small) : std::nullopt;
}

std::string list_of(const std::array<std::string, 3>& units) {
  std::string list;
  for (const std::string& unit : units) {
    if (!unit.empty()) list += (list.empty() ? "" : ", ") + unit.substr(0, 40);
  }
  return list;
}

/// Returns the number of the first position that is missing, from 1; 0 where none is.
std::size_t first_missing(const std::vector<double>& positions) {
  const auto missing = std::ranges::find_if(positions, [](double p) { return !std::isfinite(p); });
  return missing == positions.end() ? 0 : static_cast<std::size_t>(missing - positions.begin()) + 1;
}

void note_direction(const AxisPositions& positions, const std::string& letter,
                    const ReadOptions& options, const std::string& name) {
  if (!options.note) return;
  if (positions.down) {
    options.note(name + ": " + letter + " is minus " + positions.name + " (positive: down)");
  } else if (positions.may_be_down) {
    options.note(name + ": " + letter + " is " + positions.name +
                 ", which grows downwards; the picture shows it upwards");
  }
}

}  // namespace

bool unwrap_longitudes(const std::string& unit, std::vector<double>& positions) {
  if (bare_unit(unit) != "degree") return false;
  const auto jumps = [](double before, double after) { return std::abs(after - before) > 180; };
  const auto jump = std::ranges::adjacent_find(positions, jumps);
  if (jump == positions.end()) return false;
  if (std::adjacent_find(jump + 1, positions.end(), jumps) != positions.end()) return false;
  const double turn = *(jump + 1) < *jump ? 360 : -360;
  std::for_each(jump + 1, positions.end(), [&](double& position) { position += turn; });
  return true;
}

CommonUnit common_unit(const std::array<std::string, 3>& units) {
  CommonUnit common;
  bool differ = false;
  for (const std::string& unit : units) {
    if (unit.empty()) continue;
    if (common.unit.empty()) common.unit = unit;
    differ = differ || bare_unit(unit) != bare_unit(common.unit);
  }
  if (!differ) return common;
  const std::optional<double> base = length_of(common.unit);
  for (std::size_t a = 0; a < 3; ++a) {
    if (units[a].empty()) continue;
    const std::optional<double> metres = length_of(units[a]);
    if (!base || !metres) {
      common.factor = {1, 1, 1};
      common.note = "its units (" + list_of(units) +
                    ") differ and are not all known lengths; positions are taken as they are";
      return common;
    }
    common.factor[a] = *metres / *base;
  }
  common.note = "its axes have several units; lengths are turned into " + common.unit;
  return common;
}

void place_axes(Volume::Description& description, const std::array<AxisPositions, 3>& positions,
                const ReadOptions& options) {
  // A spacing that is given is that of the values, wherever the file has them.
  if (options.spacing) return;
  std::array<std::string, 3> units;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!positions[a].numbers.empty()) units[a] = positions[a].units;
  }
  const CommonUnit unit = common_unit(units);
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisPositions& along = positions[a];
    if (along.numbers.empty()) continue;
    const std::string letter(1, "xyz"[a]);
    if (const std::size_t missing = first_missing(along.numbers); missing > 0) {
      throw Error(description.name + ": the position along " + letter + " of number " +
                  std::to_string(missing) + " (" + along.name +
                  ") is missing; mend the file, or give a spacing");
    }
    std::vector<double> numbers = along.numbers;
    for (double& number : numbers) number *= unit.factor[a];
    if (a == 0 && unwrap_longitudes(along.units, numbers) && options.note) {
      options.note(description.name + ": longitudes go on where they jump by 360 degrees");
    }
    Vec3<double>& direction = description.placement.direction.column[static_cast<int>(a)];
    if (along.down) direction = direction * -1.0;
    note_direction(along, letter, options, description.name);
    try {
      place_axis(description, static_cast<int>(a), std::move(numbers), along.rounding);
    } catch (const Error& error) {
      throw Error(std::string(error.what()) + ", or give a spacing");
    }
  }
  if (options.note && !unit.note.empty()) options.note(description.name + ": " + unit.note);
}

}  // namespace pellucid
