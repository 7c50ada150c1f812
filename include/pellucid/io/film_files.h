// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "pellucid/scene/background.h"
#include "pellucid/scene/image.h"
#include "pellucid/scene/scene.h"

namespace pellucid {

struct SceneDescription;

/// The pictures of a film on disk: numbered files, or those that a video is made of by FFmpeg. A
/// picture has what it was made from in its metadata, so that a film that was interrupted goes on
/// where it ended.
class FilmFiles {
 public:
  /// Takes a video (.webm: VP9, .mp4: H.264), whose pictures are in a folder beside it until it
  /// is done, or the name of pictures with a place for their number, counted from 0, as
  /// "frames/%04d.png" or ".exr", whose folder is made where it is missing. Throws Error if it is
  /// none of these or cannot be written, or FFmpeg or its encoder is not there.
  explicit FilmFiles(std::filesystem::path path);

  bool is_video() const noexcept { return !folder_.empty(); }
  /// Throws Error if FFmpeg cannot encode a video of this size. Does nothing if no video is wanted.
  void check_size(ImageSize size) const;
  /// Holds the folder of a video's pictures, which is made, until release(): alone, or beside
  /// others that render parts of the film. An empty folder goes with it. Does nothing if no video
  /// is wanted. Throws Error if another one holds it.
  enum class Holder { alone, beside_others };
  void hold(Holder holder);
  /// Ends that.
  void release() noexcept { hold_.reset(); }
  /// Returns the path of a picture, counted from 0.
  std::filesystem::path picture(int frame) const;

  /// Returns whether the picture of a frame is there, whole, and was made from the same.
  bool has(int frame, const std::string& made_from) const;
  /// Returns what the picture of a frame that is there says of itself under a name of its metadata.
  std::optional<std::string> text(int frame, const std::string& name) const;
  /// Writes the picture of a frame. A .png is composited over the background, if there is one; of a
  /// video without one over calm_background().
  /// Throws Error.
  void write(int frame, const Image& image, const std::string& made_from,
             const std::optional<Background>& background) const;
  /// Makes the video of so many pictures, and removes them unless `keeps_pictures`; those of a
  /// longer film, too, that are left behind them. Does nothing if no video is wanted. Throws Error
  /// with what FFmpeg says. `ended` is asked some twenty times a second: where it returns true
  /// FFmpeg is ended, no video is left, and false is returned.
  bool finish(int frames, double fps, bool keeps_pictures,
              const std::function<bool()>& ended = {}) const;

 private:
  class Hold;

  /// Removes pictures of a longer film.
  void remove_behind(int frames) const;

  std::filesystem::path path_, folder_;  ///< folder of a video's pictures; empty: none is wanted
  std::string before_, after_;           ///< the number in the name of a picture
  int digits_ = 6;
  std::shared_ptr<const Hold> hold_;
};

/// Returns what says of which data a scene was made: size and time of change of each file.
std::string data_stamp(const SceneDescription& description);

}  // namespace pellucid
