// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <vector>

#include "device/device_cache.h"
#include "layers/layer_setups.h"
#include "pellucid/cpu/render.h"
#include "pellucid/cpu/renderer.h"

namespace pellucid {

/// Throws Error unless render() takes the scene and the options.
void check_frame(const Scene& scene, const RenderOptions& options);

/// Returns an image of the scene's size with the outputs of the options, all of them 0.
Image make_image(ImageSize size, const FrameOutputs& outputs);

/// A frame that passed its checks and is rendered, with what is kept of others, into memory of its
/// size. All that it is given must outlive it.
class FrameWork {
 public:
  /// Prepares a frame. `threads` > 0. The options' outputs are those for which there is memory.
  FrameWork(const ImageView& image, const Scene& scene, const RenderOptions& options, int threads,
            LayerSetups& kept, DeviceCache& devices);
  ~FrameWork();
  FrameWork(const FrameWork&) = delete;
  FrameWork& operator=(const FrameWork&) = delete;

  /// Goes on for so long, and to the end of the tiles that are begun by then; the first call makes
  /// the set-up, and devices render to the end. Returns whether the frame is done. Throws
  /// Cancelled.
  bool advance(std::chrono::duration<double> time);
  /// Returns the work that the frame took, once it is done.
  const RenderReport& report() const noexcept { return report_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Tiles;

  static double seconds_since(Clock::time_point start);
  bool begin(Clock::time_point start);
  bool render_tiles(Clock::time_point end);
  bool render_level(Clock::time_point end);
  void end_level();
  void next_level();

  const ImageView image_;
  const Scene& scene_;
  const RenderOptions& options_;
  LayerSetups& kept_;
  DeviceCache& devices_;
  RenderReport report_;
  std::unique_ptr<Tiles> tiles_;  ///< null: not set up yet
};

/// Renders such a frame to its end. Throws Cancelled.
RenderReport render_frame(const ImageView& image, const Scene& scene, const RenderOptions& options,
                          int threads, LayerSetups& kept, DeviceCache& devices);

/// More than any frame takes, for FrameWork::advance().
inline constexpr std::chrono::duration<double> endless = std::chrono::hours(1000000);

/// Renders pixels again, as Renderer::render_pixels() does.
RenderResult render_pixels(const Scene& scene, const RenderOptions& options,
                           const std::vector<PixelRequest>& requests, int threads,
                           LayerSetups& kept);

}  // namespace pellucid
