// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/meshes/building.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "benchmarks/meshes/mesh_scenes.h"
#include "benchmarks/support/interleave.h"
#include "pellucid/cpu/threads.h"
#include "pellucid/field/tetrahedra.h"
#include "pellucid/scene/tetrahedralize.h"

namespace pellucid::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double seconds_to_cut(const UnstructuredGrid& grid, int threads) {
  const MeshArrayChoice value{"value", std::nullopt, {}};
  const auto start = Clock::now();
  const auto mesh = cut_into_tetrahedra(grid, {&value, 1}, parallel_for(threads));
  return seconds_since(start);
}

TetrahedralMesh::Description description_of(const TetrahedralMesh& mesh) {
  TetrahedralMesh::Description description{mesh.points(), {}, mesh.name()};
  description.tetrahedra.reserve(mesh.tetrahedra().size());
  for (const Tetrahedron& t : mesh.tetrahedra()) {
    description.tetrahedra.push_back({t[0], t[1], t[2], t[3]});
  }
  return description;
}

double seconds_to_build(const TetrahedralMesh& mesh, int threads) {
  TetrahedralMesh::Description description = description_of(mesh);
  const auto start = Clock::now();
  const TetrahedralMesh made(std::move(description), parallel_for(threads));
  return seconds_since(start);
}

/// The channel's own values, and for each of them a double and a MeshPoint that a frame makes.
double bytes_of_values(const MeshChannels& channels) {
  const auto count = static_cast<double>(channels.mesh().points().size());
  const double own =
      std::visit([](const auto& values) { return static_cast<double>(sizeof(values[0])); },
                 channels[0].values);
  return count * (own + sizeof(double) + sizeof(MeshPoint));
}

bool wants(const BuildOptions& options, const std::string& name) {
  return options.filters.empty() ||
         std::any_of(options.filters.begin(), options.filters.end(), [&](const std::string& f) {
           return name.find(f) != std::string::npos || f.find(name) != std::string::npos;
         });
}

}  // namespace

std::vector<BuildResult> measure_building(const BuildOptions& options) {
  std::vector<BuildResult> results;
  const MeshArrayChoice value{"value", std::nullopt, {}};
  for (const MeshSource& source : mesh_sources(options.tiny)) {
    if (!wants(options, source.name)) continue;
    options.say("building: " + source.name);
    const UnstructuredGrid grid = source.make();
    const auto channels =
        cut_into_tetrahedra(grid, {&value, 1}, parallel_for(default_thread_count()));
    const TetrahedralMesh& mesh = channels->mesh();
    BuildResult result;
    result.name = source.name;
    result.tetrahedra = mesh.tetrahedra().size();
    const auto count = static_cast<double>(result.tetrahedra);
    result.mesh_bytes = static_cast<double>(mesh.memory_bytes()) / count;
    result.total_bytes = result.mesh_bytes + bytes_of_values(*channels) / count;
    std::vector<std::function<double()>> ways;
    for (const int threads : options.threads) {
      ways.emplace_back([&, threads] { return seconds_to_cut(grid, threads); });
      ways.emplace_back([&, threads] { return seconds_to_build(mesh, threads); });
    }
    const std::vector<double> medians =
        interleaved_medians(ways, static_cast<std::size_t>(options.repeats));
    for (std::size_t i = 0; i < options.threads.size(); ++i) {
      result.cut_seconds.push_back(medians[2 * i]);
      result.mesh_seconds.push_back(medians[2 * i + 1]);
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace pellucid::bench
