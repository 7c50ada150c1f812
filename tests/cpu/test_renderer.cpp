// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cpu/renderer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "pellucid/scene/builtin_fields.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "src/cpu/layers/layer_setups.h"
#include "tests/support/one_layer.h"

namespace pellucid::test_renderer {
namespace {

using Points = std::vector<TransferFunction::Point>;

std::shared_ptr<const TransferFunction> function(double extinction) {
  return std::make_shared<const TransferFunction>(
      Points{{0.3, 0, {1, 0.2, 0.1}}, {0.5, extinction, {0.9, 0.8, 0.1}}, {1, 1, {0.2, 0.9, 0.4}}});
}

Layer layer_of(const char* field, double extinction = 2) {
  return {VolumeContent{std::make_shared<const Volume>(make_builtin_field(field, 16)),
                        function(extinction), nullptr}};
}

Scene scene_of(std::vector<Layer> layers) {
  Scene scene;
  scene.layers = std::move(layers);
  scene.size = {61, 53};
  scene.camera = default_camera(world_corners(scene), scene.size);
  return scene;
}

/// Of work that takes seconds.
Scene slow_scene() {
  Scene scene = scene_of({layer_of("marschner_lobb"), layer_of("shells")});
  scene.size = {700, 700};
  scene.samples = 4;
  scene.integration.tolerance = 1e-6;
  return scene;
}

LayerSetting setting_of(double tolerance) {
  RayTolerance wanted;
  wanted.tolerance = tolerance;
  return {Integration{}, wanted, 0, {}, RenderOptions{}};
}

TEST(LayerSetups, AreFoundByTheIdentityOfTheirObjects) {
  LayerSetups setups;
  Layer layer = layer_of("shells");
  const auto first = setups.find(layer, setting_of(1e-3), 1);
  EXPECT_EQ(setups.find(layer, setting_of(1e-3), 1), first);
  // What does not change what a ray meets.
  layer.name = "another";
  layer.visible = false;
  layer.clips = {{ClipSphere{{0, 0, 0}, 1}}};
  EXPECT_EQ(setups.find(layer, setting_of(1e-3), 1), first);
  // Everything else.
  EXPECT_NE(setups.find(layer, setting_of(1e-2), 1), first);
  Layer moved = layer;
  moved.transform.translation = {1e-9, 0, 0};
  EXPECT_NE(setups.find(moved, setting_of(1e-3), 1), first);
  Layer other = layer;
  std::get<VolumeContent>(other.content).transfer_function = function(2);
  EXPECT_NE(setups.find(other, setting_of(1e-3), 1), first) << "equal, but not the same";
}

TEST(LayerSetups, LetGoOfWhatTheSceneHasNot) {
  LayerSetups setups;
  const Layer a = layer_of("shells"), b = layer_of("marschner_lobb");
  std::weak_ptr<const LayerSetup> of_a = setups.find(a, setting_of(1e-3), 1);
  std::weak_ptr<const LayerSetup> of_b = setups.find(b, setting_of(1e-3), 1);
  Layer hidden = a;
  hidden.visible = false;
  setups.keep_only(scene_of({hidden}));
  EXPECT_FALSE(of_a.expired());
  EXPECT_TRUE(of_b.expired());
  for (int i = 1; i <= 5; ++i) setups.find(a, setting_of(1e-3 / i), 1);
  setups.keep_only(scene_of({a}));
  EXPECT_TRUE(of_a.expired()) << "of each layer only the last ones are kept";
  setups.clear();
}

TEST(Renderer, RendersTheSameBitsAsTheFunction) {
  Renderer renderer(2);
  Scene scene = scene_of({layer_of("shells"), layer_of("marschner_lobb")});
  Affine<double> aside;
  aside.translation = {1.1, 0.3, 0};
  scene.layers[1].transform = aside;
  RenderOptions options;
  options.outputs.depth = options.outputs.error = true;
  const auto expect_same = [&](const char* what) {
    SCOPED_TRACE(what);
    const Image kept = renderer.render(scene, options).image, fresh = render(scene, options).image;
    EXPECT_EQ(kept.pixels, fresh.pixels);
    EXPECT_EQ(kept.error, fresh.error);
    EXPECT_EQ(kept.depth, fresh.depth);
    EXPECT_EQ(kept.proved, fresh.proved);
  };
  expect_same("first frame");
  expect_same("the same again");
  scene.camera.position = 1.2 * scene.camera.position;
  expect_same("another camera");
  std::get<VolumeContent>(scene.layers[0].content).transfer_function = function(5);
  expect_same("another function");
  scene.integration.grade = Grade::proved;
  expect_same("another grade");
  scene.layers[1].visible = false;
  expect_same("one layer hidden");
  scene.layers[1].visible = true;
  scene.layers[1].transform = {};
  expect_same("moved");
  scene.clips = {{ClipSphere{{0, 0, 0}, 0.8}}};
  expect_same("clipped");
  scene.background = Rgb<double>{4, 4, 4};
  expect_same("brighter behind");
  options.outputs.depth = false;
  expect_same("without depth");
  options.machine.instruction_set = InstructionSet::scalar;
  expect_same("one by one");
}

TEST(Renderer, KeepsTheSetUpOfALayerAndDropsIt) {
  Renderer renderer(1);
  Scene scene = scene_of({layer_of("shells")});
  renderer.render(scene);
  std::weak_ptr<const Volume> volume = std::get<VolumeContent>(scene.layers[0].content).volume;
  scene.layers = {layer_of("marschner_lobb")};
  EXPECT_FALSE(volume.expired()) << "kept until the next frame";
  renderer.render(scene);
  EXPECT_TRUE(volume.expired());
  volume = std::get<VolumeContent>(scene.layers[0].content).volume;
  scene.layers = {};
  renderer.clear();
  EXPECT_TRUE(volume.expired());
}

TEST(Renderer, StartsAFrameThatCanBeWatched) {
  Renderer renderer(2);
  const Scene scene = scene_of({layer_of("shells")});
  RenderOptions options;
  options.monitor.preview = 2;
  std::atomic<int> tiles{0};
  options.monitor.tile = [&](const TileResult&) {
    ++tiles;
    return true;
  };
  RunningFrame frame = renderer.start(scene, options);
  while (!frame.finished()) std::this_thread::yield();
  EXPECT_EQ(frame.state().level, 0);
  EXPECT_EQ(frame.state().fraction, 1);
  const Image seen = frame.look();
  const auto [image, report] = frame.wait();
  EXPECT_EQ(seen.pixels, image.pixels);
  EXPECT_EQ(image.pixels, render(scene).image.pixels);
  EXPECT_GT(report.rays, 0u);
  EXPECT_GT(tiles, 0) << "the caller's callback is called too";
}

TEST(Renderer, RendersAFrameInTurns) {
  Renderer renderer(2);
  for (const int preview : {0, 3}) {
    for (Scene scene : {scene_of({layer_of("shells")}), scene_of({layer_of("marschner_lobb")})}) {
      scene.size = {200, 150};
      RenderOptions options;
      options.monitor.preview = preview;
      options.outputs.error = true;
      int tiles = 0;
      options.monitor.tile = [&](const TileResult&) {
        ++tiles;
        return true;
      };
      SteppedFrame frame = renderer.begin(scene, options);
      EXPECT_THROW(frame.take(), Error) << "nothing is done yet";
      int turns = 1, told = -1;
      while (!frame.advance(0)) {
        EXPECT_GT(tiles, told) << "each turn renders something";
        told = tiles - (turns++ == 1 ? 1 : 0);
      }
      EXPECT_GT(turns, 3);
      EXPECT_TRUE(frame.advance(0)) << "a frame that is done stays so";
      const auto [image, report] = frame.take();
      options.monitor.tile = {};
      const auto [whole, of_whole] = render(scene, options);
      EXPECT_EQ(image.pixels, whole.pixels);
      EXPECT_EQ(image.error, whole.error);
      EXPECT_EQ(report.rays, of_whole.rays);
      EXPECT_EQ(report.pixels_interpolated, of_whole.pixels_interpolated);
      EXPECT_GT(report.seconds, 0);
    }
  }
}

TEST(Renderer, CancelsAFrameBetweenItsTurns) {
  Renderer renderer(1);
  std::stop_source stop;
  RenderOptions options;
  options.monitor.stop = stop.get_token();
  SteppedFrame frame = renderer.begin(slow_scene(), options);
  EXPECT_FALSE(frame.advance(0.01));
  EXPECT_THROW(frame.advance(-1), Error);
  stop.request_stop();
  EXPECT_THROW(frame.advance(1), Cancelled);
  Scene wrong = scene_of({layer_of("shells")});
  wrong.integration.tolerance = -1;
  EXPECT_THROW(renderer.begin(wrong), Error);
}

TEST(Renderer, ShowsCoarseLevelsFirst) {
  Renderer renderer(2);
  Scene scene = slow_scene();
  RenderOptions options;
  options.monitor.preview = 5;
  RunningFrame frame = renderer.start(scene, options);
  while (frame.state().level < 0 && !frame.finished()) std::this_thread::yield();
  ASSERT_FALSE(frame.finished());
  EXPECT_GE(frame.state().level, 1);
  EXPECT_LT(frame.state().fraction, 1);
  const Image image = frame.look();
  ASSERT_EQ(image.pixels.size(), 700u * 700u);
  // Every coarse pixel stands for those right of it and below it.
  const std::array<float, 4> middle = image.at(352, 352);
  EXPECT_GT(middle[3], 0);
  EXPECT_EQ(image.at(352 + 1, 352 + 1), middle);
  frame.cancel();
  EXPECT_THROW(frame.wait(), Cancelled);
}

TEST(Renderer, CancelsFromAnyThread) {
  Renderer renderer(2);
  const Scene scene = slow_scene();
  for (const bool from_outside : {false, true}) {
    std::stop_source outside;
    RenderOptions options;
    options.monitor.stop = outside.get_token();
    RunningFrame frame = renderer.start(scene, options);
    std::thread other([&] {
      if (from_outside) {
        outside.request_stop();
      } else {
        frame.cancel();
      }
    });
    EXPECT_THROW(frame.wait(), Cancelled);
    other.join();
    EXPECT_TRUE(frame.finished());
  }
  { const RunningFrame forgotten = renderer.start(scene); }  // Cancelled and waited for.
  EXPECT_FALSE(renderer.render(scene_of({layer_of("shells")})).image.pixels.empty());
}

TEST(Renderer, RendersOnSeveralThreadsAtOnce) {
  Renderer renderer(1);
  std::vector<Scene> scenes;
  std::vector<Image> images(4);
  for (std::size_t i = 0; i < images.size(); ++i) {
    scenes.push_back(scene_of({layer_of(i % 2 == 0 ? "shells" : "marschner_lobb")}));
  }
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < images.size(); ++i) {
      threads.emplace_back([&, i] { images[i] = renderer.render(scenes[i]).image; });
    }
  }
  for (std::size_t i = 0; i < images.size(); ++i) {
    EXPECT_EQ(images[i].pixels, render(scenes[i]).image.pixels) << i;
  }
}

TEST(Renderer, OutlivedByItsFrames) {
  std::optional<RunningFrame> frame;
  const Scene scene = scene_of({layer_of("shells")});
  {
    Renderer renderer(1);
    frame.emplace(renderer.start(scene));
  }
  EXPECT_EQ(frame->wait().image.pixels, render(scene).image.pixels);
}

TEST(Renderer, TellsErrors) {
  EXPECT_THROW(Renderer(-1), Error);
  Renderer renderer(1);
  Scene scene = scene_of({layer_of("shells")});
  scene.integration.tolerance = -1;
  EXPECT_THROW(renderer.render(scene), Error);
  RunningFrame frame = renderer.start(scene);
  EXPECT_THROW(frame.wait(), Error);
}

std::shared_ptr<Image> backdrop_of(ImageSize size, float depth) {
  auto image = std::make_shared<Image>();
  image->width = size.width;
  image->height = size.height;
  const auto pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  image->pixels.assign(pixels, {0.5f, 0.25f, 0.125f, 0.5f});
  image->depth.assign(pixels, depth);
  return image;
}

TEST(Backdrop, IsSeenWhereNothingIsInFrontOfIt) {
  Scene scene = scene_of({layer_of("shells")});
  const auto backdrop = backdrop_of(scene.size, 0);
  scene.backdrop = backdrop;
  RenderOptions options;
  options.outputs.depth = options.outputs.error = true;
  const Image image = render(scene, options).image;
  EXPECT_EQ(image.pixels, backdrop->pixels);
  EXPECT_EQ(image.depth, backdrop->depth);
}

TEST(Backdrop, BehindAllDataIsUnderThem) {
  Scene scene = scene_of({layer_of("shells")});
  const Image data = render(scene).image;
  scene.backdrop = backdrop_of(scene.size, 1e6f);
  const Image image = render(scene).image;
  for (std::size_t i = 0; i < data.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const float behind = scene.backdrop->pixels[i][c];
      EXPECT_NEAR(image.pixels[i][c], data.pixels[i][c] + (1 - data.pixels[i][3]) * behind,
                  2 * scene.integration.tolerance);
    }
  }
}

TEST(Backdrop, ThatDoesNotFitIsRefused) {
  Scene scene = scene_of({layer_of("shells")});
  const auto message = [&] {
    try {
      render(scene);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  scene.backdrop = backdrop_of({10, 10}, 1);
  EXPECT_EQ(message(),
            "backdrop: has 10 x 10 pixels, but the image has 61 x 53; make both the same");
  auto image = backdrop_of(scene.size, 1);
  scene.backdrop = image;
  image->depth.clear();
  EXPECT_NE(message().find("backdrop: has no depth"), std::string::npos) << message();
  for (const float bad : {-1.0f, std::numeric_limits<float>::quiet_NaN()}) {
    image = backdrop_of(scene.size, 1);
    image->depth[62] = bad;
    scene.backdrop = image;
    EXPECT_NE(message().find("in column 1, row 1, but must be 0 or more"), std::string::npos)
        << message();
  }
  for (const float bad : {-1.0f, std::numeric_limits<float>::infinity(), 1.5f}) {
    image = backdrop_of(scene.size, 1);
    image->pixels[0][3] = bad;
    scene.backdrop = image;
    EXPECT_NE(message().find("in column 0, row 0"), std::string::npos) << message();
  }
}

}  // namespace
}  // namespace pellucid::test_renderer
