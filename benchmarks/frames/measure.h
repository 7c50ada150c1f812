// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>

#include "benchmarks/frames/pellucid_contenders.h"
#include "benchmarks/frames/scene_result.h"
#include "tests/scenes/peers.h"

namespace pellucid::bench {

struct MeasureOptions {
  PellucidSettings pellucid;  ///< its threads are for all contenders
  bool vtk = true;
  std::vector<double> vtk_steps{1, 0.5, 0.25, 0.1};  ///< voxels
  int repeats = 5;  ///< rounds at most, and two at least where there are as many
  /// A scene gets no further round after this time, which that for the reference does not count in.
  double scene_seconds = 45;
  /// A curve ends where its next frame is expected to take longer; one that steps goes on until it
  /// is ten times slower than exact at all of `compared_errors` that it does not come within,
  /// unless a frame would take half a minute.
  double longest_seconds = 1.5;
  /// Frames that take longer are not repeated.
  double longest_repeated_seconds = 1;
  std::size_t pixels = 2048;
  std::filesystem::path cache;  ///< of reference pixels
  std::function<void(const std::string&)> say;
};

/// Every contender at every setting, in `repeats` rounds. The runs are interleaved: each round is
/// one frame of every way, and begins at another place, so that a disturbance of the machine, or
/// its slow drift, does not fall on one contender alone.
SceneResult measure(const scenes::NamedScene& named, const MeasureOptions& options);

}  // namespace pellucid::bench
