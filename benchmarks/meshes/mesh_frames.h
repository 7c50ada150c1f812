// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/frames/reference_pixels.h"
#include "benchmarks/meshes/mesh_scenes.h"

namespace pellucid::bench {

struct MeshFrameOptions {
  ImageSize size;
  std::vector<int> threads{1};
  std::size_t pixels = 2048;    ///< that are held against the reference
  std::filesystem::path cache;  ///< of reference pixels
  int repeats = 3;
  double longest_repeated_seconds = 3;  ///< frames that take longer are rendered once
  bool vtk = true;
  bool tiny = false;
  std::vector<std::string> filters;  ///< parts of "MESH, SCENE"; none: all
  std::function<void(const std::string&)> say;
};

/// A way of rendering a scene on some threads.
struct MeshWay {
  std::string name;
  int threads = 1;
  std::vector<double> seconds;
  PixelError error;
  std::uint64_t segments = 0;    ///< pieces of rays in tetrahedra; 0: not known
  std::uint64_t nan_pixels = 0;  ///< MeshCrossings::nan_pixels

  double median_seconds() const;
};

struct MeshResult {
  std::string name;  ///< mesh and scene
  std::size_t tetrahedra = 0;
  std::size_t pixels = 0;  ///< compared
  std::vector<MeshWay> ways;

  const MeshWay* find(const std::string& way, int threads) const;  ///< null: not measured
};

/// Names of our ways: the exact method to 1/512, by grade.
inline constexpr const char* mesh_estimated_name = "exact";
inline constexpr const char* mesh_proved_name = "exact, proved";

/// Every way of every scene, in rounds that begin at another way each time, so that a disturbance
/// of the machine does not fall on one alone.
std::vector<MeshResult> measure_mesh_frames(const MeshFrameOptions& options);

}  // namespace pellucid::bench
