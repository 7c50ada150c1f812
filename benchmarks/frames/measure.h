// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "tests/scenes/difference.h"
#include "tests/scenes/peers.h"

namespace pellucid::bench {

/// One way to render a scene, its time and its distance from the reference.
struct Measurement {
  Integration integration;
  std::vector<double> seconds;  ///< of each run
  scenes::Difference error;
  std::uint64_t cells = 0;  ///< cells or samples

  double median_seconds() const;
};

struct SceneResult {
  std::string name;
  ImageSize size;
  std::string data;  ///< dimensions and type
  std::vector<Measurement> measurements;

  const Measurement& find(Method method, Precision precision) const;  ///< the first such
};

struct MeasureOptions {
  int repeats = 3;
  int threads = 0;
  bool exact_only = false;
  std::vector<double> steps{2, 1, 0.5, 0.25, 0.1, 0.05, 0.02};  ///< voxels
  /// Runs that take longer are not repeated, except those of the exact method, which all others are
  /// compared with.
  double longest_repeated_seconds = 1;
  std::filesystem::path cache;
  std::function<void(const std::string&)> say;
};

/// Renders by exact (double, float) and by each sampling rule (float) at each step. The runs are
/// interleaved: every way once, then every way again, so that a disturbance of the machine does not
/// fall on one of them alone.
SceneResult measure(const scenes::NamedScene& named, const MeasureOptions& options);

}  // namespace pellucid::bench
