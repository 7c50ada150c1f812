// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "pellucid/cpu/render.h"

namespace pellucid {

/// Tells the caller of finished tiles and of the share done, and asks whether to go on. One thread
/// at a time calls; the others leave their tiles to it and never wait.
class Progress {
 public:
  /// Reports a frame. All must outlive the object. `tiles` are those of the frame.
  Progress(const RenderOptions& options, const ImageView& image, const std::vector<Tile>& tiles);

  /// Notes that so many pixels more are final, of which no tile is to be told yet. Any thread.
  void finish_pixels(std::size_t count);
  /// Notes that all pixels of the tile are final, of which so many were not before. Any thread.
  void finish_tile(const Tile& tile, std::size_t count);
  /// Tells what is left to tell, when all threads are done: one may have been calling when the last
  /// tile was.
  void finish();
  bool cancelled() const noexcept { return cancelled_; }

 private:
  /// The tiles of a level, told of only after all of the coarser one.
  struct Level {
    std::size_t tiles = 0;  ///< of the frame
    std::size_t told = 0;
    std::vector<Tile> finished;
  };

  void tell_what_is_new();
  void tell();
  void tell_share(std::uint64_t done);
  void tell_tiles();
  bool next_tile(Tile& tile);

  const RenderOptions& options_;
  const ImageView& image_;
  std::uint64_t total_ = 0;  ///< pixels
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::uint64_t> finished_{0};  ///< calls that finished something
  std::atomic<bool> cancelled_{false};
  std::mutex calling_;
  std::atomic<std::uint64_t> told_{0};  ///< of finished_; written under calling_
  std::uint64_t told_pixels_ = 0;       ///< of done_; under calling_
  std::mutex finishing_;                ///< of the levels
  std::vector<Level> levels_;
};

}  // namespace pellucid
