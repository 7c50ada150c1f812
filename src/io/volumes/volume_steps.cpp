// SPDX-License-Identifier: Apache-2.0
#include "volume_steps.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>

#include "axes/time_steps.h"
#include "meshes/mesh_blocks.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

/// Leaves the components of one step, of a file whose steps have several.
void keep_step(int step, int steps, int inside, VolumeFile& file) {
  file.components /= steps;
  file.holds = "one step of " + file.holds;
  file.read = [read = file.read, step, steps, inside](ComponentRange range) {
    std::vector<VolumeData> values;
    for (int c = range.first; c < range.first + range.number; ++c) {
      const int component = (c / inside * steps + step) * inside + c % inside;
      values.push_back(std::move(read({component, 1, range.part}).front()));
    }
    return values;
  };
}

bool are_equal(const Vec3<double>& a, const Vec3<double>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool are_on_one_grid(const Volume::Description& a, const Volume::Description& b) {
  const GridPlacement &p = a.placement, &q = b.placement;
  return a.dimensions == b.dimensions && a.centering == b.centering &&
         a.coordinates == b.coordinates && are_equal(p.origin, q.origin) &&
         are_equal(p.spacing, q.spacing) &&
         std::ranges::equal(p.direction.column, q.direction.column, are_equal);
}

template <class Value>
bool is_double(const DataArray<Value>&) {
  return std::is_same_v<Value, double>;
}

}  // namespace

VolumeData values_between(const VolumeData& before, const VolumeData& after, double share) {
  const auto is_wide = [](const VolumeData& data) {
    return std::visit([](const auto& values) { return is_double(values); }, data);
  };
  const auto fill = [&](const auto& from, const auto& to, auto values) {
    using Value = typename std::decay_t<decltype(values)>::value_type;
    const std::span<Value> out = values.writable();
    for (std::size_t i = 0; i < out.size(); ++i) {
      out[i] = static_cast<Value>((1 - share) * static_cast<double>(from[i]) +
                                  share * static_cast<double>(to[i]));
    }
    return VolumeData(std::move(values));
  };
  return std::visit(
      [&](const auto& from, const auto& to) {
        return is_wide(before) || is_wide(after) ? fill(from, to, DataArray<double>(from.size()))
                                                 : fill(from, to, DataArray<float>(from.size()));
      },
      before, after);
}

Volume volume_between(const Volume& before, const Volume& after, const std::string& name,
                      double share) {
  if (!are_on_one_grid(before.description(), after.description())) {
    throw Error(name +
                ": the steps around the time stand on different grids, so nothing is linear "
                "between them; take the nearest step");
  }
  return {before.description(), values_between(before.data(), after.data(), share)};
}

void take_steps(const VolumeSteps& steps, const ReadOptions& options, const std::string& subject,
                VolumeFile& file) {
  const std::vector<double>& times = steps.times;
  const std::string& name = file.description.name;
  file.times = times;
  file.times_unit = steps.unit;
  refuse_movie(times.size(), file.description.dimensions[2], options, name);
  if (!options.time) {
    if (options.note && times.size() > 1) {
      options.note(subject + "holds " + times_note(times, steps.unit));
    }
    return;
  }
  if (times.empty()) throw Error(subject + "has no steps in time; leave the time out");
  if (std::ranges::all_of(times, [](double time) { return std::isnan(time); })) {
    throw Error(subject + "has steps, but their times are missing (NaN); choose one by its number" +
                ", as a component");
  }
  const std::size_t nearest = nearest_step(times, options.time);
  const auto step = static_cast<int>(nearest), count = static_cast<int>(times.size());
  const bool has_others = file.components > count;
  if (!has_others && (options.component || options.component_name)) {
    throw Error(name + ": give a time or a component, not both");
  }
  if (options.note) {
    options.note(name + ": " + step_note(times, nearest, *options.time, steps.unit));
  }
  if (has_others) {
    keep_step(step, count, steps.inside, file);
  } else if (count > 1) {
    file.step = step;
  }
}

}  // namespace pellucid
