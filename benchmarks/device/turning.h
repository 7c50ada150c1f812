// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/cpu/renderer.h"

namespace pellucid::bench {

/// A scene whose camera turns around its focal point, on a device that keeps its data.
class Turning {
 public:
  /// Renders the first frame, which uploads the data.
  Turning(const Scene& scene, Device device, int threads);

  const RenderResult& first() const { return first_; }
  /// Renders so many frames, each from another place, and returns how many there are in a second:
  /// by the median of their times, from the call to the image in the host's memory. After so many
  /// seconds it begins no new frame, if there are two.
  double frames_per_second(int frames, double longest = std::numeric_limits<double>::infinity());

 private:
  Scene scene_;
  RenderOptions options_;
  Renderer renderer_;
  RenderResult first_;
};

}  // namespace pellucid::bench
