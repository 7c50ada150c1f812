// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <vector>

#include "pellucid/cpu/renderer.h"
#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"

/// Frames into memory of the caller.
namespace pellucid::test_render_into {
namespace {

Scene small_scene() {
  const Volume data = make_builtin_field("shells", 16);
  return Scene(Layer(data, default_transfer_function(data)), {37, 23});
}

constexpr std::array<float, 4> mark{-7, -8, -9, -10};

/// Memory with marks before and behind the pixels.
struct Buffer {
  explicit Buffer(ImageSize size) : pixels(static_cast<std::size_t>(size.width * size.height) + 2) {
    pixels.front() = pixels.back() = mark;
    view.width = size.width;
    view.height = size.height;
    view.pixels = pixels.data() + 1;
  }

  std::vector<std::array<float, 4>> pixels;
  ImageView view;
};

TEST(RenderInto, GivesThePixelsOfRenderToTheBit) {
  const Scene scene = small_scene();
  RenderOptions options;
  options.outputs.error = options.outputs.depth = true;
  const auto [image, report] = render(scene, options);
  for (const int preview : {0, 3}) {
    Buffer buffer(scene.size);
    std::vector<float> error(image.error.size()), depth(image.depth.size());
    std::vector<std::uint8_t> proved(image.proved.size());
    buffer.view.error = error.data();
    buffer.view.proved = proved.data();
    buffer.view.depth = depth.data();
    RenderOptions other;
    other.monitor.preview = preview;
    std::atomic<int> tiles{0};
    other.monitor.tile = [&](const TileResult& tile) {
      EXPECT_EQ(tile.image.pixels, buffer.view.pixels);
      ++tiles;
      return true;
    };
    const RenderReport told = render_into(buffer.view, scene, other);
    EXPECT_TRUE(std::equal(image.pixels.begin(), image.pixels.end(), buffer.view.pixels));
    EXPECT_EQ(error, image.error);
    EXPECT_EQ(proved, image.proved);
    EXPECT_EQ(depth, image.depth);
    EXPECT_EQ(buffer.pixels.front(), mark);
    EXPECT_EQ(buffer.pixels.back(), mark);
    EXPECT_EQ(told.pixels, report.pixels);
    EXPECT_EQ(told.largest_error, report.largest_error);
    EXPECT_GT(tiles, 0);
  }
}

TEST(RenderInto, HasTheOutputsForWhichThereIsMemory) {
  const Scene scene = small_scene();
  Buffer buffer(scene.size);
  RenderOptions options;
  options.outputs.error = options.outputs.depth = options.outputs.values = true;
  Renderer renderer;
  renderer.render_into(buffer.view, scene, options);
  const Image image = renderer.render(scene).image;
  EXPECT_TRUE(std::equal(image.pixels.begin(), image.pixels.end(), buffer.view.pixels));
}

TEST(RenderInto, RefusesMemoryThatDoesNotFit) {
  const Scene scene = small_scene();
  Buffer other({37, 22});
  EXPECT_THROW(render_into(other.view, scene), Error);
  Buffer buffer(scene.size);
  std::vector<float> error(buffer.pixels.size());
  buffer.view.error = error.data();
  EXPECT_THROW(render_into(buffer.view, scene), Error);
  buffer.view.error = nullptr;
  buffer.view.pixels = nullptr;
  EXPECT_THROW(render_into(buffer.view, scene), Error);
  EXPECT_THROW(render_into(ImageView{}, scene), Error);
}

TEST(RenderInto, CanBeCancelled) {
  const Scene scene = small_scene();
  Buffer buffer(scene.size);
  RenderOptions options;
  options.monitor.progress = [](double) { return false; };
  EXPECT_THROW(render_into(buffer.view, scene, options), Cancelled);
}

}  // namespace
}  // namespace pellucid::test_render_into
