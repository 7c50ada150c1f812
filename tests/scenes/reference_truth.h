// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/scenes/reference_frame.h"

namespace pellucid::scenes {

/// Reference frames in one file, by the hash of their scenes (tests/scenes/truth.rgba64f, which
/// scripts/truth makes). A scene that has changed since is not found in it.
class ReferenceTruth {
 public:
  ReferenceTruth() = default;

  /// Reads a file. Throws std::runtime_error if it is not there, is damaged, or was made by another
  /// version of the reference.
  explicit ReferenceTruth(const std::filesystem::path& file);

  void add(const Scene& scene, ReferenceFrame frame);
  /// Returns the scene's frame; null: there is none of this scene and size.
  const ReferenceFrame* find(const Scene& scene) const;
  std::size_t size() const { return frames_.size(); }

  /// Writes a file that is the same wherever the frames are. Throws std::runtime_error.
  void write(const std::filesystem::path& file) const;

 private:
  std::map<std::uint64_t, ReferenceFrame> frames_;  ///< by scene_hash()
};

/// Where the tests have it.
std::filesystem::path truth_file();

/// Returns which of `cameras` cameras a scene has in the file: by its name, so that it stays when
/// others come.
std::size_t camera_in_turn(const std::string& scene, std::size_t cameras);

/// Width and height of the file's frames.
inline constexpr int truth_size = 16;

}  // namespace pellucid::scenes
