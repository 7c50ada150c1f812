// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pellucid/scene/image.h"

namespace pellucid::bench {

/// A frame and what it took.
struct TimedFrame {
  double seconds = 0;
  Image image;
  std::uint64_t work = 0;  ///< cells visited or samples taken; 0: not known
};

/// What a contender trades time for.
enum class Knob { tolerance, step };

/// A way of rendering a scene with one number that trades time for error.
struct Contender {
  std::string name;
  Knob knob = Knob::step;
  std::vector<double> settings;  ///< from the fastest to the most accurate; steps in voxels
  std::function<TimedFrame(double setting)> render;
};

}  // namespace pellucid::bench
