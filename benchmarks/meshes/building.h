// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pellucid::bench {

/// What it takes to make a mesh that rays can walk through, from cells in memory.
struct BuildResult {
  std::string name;
  std::size_t tetrahedra = 0;
  std::vector<double> cut_seconds;   ///< per number of threads: cutting, structure, channels
  std::vector<double> mesh_seconds;  ///< of that the structure: from tetrahedra to TetrahedralMesh
  double mesh_bytes = 0;             ///< per tetrahedron: TetrahedralMesh::memory_bytes()
  double total_bytes = 0;  ///< per tetrahedron: with the channel, and what a frame keeps of it
};

struct BuildOptions {
  std::vector<int> threads{1};
  int repeats = 3;
  bool tiny = false;
  std::vector<std::string> filters;  ///< parts of the meshes' names, or of theirs; none: all
  std::function<void(const std::string&)> say;
};

std::vector<BuildResult> measure_building(const BuildOptions& options);

}  // namespace pellucid::bench
