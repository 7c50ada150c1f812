// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <vector>

#include "frame.h"
#include "pixel.h"
#include "pixel_interpolator.h"

namespace pellucid {

/// Speed of rays, for frames that may have to stop soon. Shared by the threads of a frame.
class TileSpeed {
 public:
  /// Returns how many rays, a multiple of 16, are done in some 2 ms.
  std::size_t rays_at_once() const noexcept {
    const double one = seconds_per_ray_.load(std::memory_order_relaxed);
    const double rays = one > 0 ? 2e-3 / one : 64;
    return rays < 32 ? 16 : rays > 4096 ? 4096 : static_cast<std::size_t>(rays) / 16 * 16;
  }
  void tell(std::size_t rays, std::chrono::duration<double> taken) noexcept {
    seconds_per_ray_.store(taken.count() / static_cast<double>(rays), std::memory_order_relaxed);
  }

 private:
  std::atomic<double> seconds_per_ray_{0};
};

/// Options of a tile.
struct TileTask {
  int level;                   ///< of `between`, whose coarser levels are done
  PixelInterpolator* between;  ///< null: all pixels are traced
  std::stop_token stop;        ///< once it is requested, what becomes of the tile does not matter
  TileSpeed* speed;
};

/// Returns where the rays of a pixel end: at the backdrop, if there is one.
Interval<double> range_of_rays(const Scene& scene, std::size_t pixel);

/// Traces the parts of rays that lie in the frame's region. Ray n may be off by `allowance(n)`
/// times the tolerance; those that may be off by the same go together.
std::vector<RayResult> trace_region(const Frame& frame, const std::vector<RayPart>& rays,
                                    const std::function<double(std::size_t)>& allowance,
                                    double traced_tolerance_fraction, const TileTask& task);

/// Renders the pixels of the tile into the image, and adds them to the report. What a pixel becomes
/// depends on nothing but the frame and its place: neither on the tile nor on the thread. Gives how
/// many of them were not final before.
std::size_t render_tile(const Frame& frame, const Tile& tile, const TileTask& task,
                        const ImageView& image, RenderReport& report);

}  // namespace pellucid
