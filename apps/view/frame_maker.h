// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

#include "overlay.h"
#include "pellucid/cpu/internal/moving_pictures.h"
#include "pellucid/cpu/renderer.h"
#include "server/page_server.h"

namespace pellucid::view {

/// Renders frames from coarse to exact and publishes them. A frame that is overtaken by a newer
/// scene still shows one coarse picture before it ends, so that a drag is seen while it lasts.
///
/// Samples the first pictures of a frame where the exact method takes longer, as in light, and says
/// so; the exact ones follow from the finest of these on.
class FrameMaker {
 public:
  using Publish = std::function<void(PageMessage)>;

  /// `threads`: as Renderer has it.
  FrameMaker(int threads, Publish publish)
      : publish_(std::move(publish)), renderer_(threads), sampler_(threads) {}

  /// Renders the scene until it is exact, and returns true; or until it is overtaken by a newer
  /// one, and returns false. Throws Error.
  bool render(const Scene& scene, const Lettering& lettering, bool with_error_map,
              std::function<bool()> is_overtaken);
  /// Ends the frame at once if a picture of it was shown, because it is overtaken. Safe to call
  /// from any thread.
  void interrupt();

  /// Has the next frames tell which messages of each page they follow.
  void set_answered(Json answered) { answered_ = std::move(answered); }
  /// Returns the image of the last frame if it became exact.
  const std::optional<Image>& exact_image() const noexcept { return exact_; }
  void forget_image() { exact_.reset(); }
  Renderer& renderer() noexcept { return renderer_; }

 private:
  using Clock = std::chrono::steady_clock;

  /// When each level was complete, in seconds; of the last frame that had come so far. 0: none had.
  using LevelSeconds = std::array<double, largest_preview + 1>;

  /// Shows sampled pictures until a finer one would take too long. Returns false if the frame is
  /// overtaken.
  bool render_samples(const Scene& scene);
  void start_phase(bool sampled, int levels);
  void measure(int level);
  bool tile_is_done(const TileResult& result);
  bool level_is_done(int level, const ImageView& image);
  /// Publishes a complete level. Returns whether the frame goes on.
  bool show(int level, const ImageView& image);
  void publish_coarse(int level, const ImageView& image);
  void publish_exact(const Image& image, const RenderReport& report);
  Json header(const char* state, int stride) const;
  double seconds() const;

  Publish publish_;
  Renderer renderer_, sampler_;  ///< each keeps its set-ups from frame to frame
  MovingPictures moving_;
  LevelSeconds exact_seconds_{}, sampled_seconds_{};
  std::optional<Image> exact_;
  std::uint64_t number_ = 0;
  Json answered_ = Json::object();

  // Of the frame that is being rendered:
  const Scene* scene_ = nullptr;
  const Lettering* lettering_ = nullptr;
  std::function<bool()> is_overtaken_;
  Clock::time_point start_, phase_start_;
  bool is_sampled_ = false;     ///< whether the pictures that are being made are
  int levels_ = 0, level_ = 0;  ///< all but the finest; of the tiles that are being rendered
  int shown_level_ = 0;         ///< of the last picture
  bool shown_in_time_ = false;  ///< shown_, for the threads of the frame
  bool samples_suffice_ = false;

  std::mutex mutex_;  ///< of the following
  std::stop_source stop_;
  bool shown_ = false;
};

}  // namespace pellucid::view
