// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/cpu/renderer.h"
#include "pellucid/io/film.h"
#include "pellucid/io/film_files.h"

namespace pellucid::view {

/// A frame of a film with its data.
struct FilmFrame {
  int number = 0;  ///< from 0
  SceneDescription description;
  std::string made_from;  ///< all that its picture depends on
  Scene scene;
};

/// Progress of a film that is being rendered.
struct FilmProgress {
  int frame = 1, frames = 0;           ///< number of the frame that is rendered, from 1, of so many
  double share_done = 0;               ///< Share of this frame
  std::optional<double> seconds_left;  ///< none: no frame was rendered yet
};

/// Renders the frames of a film to its files: those that are not there, one after the other. The
/// next one's data are read while one is rendered.
class FilmFrames {
 public:
  struct Tasks {
    /// Frames that are rendered, and how many they are.
    std::function<bool(int frame)> is_wanted;
    int frames = 0;
    /// Returns all that a picture depends on, by which it is known again.
    std::function<std::string(const SceneDescription&)> made_from;
    /// Returns false to end the film.
    std::function<bool(const FilmProgress&)> progress;
    /// Is told of each picture before it is written, and may change it.
    std::function<void(const FilmFrame&, RenderResult&)> rendered;
  };

  /// Takes references to film, files and loader, which must outlive it.
  FilmFrames(const Film& film, const FilmFiles& files, FrameLoader& loader, ParallelFor parallel,
             RenderOptions options, Tasks tasks);

  /// Throws Error, and Cancelled where `progress` ends it.
  void render();

  /// Return how many pictures were made, and how many were there.
  int made() const noexcept { return made_; }
  int kept() const noexcept { return kept_; }
  double largest_error() const noexcept { return largest_error_; }
  /// Returns the frames with pixels over the tolerance, also of those that were there.
  const std::vector<int>& over() const noexcept { return over_; }

 private:
  /// Returns the next frame from `frame` on that is not there, loaded; none: all are there.
  std::optional<FilmFrame> load_next(int frame);
  void render(const FilmFrame& frame, const std::function<bool(double)>& progress);

  const Film& film_;
  const FilmFiles& files_;
  FrameLoader& loader_;
  ParallelFor parallel_;
  RenderOptions options_;
  Tasks tasks_;
  Renderer renderer_;
  std::vector<int> over_, kept_over_;  ///< these are counted while a frame is rendered
  int made_ = 0;
  std::atomic<int> kept_ = 0;  ///< counted while a frame is rendered
  double largest_error_ = 0;
};

}  // namespace pellucid::view
