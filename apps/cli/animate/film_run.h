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
#include "render/render.h"
#include "share.h"

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
  const std::vector<int>& over() const noexcept { return over_; }

 private:
  /// A frame that is to be rendered, with its data.
  struct Loaded {
    int frame = 0;
    SceneDescription description;
    std::string stamp;
    Scene scene;
  };

  void load();
  std::string stamp_of(const SceneDescription& description) const;
  /// Returns what else a picture depends on.
  std::string options_text() const;
  /// Returns the next frame from `frame` on that is not there, loaded; none: all are there.
  std::optional<Loaded> load_next(int frame);
  void render_all();
  void render(const Loaded& now, const std::function<void(double)>& show);

  const AnimateArguments& arguments_;
  FilmShare share_;
  FilmFiles files_;
  ParallelFor parallel_;
  PreparedScene prepared_;
  Animation animation_;
  std::optional<Film> film_;
  std::optional<FrameLoader> loader_;
  Renderer renderer_;
  std::vector<std::string> notes_;
  std::vector<int> over_;
  int made_ = 0;
  std::atomic<int> kept_ = 0;  ///< counted while a frame is rendered
  double largest_error_ = 0;
};

}  // namespace pellucid::cli
