// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "axes/time_steps.h"
#include "meshes/mesh_format.h"
#include "pellucid/io/time_steps.h"
#include "volumes/volume_format.h"

namespace pellucid {

StepTimes source_steps(const FieldSource& source) {
  if (!source.builtin.empty()) return {};
  StepTimes steps = volume_times(source.file, source.options);
  steps.times = ascending_times(std::move(steps.times));
  return steps;
}

StepTimes source_steps(const MeshSource& source) {
  return {ascending_times(mesh_times(source.file, source.options))};
}

std::vector<double> source_times(const FieldSource& source) {
  return source_steps(source).times;
}

std::vector<double> source_times(const MeshSource& source) {
  return source_steps(source).times;
}

}  // namespace pellucid
