// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/frames/reference_pixels.h"

namespace pellucid::bench {

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
  /// On the least threads that it was measured on: pictures do not depend on them.
  const MeshWay* find(const std::string& way) const;
};

/// Names of our ways: the exact method, by grade.
inline constexpr const char* mesh_estimated_name = "exact";
inline constexpr const char* mesh_proved_name = "exact, proved";

}  // namespace pellucid::bench
