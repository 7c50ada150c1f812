// SPDX-License-Identifier: Apache-2.0
#include "film_frames.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <utility>

namespace pellucid::view {

FilmFrames::FilmFrames(const Film& film, const FilmFiles& files, FrameLoader& loader,
                       ParallelFor parallel, RenderOptions options, Tasks tasks)
    : film_(film),
      files_(files),
      loader_(loader),
      parallel_(std::move(parallel)),
      options_(std::move(options)),
      tasks_(std::move(tasks)) {}

std::optional<FilmFrame> FilmFrames::load_next(int frame) {
  for (; frame < film_.frames(); ++frame) {
    if (!tasks_.is_wanted(frame)) continue;
    SceneDescription description = film_.description(frame);
    std::string made_from = tasks_.made_from(description);
    if (files_.has(frame, made_from)) {
      ++kept_;
      if (files_.text(frame, "pellucid.pixels_over").value_or("0") != "0") {
        kept_over_.push_back(frame);
      }
      continue;
    }
    Scene scene = loader_.load(description, parallel_);
    return FilmFrame{frame, std::move(description), std::move(made_from), std::move(scene)};
  }
  return std::nullopt;
}

void FilmFrames::render() {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  std::optional<FilmFrame> next = load_next(0);
  while (next) {
    const FilmFrame now = *std::move(next);
    // The next step is read while this one is rendered.
    std::future<std::optional<FilmFrame>> ahead =
        std::async(std::launch::async, [&] { return load_next(now.number + 1); });
    render(now, [&](double share_done) {
      FilmProgress progress{made_ + kept_ + 1, tasks_.frames, share_done, {}};
      if (made_ > 0) {
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        const double done = made_ + share_done;
        progress.seconds_left = seconds / done * (tasks_.frames - kept_ - done);
      }
      return tasks_.progress(progress);
    });
    ++made_;
    next = ahead.get();
  }
  over_.insert(over_.end(), kept_over_.begin(), kept_over_.end());
}

void FilmFrames::render(const FilmFrame& frame, const std::function<bool(double)>& progress) {
  RenderOptions options = options_;
  options.monitor.progress = progress;
  RenderResult result = renderer_.render(frame.scene, options);
  largest_error_ = std::max(largest_error_, result.report.largest_error);
  if (result.report.pixels_over_tolerance > 0) over_.push_back(frame.number);
  tasks_.rendered(frame, result);
  files_.write(frame.number, result.image, frame.made_from, shown_background(frame.description));
}

}  // namespace pellucid::view
