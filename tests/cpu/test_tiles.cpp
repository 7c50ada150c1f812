// SPDX-License-Identifier: Apache-2.0
#include "src/cpu/frame/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "src/cpu/frame/progress.h"
#include "src/cpu/threads.h"

namespace pellucid::test_tiles {
namespace {

TEST(Tiles, HoldEachPixelOnceFromCoarseToFine) {
  static_assert(tile_edge % 4 == 0);
  for (const ImageSize size : {ImageSize{1, 1}, {16, 16}, {17, 1}, {1, 40}, {83, 61}, {512, 300}}) {
    for (int preview = 0; preview <= largest_preview; ++preview) {
      SCOPED_TRACE(std::to_string(size.width) + " x " + std::to_string(size.height) + ", preview " +
                   std::to_string(preview));
      const auto width = static_cast<std::size_t>(size.width);
      std::vector<int> level_of(width * static_cast<std::size_t>(size.height), -1);
      int last_level = preview;
      for (const Tile& tile : make_tiles(size, preview)) {
        ASSERT_LE(tile.level, last_level);
        last_level = tile.level;
        ASSERT_TRUE(tile.columns >= 1 && tile.columns <= tile_edge);
        ASSERT_TRUE(tile.rows >= 1 && tile.rows <= tile_edge);
        for (int j = 0; j < tile.rows; ++j) {
          for (int i = 0; i < tile.columns; ++i) {
            const int column = tile.column + i * tile.stride, row = tile.row + j * tile.stride;
            ASSERT_TRUE(column < size.width && row < size.height);
            int& level =
                level_of[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)];
            ASSERT_EQ(level, -1) << column << ", " << row;
            level = tile.level;
          }
        }
      }
      // Level n is there for every square of 2ⁿ pixels, and nowhere else.
      for (int row = 0; row < size.height; ++row) {
        for (int column = 0; column < size.width; ++column) {
          int coarsest = preview;
          while (((column | row) & ((1 << coarsest) - 1)) != 0) --coarsest;
          ASSERT_EQ(
              level_of[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)],
              coarsest)
              << column << ", " << row;
        }
      }
    }
  }
}

TEST(Tiles, GoFromTheMiddleOutwards) {
  const std::vector<Tile> tiles = make_tiles({16 * 7, 16 * 5}, 0);
  ASSERT_EQ(tiles.size(), 35u);
  EXPECT_EQ(tiles[0].column, 48);
  EXPECT_EQ(tiles[0].row, 32);
  int last = 0;
  for (const Tile& tile : tiles) {
    const int ring = std::max(std::abs(tile.column - 48), std::abs(tile.row - 32));
    EXPECT_GE(ring, last);
    last = ring;
  }
}

/// Tiles that are finished out of order, as by threads of unequal speed.
TEST(Progress, TellsOfACoarseLevelFirst) {
  RenderOptions options;
  options.monitor.preview = 1;
  std::vector<int> levels;
  options.monitor.tile = [&](const TileResult& result) {
    levels.push_back(result.tile.level);
    return true;
  };
  const ImageView image;
  std::vector<Tile> tiles = make_tiles({64, 64}, 1);
  ASSERT_EQ(tiles.size(), 4u + 12u);
  Progress progress(options, image, tiles);
  std::swap(tiles[3], tiles[15]);
  for (const Tile& tile : tiles) progress.finish_tile(tile, pixel_count(tile));
  progress.finish();
  EXPECT_EQ(levels.size(), tiles.size());
  EXPECT_TRUE(std::ranges::is_sorted(levels, std::greater<>()));
}

}  // namespace
}  // namespace pellucid::test_tiles
