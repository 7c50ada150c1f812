// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/meshes/mesh_result.h"
#include "pellucid/scene/scene.h"

namespace pellucid::bench {

struct MeshFrameOptions {
  ImageSize size;
  std::vector<int> threads{1};
  std::size_t pixels = 2048;    ///< that are held against the reference
  std::filesystem::path cache;  ///< of reference pixels
  int repeats = 3;
  double tolerance = 1.0 / 512;         ///< of ours
  double longest_repeated_seconds = 3;  ///< frames that take longer are rendered once
  bool vtk = true;
  bool sweep = true;        ///< VTK's ZSweep mapper too, which takes minutes for large meshes
  bool sweep_axis = false;  ///< along an axis as well: six minutes for a grid of 48³ points
  bool tiny = false;
  std::vector<std::string> filters;  ///< parts of "MESH, SCENE"; none: all
  std::function<void(const std::string&)> say;
};

/// Every way of every scene, in rounds that begin at another way each time, so that a disturbance
/// of the machine does not fall on one alone.
std::vector<MeshResult> measure_mesh_frames(const MeshFrameOptions& options);

}  // namespace pellucid::bench
