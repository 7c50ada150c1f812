// SPDX-License-Identifier: Apache-2.0
#include "frame_maker.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "cli/render/error_map.h"
#include "pellucid/io/display_bytes.h"
#include "pellucid/io/scene_json.h"
#include "server/page_messages.h"

namespace pellucid::view {

namespace {

/// A picture while the mouse moves may take this long: some 15 of them fit into a second.
constexpr double moving_seconds = 0.06;
/// Each level has four times the pixels of the coarser one. It takes less than four times as long,
/// because rays side by side share work; at least this much more.
constexpr double level_ratio = 4, least_level_ratio = 2;
/// Once the mouse rests, sampled pictures are refined up to here; then exact ones follow.
constexpr double enough_seconds = 0.15;
/// Pixels along the longer edge of the coarsest picture.
constexpr int coarsest_edge = 64;

int preview_levels(ImageSize size) {
  const int edge = std::max(size.width, size.height);
  int levels = 0;
  while (levels < largest_preview && (edge >> (levels + 1)) >= coarsest_edge) ++levels;
  return levels;
}

PageMessage as_frame(PageMessage message) {
  message.is_frame = true;
  return message;
}

}  // namespace

void FrameMaker::begin(const Scene& scene, const Lettering& lettering, bool with_error_map,
                       std::function<bool()> is_overtaken) {
  {
    const std::lock_guard lock(mutex_);
    stop_ = {};
    shown_ = false;
  }
  scene_ = &scene;
  lettering_ = &lettering;
  with_error_map_ = with_error_map;
  is_overtaken_ = std::move(is_overtaken);
  start_ = Clock::now();
  shown_in_time_ = false;
  ++number_;
  exact_.reset();
  const double pixels = 1.0 * scene.size.width * scene.size.height;
  if (scene.integration.method == Method::exact && moving_.are_sampled(pixels, moving_seconds)) {
    begin_samples();
  } else {
    begin_final(preview_levels(scene.size));
  }
}

FrameMaker::State FrameMaker::advance(double seconds) {
  // What came while others had their turn; during one, tile_is_done() asks.
  if (shown_in_time_ && is_overtaken_()) return State::overtaken;
  return is_before_final_ ? advance_samples(seconds) : advance_final(seconds);
}

void FrameMaker::begin_samples() {
  is_before_final_ = true;
  samples_suffice_ = false;
  begin_phase(true, preview_levels(scene_->size), sampler_, sampled_scene(*scene_), false);
}

void FrameMaker::begin_final(int levels) {
  is_before_final_ = false;
  const bool is_exact = scene_->integration.method == Method::exact;
  begin_phase(!is_exact, levels, renderer_, *scene_, with_error_map_ && is_exact);
}

void FrameMaker::begin_phase(bool sampled, int levels, Renderer& renderer, const Scene& scene,
                             bool with_error) {
  is_sampled_ = sampled;
  phase_start_ = Clock::now();
  level_ = levels_ = levels;
  RenderOptions options;
  options.monitor.preview = levels;
  options.outputs.error = with_error;
  options.monitor.tile = [this](const TileResult& result) { return tile_is_done(result); };
  options.monitor.stop = stop_.get_token();
  frame_.emplace(renderer.begin(scene, std::move(options)));
}

FrameMaker::State FrameMaker::advance_samples(double seconds) {
  bool goes_on = false;
  try {
    if (!frame_->advance(seconds)) return State::goes_on;
    Image image = frame_->take().image;
    measure(0);
    goes_on = show(0, ImageView(image));
  } catch (const Cancelled&) {
    goes_on = samples_suffice_;
  }
  if (!goes_on) return State::overtaken;
  begin_final(shown_in_time_ ? std::max(shown_level_ - 1, 0) : preview_levels(scene_->size));
  return State::goes_on;
}

FrameMaker::State FrameMaker::advance_final(double seconds) {
  try {
    if (!frame_->advance(seconds)) return State::goes_on;
  } catch (const Cancelled&) {
    return State::overtaken;
  }
  auto [image, report] = frame_->take();
  frame_.reset();  // it holds the data
  measure(0);
  publish_exact(image, report);
  exact_ = std::move(image);
  return State::exact;
}

/// Notes that a level of the phase is complete.
void FrameMaker::measure(int level) {
  const double now = std::chrono::duration<double>(Clock::now() - phase_start_).count();
  const double pixels = static_cast<double>(scene_->size.width >> level) *
                        static_cast<double>(scene_->size.height >> level);
  (is_sampled_ ? sampled_seconds_ : exact_seconds_)[static_cast<std::size_t>(level)] = now;
  moving_.note(is_sampled_, now, pixels);
}

void FrameMaker::interrupt() {
  const std::lock_guard lock(mutex_);
  if (shown_) stop_.request_stop();
}

bool FrameMaker::tile_is_done(const TileResult& result) {
  // Tiles of a level follow all tiles of the coarser one.
  if (result.tile.level >= level_) {
    // A level that was expected in time and is not shows the one before it, if somebody waits.
    const bool is_late = !shown_in_time_ && level_ < levels_ && seconds() > 2 * moving_seconds;
    return !is_late || !is_overtaken_() || show(level_ + 1, result.image);
  }
  const int complete = result.tile.level + 1;
  level_ = result.tile.level;
  return level_is_done(complete, result.image);
}

bool FrameMaker::level_is_done(int level, const ImageView& image) {
  const auto l = static_cast<std::size_t>(level);
  const LevelSeconds& of_last = is_sampled_ ? sampled_seconds_ : exact_seconds_;
  const double last = of_last[l], last_finer = of_last[l - 1];
  const bool is_known = last > 0 && last_finer > 0;
  const double ratio = is_known ? std::max(last_finer / last, least_level_ratio) : level_ratio;
  measure(level);
  const double now = seconds();
  // A finer picture that is there in time is better.
  if (now * ratio <= moving_seconds) return true;
  if (!show(level, image)) return false;
  samples_suffice_ = is_sampled_ && now * ratio > enough_seconds;
  return !samples_suffice_ || scene_->integration.method != Method::exact;
}

bool FrameMaker::show(int level, const ImageView& image) {
  publish_coarse(level, image);
  shown_level_ = level;
  {
    const std::lock_guard lock(mutex_);
    shown_ = true;
  }
  shown_in_time_ = true;
  // What came before this is seen here, what comes later by interrupt().
  return !is_overtaken_();
}

void FrameMaker::publish_coarse(int level, const ImageView& image) {
  const int stride = 1 << level;
  const std::vector<std::uint8_t> bytes = display_bytes(
      image, scene_->background.value_or(calm_background()), DisplayLayout::rgba, stride);
  Json json = header("coarse", stride);
  json["sampled"] = is_sampled_;
  publish_(as_frame(binary_message(json, {as_text(bytes)})));
}

void FrameMaker::publish_exact(const Image& image, const RenderReport& report) {
  const bool is_exact = scene_->integration.method == Method::exact;
  Json json = header(is_exact ? "exact" : "sampled", 1);
  if (is_exact) {
    json["over"] = report.pixels_over_tolerance;
    json["pixels"] = report.pixels;
    json["proved"] = report.pixels_proved;
    json["largest_error"] =
        std::isfinite(report.largest_error) ? Json(report.largest_error) : Json();
  }
  json["error_map"] = !image.error.empty();
  const std::vector<std::uint8_t> bytes =
      display_bytes(image, scene_->background.value_or(calm_background()), DisplayLayout::rgba);
  std::vector<std::uint8_t> errors;
  if (!image.error.empty()) {
    errors = display_bytes(cli::error_picture(image, scene_->integration.tolerance), {},
                           DisplayLayout::rgba);
  }
  publish_(as_frame(binary_message(json, {as_text(bytes), as_text(errors)})));
}

Json FrameMaker::header(const char* state, int stride) const {
  const ImageSize size = scene_->size;
  return {{"type", "frame"},
          {"number", number_},
          {"answered", answered_},
          {"state", state},
          {"stride", stride},
          {"width", size.width},
          {"height", size.height},
          {"columns", (size.width + stride - 1) / stride},
          {"rows", (size.height + stride - 1) / stride},
          {"tolerance", scene_->integration.tolerance},
          {"seconds", seconds()},
          {"projection",
           scene_->camera.projection == Projection::perspective ? "perspective" : "orthographic"},
          {"camera", Json::parse(camera_to_json(scene_->camera))},
          {"overlay", overlay_json(*scene_, *lettering_)}};
}

double FrameMaker::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

}  // namespace pellucid::view
