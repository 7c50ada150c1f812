// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

struct RenderOptions {
  int threads = 0;     ///< 0: one per core
  bool depth = false;  ///< fill Image::depth
  /// Called now and then, from any one thread at a time, with the share done in [0, 1]; false
  /// cancels the frame, which then throws Cancelled.
  std::function<bool(double)> progress;
};

struct RenderReport {
  double seconds = 0;
  int threads = 0;
  std::uint64_t rays = 0;
  std::uint64_t cells = 0;  ///< cells visited (exact) or samples taken (the others)
};

/// Thrown where the progress callback returned false.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("rendering was cancelled") {}
};

/// Renders the scene with its own method and precision. The image is bitwise the same for any
/// number of threads. Throws Error for what `scene` checks (camera, sizes, step).
Image render(const Scene& scene, const RenderOptions& options = {}, RenderReport* report = nullptr);

}  // namespace pellucid
