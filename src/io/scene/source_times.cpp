// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "meshes/mesh_format.h"
#include "pellucid/io/time_steps.h"
#include "volumes/volume_format.h"

namespace pellucid {

namespace {

/// Returns the times as they go on, each once.
std::vector<double> in_order(std::vector<double> times) {
  std::erase_if(times, [](double time) { return std::isnan(time); });
  std::ranges::sort(times);
  const auto repeated = std::ranges::unique(times);
  times.erase(repeated.begin(), repeated.end());
  return times;
}

}  // namespace

std::vector<double> source_times(const FieldSource& source) {
  if (!source.builtin.empty()) return {};
  return in_order(volume_times(source.file, source.options));
}

std::vector<double> source_times(const MeshSource& source) {
  return in_order(mesh_times(source.file, source.options));
}

}  // namespace pellucid
