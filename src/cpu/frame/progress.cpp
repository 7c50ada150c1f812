// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include "tiles.h"

namespace pellucid {

Progress::Progress(const RenderOptions& options, const ImageView& image,
                   const std::vector<Tile>& tiles)
    : options_(options),
      image_(image),
      levels_(static_cast<std::size_t>(options.monitor.preview) + 1) {
  for (const Tile& tile : tiles) {
    total_ += pixel_count(tile);
    ++levels_[static_cast<std::size_t>(tile.level)].tiles;
  }
}

void Progress::finish_pixels(std::size_t count) {
  done_ += count;
  tell_what_is_new();
}

void Progress::finish_tile(const Tile& tile, std::size_t count) {
  if (options_.monitor.tile) {
    const std::lock_guard lock(finishing_);
    levels_[static_cast<std::size_t>(tile.level)].finished.push_back(tile);
  }
  finish_pixels(count);
}

void Progress::tell_what_is_new() {
  ++finished_;
  // Whoever was calling meanwhile looks again before it leaves, so that no tile is left behind.
  while (!cancelled_ && told_ < finished_) {
    const std::unique_lock lock(calling_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    try {
      tell();
    } catch (...) {
      cancelled_ = true;  // Nobody calls again.
      throw;
    }
  }
}

void Progress::finish() {
  if (!cancelled_) tell();
}

void Progress::tell() {
  const std::uint64_t finished = finished_, done = done_;
  if (cancelled_ || finished <= told_) return;
  tell_tiles();
  told_ = finished;
  tell_share(done);
}

void Progress::tell_share(std::uint64_t done) {
  if (cancelled_ || !options_.monitor.progress || done <= told_pixels_) return;
  told_pixels_ = done;
  if (!options_.monitor.progress(static_cast<double>(done) / static_cast<double>(total_))) {
    cancelled_ = true;
  }
}

void Progress::tell_tiles() {
  Tile tile;
  while (!cancelled_ && next_tile(tile)) {
    if (!options_.monitor.tile({tile, image_})) cancelled_ = true;
  }
}

bool Progress::next_tile(Tile& tile) {
  const std::lock_guard lock(finishing_);
  while (levels_.size() > 1 && levels_.back().told == levels_.back().tiles) levels_.pop_back();
  Level& level = levels_.back();
  if (level.told == level.finished.size()) return false;
  tile = level.finished[level.told++];
  return true;
}

}  // namespace pellucid
