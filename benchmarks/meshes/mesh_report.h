// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "benchmarks/meshes/building.h"
#include "benchmarks/meshes/mesh_result.h"
#include "benchmarks/meshes/reconstruction.h"
#include "benchmarks/meshes/segments.h"
#include "benchmarks/support/plot.h"

namespace pellucid::bench {

/// Per scene and number of threads the time of every way, and how many times ours VTK's take. Of
/// VTK's sweep, which knows no threads, the one time beside all.
std::string frame_times_table(const std::vector<MeshResult>& results,
                              const std::vector<int>& threads);
/// Per scene the largest error and the root mean square of every way, and pixels that are NaN.
std::string frame_errors_table(const std::vector<MeshResult>& results);
/// Per scene nanoseconds per ray and tetrahedron of every way on one thread.
std::string segment_costs_table(const std::vector<MeshResult>& results);

std::string segments_table(const SegmentStudy& study);
std::string contrasts_table(const SegmentStudy& study);
/// Largest error over the contrast of a segment's ends.
Plot contrasts_plot(const SegmentStudy& study);

std::string building_table(const std::vector<BuildResult>& results,
                           const std::vector<int>& threads);
std::string reconstruction_table(const std::vector<ReconstructionResult>& results);

nlohmann::ordered_json to_json(const std::vector<MeshResult>& results);
nlohmann::ordered_json to_json(const SegmentStudy& study);
nlohmann::ordered_json to_json(const std::vector<BuildResult>& results,
                               const std::vector<int>& threads);
nlohmann::ordered_json to_json(const std::vector<ReconstructionResult>& results);

}  // namespace pellucid::bench
