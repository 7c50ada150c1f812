// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/film.h"
#include "pellucid/io/film_files.h"
#include "render/render.h"
#include "share.h"
#include "view/film/film_frames.h"

namespace pellucid::cli {

struct AnimateArguments {
  RenderArguments scene;
  std::string output, times;
  std::optional<double> seconds, fps, turns;
  std::optional<int> frames;
  bool keeps_frames = false;
  std::string part;
  bool ranks = false;
};

/// Film that is loaded and rendered, one frame after the other. The arguments must outlive it.
class FilmRun {
 public:
  /// Throws Error if the film cannot be written.
  FilmRun(const AnimateArguments& arguments, FilmShare share);

  /// Renders the frames of the share that are not there. Throws Error, UsageError and Interrupted.
  void operator()() {
    load();
    render_all();
  }
  /// Prints what is told of the film.
  void tell(const std::string& path) const;

  const FilmFiles& files() const noexcept { return files_; }
  const Film& film() const { return *film_; }
  double fps() const noexcept { return animation_.fps; }
  /// Returns the frames with pixels over the tolerance.
  const std::vector<int>& over() const noexcept { return frames_->over(); }

 private:
  void load();
  std::string stamp_of(const SceneDescription& description) const;
  /// Returns what else a picture depends on.
  std::string options_text() const;
  void render_all();
  /// Adds metadata and color bars to the picture of a frame.
  void complete(const view::FilmFrame& frame, RenderResult& result);

  const AnimateArguments& arguments_;
  FilmShare share_;
  FilmFiles files_;
  ParallelFor parallel_;
  PreparedScene prepared_;
  Animation animation_;
  std::optional<Film> film_;
  std::optional<FrameLoader> loader_;
  std::optional<view::FilmFrames> frames_;
  std::vector<std::string> notes_;
};

}  // namespace pellucid::cli
