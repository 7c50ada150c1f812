// SPDX-License-Identifier: Apache-2.0
#include "src/cpu/device/device_cache.h"

#include <gtest/gtest.h>

#include <memory>

#include "src/cpu/frame/render_frame.h"
#include "src/cpu/layers/layer_setups.h"
#include "tests/cuda/device_examples.h"
#include "tests/scenes/layer_makers.h"

/// What frames of a renderer leave in a device's memory.
namespace pellucid::scenes::test_kept_devices {
namespace {

class KeptFrames {
 public:
  KeptFrames() { options_.machine.device = Device::emulated; }
  /// Renders a frame and returns the bytes that it uploaded.
  std::uint64_t upload(const Scene& scene) {
    const std::uint64_t before = arrays().uploaded_bytes();
    Image image = make_image(scene.size, options_.outputs);
    render_frame(ImageView(image), scene, options_, 2, setups_, devices_);
    return arrays().uploaded_bytes() - before;
  }
  std::uint64_t kept() { return arrays().kept_bytes(); }

 private:
  ResidentArrays& arrays() { return devices_.find(Device::emulated)->arrays(); }

  RenderOptions options_;
  LayerSetups setups_;
  DeviceCache devices_;
};

TEST(DeviceCache, UploadNothingWhenTheCameraMoves) {
  for (auto& [name, scene] : device_examples(8)) {
    SCOPED_TRACE(name);
    KeptFrames frames;
    EXPECT_GT(frames.upload(scene), 1000u);
    scene.camera.position = scene.camera.position + Vec3<double>{0.1, 0, 0};
    EXPECT_EQ(frames.upload(scene), 0u);
    scene.samples = 2;
    EXPECT_EQ(frames.upload(scene), 0u);
  }
}

TEST(DeviceCache, KeepTheDataWhenTheFunctionChanges) {
  constexpr std::uint64_t bytes = 40 * 40 * 40 * sizeof(float);
  Scene scene = device_examples(8)[0].scene;
  scene.layers = {grid({40, 40, 40}, jumps(3))};
  KeptFrames frames;
  EXPECT_GT(frames.upload(scene), bytes);
  for (const double extinction : {2.0, 1.0, 4.0, 5.0, 6.0, 7.0, 8.0}) {
    auto& content = std::get<VolumeContent>(scene.layers[0].content);
    content.transfer_function = transfer(jumps(extinction));
    const std::uint64_t changed = frames.upload(scene);
    EXPECT_GT(changed, 0u);
    EXPECT_LT(changed, bytes / 4);
    EXPECT_LT(frames.kept(), 2 * bytes) << "old functions are let go of";
  }
}

TEST(DeviceCache, LetGoOfDataThatAreNotShown) {
  const auto examples = device_examples(8);
  KeptFrames frames;
  frames.upload(examples[0].scene);
  const std::uint64_t alone = frames.kept();
  frames.upload(examples[7].scene);
  EXPECT_GT(frames.kept(), alone);
  for (int i = 0; i < 8; ++i) frames.upload(examples[0].scene);
  EXPECT_LE(frames.kept(), alone);
}

}  // namespace
}  // namespace pellucid::scenes::test_kept_devices
