// SPDX-License-Identifier: Apache-2.0
#include "progress.h"

#include "tiles.h"

namespace pellucid {

Progress::Progress(const RenderOptions& options, const Image& image, const std::vector<Tile>& tiles)
    : options_(options), image_(image), levels_(static_cast<std::size_t>(options.preview) + 1) {
  for (const Tile& tile : tiles) {
    total_ += pixel_count(tile);
    ++levels_[static_cast<std::size_t>(tile.level)].tiles;
  }
}

void Progress::finish_tile(const Tile& tile) {
  if (options_.tile) {
    const std::lock_guard lock(finishing_);
    levels_[static_cast<std::size_t>(tile.level)].finished.push_back(tile);
  }
  done_ += pixel_count(tile);
  // Whoever was calling meanwhile looks again before it leaves, so that no tile is left behind.
  while (!cancelled_ && told_ < done_) {
    const std::unique_lock lock(calling_, std::try_to_lock);
    if (!lock.owns_lock()) return;
    tell();
  }
}

void Progress::ask_whether_to_go_on() {
  const std::unique_lock lock(calling_, std::try_to_lock);
  if (lock.owns_lock()) tell_share();
}

void Progress::finish() {
  if (!cancelled_) tell();
}

void Progress::tell() {
  const std::uint64_t done = done_;
  if (cancelled_ || done <= told_) return;
  tell_tiles();
  told_ = done;
  tell_share();
}

void Progress::tell_share() {
  if (cancelled_ || !options_.progress) return;
  if (!options_.progress(static_cast<double>(told_) / static_cast<double>(total_))) {
    cancelled_ = true;
  }
}

void Progress::tell_tiles() {
  Tile tile;
  while (!cancelled_ && next_tile(tile)) {
    if (!options_.tile({tile, image_})) cancelled_ = true;
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
