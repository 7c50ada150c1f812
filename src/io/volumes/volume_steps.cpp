// SPDX-License-Identifier: Apache-2.0
#include "volume_steps.h"

#include <algorithm>
#include <cmath>
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

}  // namespace

void take_steps(const VolumeSteps& steps, const ReadOptions& options, const std::string& subject,
                VolumeFile& file) {
  const std::vector<double>& times = steps.times;
  const std::string& name = file.description.name;
  file.times = times;
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
