// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "pellucid/render/ray_result.h"
#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

struct RenderOptions {
  int threads = 0;     ///< 0: one per core
  bool depth = false;  ///< fill Image::depth
  bool error = false;  ///< fill Image::error and Image::proved
  /// Called now and then, from any one thread at a time, with the share done in [0, 1]; false
  /// cancels the frame, which then throws Cancelled.
  std::function<bool(double)> progress;
};

struct RenderReport {
  double seconds = 0;
  int threads = 0;
  std::uint64_t rays = 0;
  std::uint64_t cells = 0;  ///< cells visited (exact) or samples taken (the others)

  // Of the exact method alone:
  double largest_error = 0;         ///< of any pixel: largest bound or estimate
  std::uint64_t pixels = 0;         ///< of the image
  std::uint64_t pixels_proved = 0;  ///< whose error is a proved bound
  std::uint64_t pixels_over = 0;    ///< whose error is above the tolerance
  std::uint64_t evaluations = 0;    ///< of the field: cells gathered and points sampled
  RuleCounts spans;                 ///< by rule
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
