// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "view/command.h"
#include "view/scene_state.h"
#include "view/server/saved_files.h"

namespace pellucid::view {

/// Progress of a film that is being saved, as pages are told of it.
struct SavedFilmProgress {
  int frame = 0, frames = 0;  ///< that is rendered, from 1, of so many; past the last: encoding
  double share = 0;           ///< Share of this frame that is done
  double seconds_left = -1;   ///< negative: not known yet
};

/// A page is given a file in one message, which must fit into what may wait for it (ServerLimits).
inline constexpr std::uintmax_t largest_film = std::uintmax_t{200} << 20;

/// Returns the formats that films can be saved in here: without the program ffmpeg no videos, and
/// none in a page without a program.
std::vector<std::string> savable_film_formats();

/// Saves a film on a thread of its own: renders its frames as `pellucid animate` does, in a
/// temporary folder, and makes one file of them.
class FilmJob {
 public:
  using Progress = std::function<void(const SavedFilmProgress&)>;
  /// Gets the file, or in its place why there is none: a sentence.
  using Done = std::function<void(SavedFile, const std::string& failure)>;

  /// Throws Error for a film that cannot be made. Both functions are called by its thread, the
  /// first one at once. A file of more than `most_bytes` is none; of pictures it ends as soon as
  /// they are more.
  FilmJob(const SceneState& state, SaveFilm wanted, int threads, Progress progress, Done done,
          std::uintmax_t most_bytes = largest_film);
  /// Cancels it, and waits for its end, which FFmpeg does not hold up.
  ~FilmJob();
  FilmJob(const FilmJob&) = delete;
  FilmJob& operator=(const FilmJob&) = delete;

  /// Has it end soon, without a file.
  void cancel() noexcept { cancelled_ = true; }
  /// Returns whether its thread has called the last function.
  bool has_ended() const noexcept { return ended_; }

 private:
  std::atomic<bool> cancelled_ = false, ended_ = false;
  std::thread thread_;
};

}  // namespace pellucid::view
