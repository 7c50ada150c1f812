// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pellucid/cpu/render.h"
#include "tests/scenes/peers.h"

namespace pellucid::bench {

struct SpeedOptions {
  Device device = Device::cuda;
  int threads = 0;  ///< of the CPU; 0: one per core
  int frames = 30;  ///< of a measurement on the device; on the CPU a tenth of them
  /// After so many seconds a measurement begins no new frame, if it has two.
  double seconds = std::numeric_limits<double>::infinity();
  std::size_t pixels = 2048;    ///< that the reference is asked for
  std::filesystem::path cache;  ///< of reference pixels; empty: none
  bool cpu = true;
};

/// Frames per second of one scene, 0 where they were not measured, and the largest errors over the
/// reference's pixels, negative where there are none.
struct Speed {
  std::string scene;
  std::string device;  ///< RenderReport::device
  double first = 0;    ///< seconds of the first frame, with the set-up and the upload
  double exact = 0;    ///< on the device
  double exact_error = -1;
  double tolerance = 0;
  double in_double = 0;  ///< share of the pixels that were followed again in binary64
  double left = 0;       ///< share of the pixels that the device left to the CPU
  double sampler = 0;    ///< midpoint rule on the device
  double sampler_error = -1;
  double step = 0;  ///< of the sampler, voxels
  double cpu = 0;
};

/// Measures a scene: the device, the CPU, and the sampler on the device at the coarsest step of
/// halves whose largest error is not above the device's. Light has no sampler. Calls `progress`
/// with what there is after each of them.
Speed measure_speed(const scenes::NamedScene& scene, const SpeedOptions& options,
                    const std::function<void(const Speed&)>& progress = {});

/// Makes the scenes whose names contain one of `parts`, all if there is none: haze, band and spike
/// in the Marschner-Lobb field and the scan bonsai, with `points` values along each axis, and
/// behind them the same in light ("spike, oblique, lit"). Appends what has no file to `missing`.
std::vector<scenes::NamedScene> speed_scenes(int points, ImageSize size,
                                             const std::vector<std::string>& parts,
                                             std::vector<std::string>& missing);

/// A table of Markdown, with the devices below it.
std::string speed_markdown(const std::vector<Speed>& rows);

nlohmann::ordered_json to_json(const Speed& speed);
Speed speed_from_json(const nlohmann::ordered_json& json);

}  // namespace pellucid::bench
