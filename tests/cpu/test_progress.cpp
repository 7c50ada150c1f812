// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_progress {
namespace {

/// Of several tiles, with edges that no tile fits.
Scene scene_of_tiles() {
  Scene scene;
  test::volume_of(scene).volume =
      std::make_shared<Volume>(make_builtin_field("marschner_lobb", 16));
  test::volume_of(scene).transfer_function =
      std::make_shared<TransferFunction>(std::vector<TransferFunction::Point>{
          {0.3, 0, {1, 0.2, 0.1}}, {0.5, 2, {0.9, 0.8, 0.1}}, {1, 1, {0.2, 0.9, 0.4}}});
  scene.size = {83, 61};
  scene.camera = default_camera(*test::volume_of(scene).volume, scene.size);
  return scene;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(Preview, LeavesTheSameBitsForAnyNumberOfThreads) {
  Scene scene = scene_of_tiles();
  RenderOptions options;
  options.outputs.depth = options.outputs.error = true;
  for (const Method method : {Method::exact, Method::simpson}) {
    scene.integration.method = method;
    options.machine.threads = 1;
    options.monitor.preview = 0;
    const auto [plain, plain_report] = render(scene, options);
    for (const int preview : {0, 1, 3, largest_preview}) {
      for (const int threads : {1, 2, 3, 7}) {
        SCOPED_TRACE(std::to_string(preview) + " levels, " + std::to_string(threads) + " threads");
        options.monitor.preview = preview;
        options.machine.threads = threads;
        const auto [image, report] = render(scene, options);
        EXPECT_EQ(plain.pixels, image.pixels);
        EXPECT_TRUE(same_bits(plain.depth, image.depth));
        EXPECT_TRUE(same_bits(plain.error, image.error));
        EXPECT_EQ(plain.proved, image.proved);
        // No pixel is rendered twice.
        EXPECT_EQ(plain_report.cells, report.cells);
        EXPECT_EQ(plain_report.pixels_proved, report.pixels_proved);
      }
    }
  }
}

TEST(Preview, TilesAreToldOnceFinalAndInTheImage) {
  const Scene scene = scene_of_tiles();
  for (const int preview : {0, 2, 4}) {
    for (const int threads : {1, 2, 7}) {
      SCOPED_TRACE(std::to_string(preview) + " levels, " + std::to_string(threads) + " threads");
      RenderOptions options;
      options.monitor.preview = preview;
      options.machine.threads = threads;
      std::vector<int> told(83 * 61, 0);
      std::vector<std::array<float, 4>> seen(told.size());
      const std::array<float, 4>* memory = nullptr;
      std::atomic<int> inside{0};
      int last_level = preview;
      options.monitor.tile = [&](const TileResult& result) {
        EXPECT_EQ(++inside, 1);
        const Tile& tile = result.tile;
        EXPECT_LE(tile.level, last_level);
        last_level = tile.level;
        memory = result.image.pixels;
        for (int j = 0; j < tile.rows; ++j) {
          for (int i = 0; i < tile.columns; ++i) {
            const int column = tile.column + i * tile.stride, row = tile.row + j * tile.stride;
            const auto at = static_cast<std::size_t>(row * 83 + column);
            ++told[at];
            seen[at] = result.image.at(column, row);
          }
        }
        --inside;
        return true;
      };
      options.monitor.progress = [&](double) {
        EXPECT_EQ(++inside, 1);
        --inside;
        return true;
      };
      const Image image = render(scene, options).image;
      EXPECT_EQ(told, std::vector<int>(told.size(), 1));
      EXPECT_EQ(seen, image.pixels);
      EXPECT_EQ(memory, image.pixels.data());
    }
  }
}

TEST(Cancellation, NothingIsToldAfterwards) {
  const Scene scene = scene_of_tiles();
  for (const int threads : {1, 2, 7}) {
    for (const int last : {1, 5, 24}) {
      RenderOptions options;
      options.machine.threads = threads;
      int tiles = 0, shares = 0;
      options.monitor.tile = [&](const TileResult&) { return ++tiles < last; };
      options.monitor.progress = [&](double) {
        EXPECT_LT(tiles, last);
        ++shares;
        return true;
      };
      EXPECT_THROW(render(scene, options), Cancelled) << threads << " threads";
      EXPECT_EQ(tiles, last) << threads << " threads";
      EXPECT_LT(shares, last);

      options.monitor.tile = {};
      shares = 0;
      options.monitor.progress = [&](double) { return ++shares < 2; };
      EXPECT_THROW(render(scene, options), Cancelled) << threads << " threads";
      EXPECT_EQ(shares, 2) << threads << " threads";
    }
  }
}

TEST(Cancellation, AnExceptionOfTheCallerComesOut) {
  const Scene scene = scene_of_tiles();
  for (const int threads : {1, 3}) {
    RenderOptions options;
    options.machine.threads = threads;
    options.monitor.tile = [](const TileResult&) -> bool {
      throw std::logic_error("the viewer's");
    };
    EXPECT_THROW(render(scene, options), std::logic_error);
  }
}

TEST(Preview, LevelsOutOfRangeAreRefused) {
  RenderOptions options;
  for (const int preview : {-1, largest_preview + 1}) {
    options.monitor.preview = preview;
    EXPECT_THROW(render(scene_of_tiles(), options), Error) << preview;
  }
}

}  // namespace
}  // namespace pellucid::test_progress
