// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "pellucid/cpu/renderer.h"
#include "pellucid/scene/error.h"
#include "tests/cuda/card.h"
#include "tests/cuda/device_examples.h"
#include "tests/scenes/gallery.h"
#include "tests/scenes/layer_makers.h"
#include "tests/scenes/meshes.h"
#include "tests/scenes/reference_frame.h"
#include "tests/scenes/verdict.h"

/// Frames of a device, beside what the matrix asks of all scenes.
namespace pellucid::scenes::test_device_frames {
namespace {

RenderOptions on(Device device) {
  RenderOptions options;
  options.machine.device = device;
  options.machine.threads = 2;
  options.outputs.error = options.outputs.depth = true;
  return options;
}

/// The devices that there are.
std::vector<Device> devices() {
  std::vector<Device> result{Device::emulated};
  if (missing_card().empty()) result.push_back(Device::cuda);
  return result;
}

bool same_bits(const Image& a, const Image& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return same(a.pixels, b.pixels) && same(a.depth, b.depth) && same(a.error, b.error) &&
         same(a.proved, b.proved);
}

void expect_agree(const Image& a, const Image& b) {
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_LE(std::abs(a.pixels[i][c] - b.pixels[i][c]), a.error[i] + b.error[i])
          << "pixel " << i;
    }
  }
}

TEST(DeviceFrames, AreTheSameToTheBitWheneverTheyAreRendered) {
  for (const Device device : devices()) {
    for (const auto& [name, scene] : device_examples(19)) {
      SCOPED_TRACE(name);
      RenderOptions options = on(device);
      Renderer renderer;
      const auto [first, report] = renderer.render(scene, options);
      EXPECT_EQ(report.rays, 19u * 19u);
      EXPECT_FALSE(report.device.starts_with("rendered by the CPU")) << report.device;
      EXPECT_TRUE(same_bits(first, renderer.render(scene, options).image));
      options.machine.threads = 1;
      EXPECT_TRUE(same_bits(first, Renderer().render(scene, options).image));
      for (const int preview : {1, 3}) {
        options.monitor.preview = preview;
        options.monitor.tile = [](const TileResult&) { return true; };
        const auto [in_levels, levels] = renderer.render(scene, options);
        EXPECT_TRUE(same_bits(first, in_levels));
        EXPECT_EQ(levels.rays, report.rays);
        EXPECT_EQ(levels.evaluations, report.evaluations);
      }
    }
  }
}

TEST(DeviceFrames, AgreeWithTheCpuAlsoInDepthAndForSeveralRaysAPixel) {
  for (const Device device : devices()) {
    for (auto& [name, scene] : device_examples(12)) {
      SCOPED_TRACE(name);
      for (const int samples : {1, 3}) {
        scene.samples = samples;
        const Image theirs = render(scene, on(device)).image,
                    ours = render(scene, on(Device::cpu)).image;
        expect_agree(theirs, ours);
        for (std::size_t i = 0; i < ours.pixels.size(); ++i) {
          // Where there is little opacity its half is where errors say.
          if (ours.pixels[i][3] < 0.2f) continue;
          ASSERT_NEAR(theirs.depth[i], ours.depth[i], 0.02) << "pixel " << i;
        }
      }
    }
  }
}

TEST(DeviceFrames, ShowACoarseLevelFirst) {
  const Scene scene = device_examples(21)[0].scene;
  RenderOptions options = on(Device::emulated);
  options.monitor.preview = 2;
  int last_level = 2;
  std::size_t pixels = 0;
  options.monitor.tile = [&](const TileResult& result) {
    EXPECT_LE(result.tile.level, last_level);
    last_level = result.tile.level;
    pixels += static_cast<std::size_t>(result.tile.columns * result.tile.rows);
    return true;
  };
  render(scene, options);
  EXPECT_EQ(last_level, 0);
  EXPECT_EQ(pixels, 21u * 21u);
}

TEST(DeviceFrames, CanBeCancelled) {
  const Scene scene = device_examples(21)[0].scene;
  RenderOptions options = on(Device::emulated);
  options.monitor.progress = [](double) { return false; };
  EXPECT_THROW(render(scene, options), Cancelled);
  std::stop_source stop;
  stop.request_stop();
  options.monitor.progress = {};
  options.monitor.stop = stop.get_token();
  EXPECT_THROW(render(scene, options), Cancelled);
}

/// Two renderers in two threads, and one in both.
TEST(DeviceFrames, DoNotDisturbEachOther) {
  const std::vector<DeviceExample> examples = device_examples(16);
  std::vector<Image> expected;
  for (const DeviceExample& example : examples) {
    expected.push_back(render(example.scene, on(Device::emulated)).image);
  }
  Renderer shared;
  const auto work = [&](bool shares) {
    Renderer own;
    for (std::size_t i = 0; i < examples.size(); ++i) {
      Renderer& renderer = shares ? shared : own;
      EXPECT_TRUE(
          same_bits(renderer.render(examples[i].scene, on(Device::emulated)).image, expected[i]))
          << examples[i].name;
    }
  };
  std::thread first(work, true), second(work, true), third(work, false);
  first.join();
  second.join();
  third.join();
}

/// Returns what is said of the device.
std::string told(const Scene& scene) {
  RenderOptions options = on(Device::emulated);
  const auto [theirs, report] = render(scene, options);
  if (report.device.starts_with("rendered by the CPU")) {
    options.machine.device = Device::cpu;
    EXPECT_TRUE(same_bits(theirs, render(scene, options).image));
  }
  return report.device;
}

TEST(DeviceFrames, GoToTheCpuAndSaySo) {
  const Scene plain = device_examples(8)[0].scene;
  const auto expect_told = [&](const char* what, const Scene& scene) {
    EXPECT_EQ(told(scene), "rendered by the CPU: devices cannot do " + std::string(what) + " yet");
  };
  Scene scene = plain;
  scene.layers.push_back(scene.layers[0]);
  expect_told("several layers or clips", scene);
  scene.layers[1].visible = false;
  EXPECT_EQ(told(scene).find("rendered by the CPU"), std::string::npos) << "only one is seen";
  scene = plain;
  scene.clips = {Clip{ClipPlane{{0, 0, 0}, {1, 0, 0}}}};
  expect_told("several layers or clips", scene);
  scene = plain;
  scene.layers[0].isosurfaces = {Isosurface{0.5}};
  expect_told("isosurfaces and slices", scene);
  scene = plain;
  scene.layers = {labels()};
  expect_told("labels", scene);
  scene.layers = {masked()};
  expect_told("masks of labels", scene);
  scene.layers = {gaussians()};
  scene.layers[0].shading = Shading{};
  expect_told("light on other data than one volume", scene);
  scene.layers = {gaussians()};
  auto& content = std::get<ChannelsContent>(scene.layers[0].content);
  content.transfer_function = std::make_shared<const MultivariateTransferFunction>(
      2, content.transfer_function->primitives(), content.transfer_function->tables(),
      ChannelTransferFunction{0, TransferFunction({{0, 1, {}}})});
  expect_told("factors of the extinction", scene);
  scene = plain;
  scene.layers[0].projection = LayerProjection::maximum;
  expect_told("projections", scene);
  scene = plain;
  scene.integration.method = Method::simpson;
  expect_told("this method", scene);
}

TEST(DeviceFrames, SampleByTheMidpointRuleAsTheCpuDoes) {
  for (const Device device : devices()) {
    Scene scene = device_examples(24)[0].scene;
    scene.integration.method = Method::midpoint;
    scene.integration.precision = Precision::float32;
    scene.integration.step = 0.1;
    const auto [theirs, report] = render(scene, on(device));
    EXPECT_FALSE(report.device.starts_with("rendered by the CPU")) << report.device;
    const auto [ours, cpu_report] = render(scene, on(Device::cpu));
    for (std::size_t i = 0; i < ours.pixels.size(); ++i) {
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_NEAR(theirs.pixels[i][c], ours.pixels[i][c], 2e-6) << "pixel " << i;
      }
      EXPECT_GE(theirs.error[i], 1) << "its error is not known";
    }
    EXPECT_LE(report.cells, cpu_report.cells);
  }
}

/// Boxes in a row, one behind the other: more hits than a ray has room for.
TEST(DeviceFrames, LeavePixelsToTheCpu) {
  TetrahedralMesh::Description row = box_of_cubes(1);
  for (int i = 1; i < 40; ++i) {
    TetrahedralMesh::Description next = box_of_cubes(1);
    for (Vec3<double>& point : next.points) point.z += 3 * i;
    row = joined(std::move(row), next);
  }
  const MeshPointer boxes = make_mesh(std::move(row));
  Scene scene;
  scene.layers = {{MeshContent{
      on_mesh(boxes, {at_points(*boxes, "z", [](const Vec3<double>& p) { return p.x; })}),
      transfer({{-1, 0.002, {1, 0, 0}}, {1, 0.01, {0, 0, 1}}})}}};
  scene.size = {9, 9};
  scene.camera = parallel_camera({0.1, 0.05, -5}, {0.003, 0.002, 1}, 2);
  for (const Device device : devices()) {
    const auto [theirs, report] = render(scene, on(device));
    EXPECT_GT(report.pixels_left, 10u);
    EXPECT_LT(report.pixels_left, 81u);
    EXPECT_NE(report.device.find("it left " + std::to_string(report.pixels_left) + " of 81"),
              std::string::npos)
        << report.device;
    EXPECT_EQ(report.rays, 81u);
    const Verdict verdict = judge(theirs, reference_frame(scene, 2), scene.integration.tolerance);
    EXPECT_TRUE(verdict.kept()) << verdict.text();
    EXPECT_EQ(verdict.said_over, 0);
    EXPECT_GT(verdict.brightest, 0.05);
  }
}

/// More control points in a cell than its light has room for at once.
TEST(DeviceFrames, CutALitCellWhereverItsTableAsksForIt) {
  Points comb;
  for (int i = 0; i <= 100; ++i) {
    comb.push_back({0.01 * i, i % 2 == 0 ? 0.0 : 6.0, {1, 0.01 * i, i % 4 < 2 ? 0.0 : 1.0}});
  }
  Layer layer = grid({2, 2, 2}, comb);
  layer.content = VolumeContent{
      sampled(
          {2, 2, 2}, [](double x, double y, double z) { return 0.5 + 0.3 * x * y + 0.2 * z; },
          "saddle"),
      transfer(comb)};
  layer.shading = Shading{};
  for (const Device device : devices()) {
    for (const double tolerance : {1.0 / 512, 1e-5}) {
      Scene scene = scene_of(exhibit({layer}), 0, 10);
      scene.integration.tolerance = tolerance;
      const Verdict verdict =
          judge(render(scene, on(device)).image, reference_frame(scene, 2), tolerance);
      EXPECT_TRUE(verdict.kept()) << verdict.text();
      EXPECT_EQ(verdict.said_over, 0);
      EXPECT_GT(verdict.brightest, 0.1);
    }
  }
}

TEST(DeviceFrames, SayThatThereIsNoCard) {
  const std::string missing = missing_card();
  if (missing.empty()) GTEST_SKIP() << "there is a card";
  EXPECT_TRUE(missing.starts_with("device cuda: ")) << missing;
  EXPECT_EQ(missing.find('\n'), std::string::npos);
  try {
    render(device_examples(4)[0].scene, on(Device::cuda));
    FAIL() << "it renders without a card";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), missing);
  }
}

}  // namespace
}  // namespace pellucid::scenes::test_device_frames
