// SPDX-License-Identifier: Apache-2.0
#include "axes/time_steps.h"
#include "meshes/mesh_format.h"
#include "pellucid/io/time_steps.h"
#include "volumes/volume_format.h"

namespace pellucid {

std::vector<double> source_times(const FieldSource& source) {
  if (!source.builtin.empty()) return {};
  return ascending_times(volume_times(source.file, source.options));
}

std::vector<double> source_times(const MeshSource& source) {
  return ascending_times(mesh_times(source.file, source.options));
}

}  // namespace pellucid
