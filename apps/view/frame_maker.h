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

  /// Stage of a frame.
  enum class State { goes_on, exact, overtaken };

  /// Begins a frame of the scene, which must not change before it ends. `is_overtaken` tells
  /// whether there is a newer one. Throws Error.
  void begin(const Scene& scene, const Lettering& lettering, bool with_error_map,
             std::function<bool()> is_overtaken);
  /// Renders for some seconds: until the frame is exact, overtaken, or goes on another time. Throws
  /// Error, which ends the frame.
  State advance(double seconds);
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

  void begin_samples();
  void begin_final(int levels);
  void begin_phase(bool sampled, int levels, Renderer& renderer, const Scene& scene,
                   bool with_error);
  /// Goes on with what is sampled until a finer picture would take too long.
  State advance_samples(double seconds);
  State advance_final(double seconds);
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
  std::optional<SteppedFrame> frame_;  ///< of the phase: what is sampled, or what comes after
  bool is_before_final_ = false;       ///< whether another phase follows
  bool with_error_map_ = false;
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
