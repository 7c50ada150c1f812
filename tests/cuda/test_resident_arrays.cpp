// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cuda/resident_arrays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <set>

#include "pellucid/cpu/threads.h"
#include "pellucid/scene/error.h"
#include "tests/cuda/grid_scene.h"

namespace pellucid::scenes::test_resident_arrays {
namespace {

/// A device that counts what it is asked for, and has little memory.
class CountingBackend : public DeviceBackend {
 public:
  explicit CountingBackend(std::size_t room = 1 << 30) : room_(room) {}
  ~CountingBackend() override { EXPECT_TRUE(blocks_.empty()) << "memory is left"; }

  std::string name() const override { return "counting"; }
  void* allocate(std::size_t bytes) override {
    if (bytes > room_) throw Error("no room");
    room_ -= bytes;
    void* const memory = inner_->allocate(bytes);
    blocks_.insert(memory);
    return memory;
  }
  void release(void* memory) noexcept override {
    EXPECT_EQ(blocks_.erase(memory), 1u);
    inner_->release(memory);
  }
  void upload(void* to, const void* from, std::size_t bytes) override {
    ++uploads;
    inner_->upload(to, from, bytes);
  }
  void download(void* to, const void* from, std::size_t bytes) override {
    inner_->download(to, from, bytes);
  }
  void clear(void* memory, std::size_t bytes) override { inner_->clear(memory, bytes); }
  void trace(const DeviceScene& scene, const DeviceTask& task,
             const ParallelFor& parallel) override {
    inner_->trace(scene, task, parallel);
  }
  bool owns(const void* memory) const { return blocks_.contains(const_cast<void*>(memory)); }

  int uploads = 0;

 private:
  std::unique_ptr<DeviceBackend> inner_ = make_emulated_backend();
  std::set<void*> blocks_;
  std::size_t room_;
};

std::shared_ptr<GridScene> ramp_scene(double extinction = 2) {
  return std::make_shared<GridScene>(
      sampled(
          {20, 20, 20}, [](double x, double y, double) { return x * y; }, "saddle"),
      transfer({{-0.5, 0, {1, 1, 1}}, {0.5, extinction, {1, 0.5, 0}}}), 1.0 / 512, 8);
}

TEST(ResidentArrays, HoldACopyOfAllThatASceneNeeds) {
  CountingBackend backend;
  ResidentArrays arrays(backend);
  const auto given = ramp_scene();
  DeviceScene there = arrays.resident(given->scene(), given);
  int checked = 0;
  DeviceScene here = given->scene();
  std::vector<std::pair<const void*, std::size_t>> originals;
  for_each_array(here, [&](const auto& pointer, std::int64_t count) {
    originals.emplace_back(pointer, sizeof(*pointer) * static_cast<std::size_t>(count));
  });
  std::size_t i = 0;
  for_each_array(there, [&](const auto& pointer, std::int64_t count) {
    ASSERT_LT(i, originals.size());
    const auto [original, bytes] = originals[i++];
    EXPECT_TRUE(backend.owns(pointer));
    EXPECT_NE(static_cast<const void*>(pointer), original);
    ASSERT_EQ(bytes, sizeof(*pointer) * static_cast<std::size_t>(count));
    EXPECT_EQ(std::memcmp(pointer, original, bytes), 0);
    ++checked;
  });
  EXPECT_EQ(i, originals.size());
  EXPECT_GE(checked, 10);
}

TEST(ResidentArrays, AreUploadedOnce) {
  CountingBackend backend;
  ResidentArrays arrays(backend);
  const auto given = ramp_scene();
  const DeviceScene first = arrays.resident(given->scene(), given);
  const int uploads = backend.uploads;
  const std::uint64_t bytes = arrays.uploaded_bytes();
  EXPECT_EQ(bytes, arrays.kept_bytes());
  EXPECT_GT(bytes, 20u * 20 * 20 * sizeof(float));
  arrays.end_frame();
  given->scene().camera.position.x += 1;
  const DeviceScene second = arrays.resident(given->scene(), given);
  EXPECT_EQ(backend.uploads, uploads);
  EXPECT_EQ(arrays.uploaded_bytes(), bytes);
  EXPECT_EQ(first.lit.grid.data, second.lit.grid.data);
  EXPECT_EQ(second.camera.position.x, given->scene().camera.position.x);
}

TEST(ResidentArrays, AreLetGoOfAndKeepTheirOriginalsUntilThen) {
  CountingBackend backend;
  ResidentArrays arrays(backend);
  auto old = ramp_scene();
  const std::weak_ptr<GridScene> watched = old;
  arrays.resident(old->scene(), old);
  arrays.end_frame();
  old.reset();
  EXPECT_FALSE(watched.expired()) << "another object could take its place in memory";
  const auto next = ramp_scene(3);
  for (int frame = 0; frame < 8; ++frame) {
    arrays.resident(next->scene(), next);
    arrays.end_frame();
  }
  EXPECT_TRUE(watched.expired());
  std::uint64_t bytes = 0;
  DeviceScene scene = next->scene();
  for_each_array(scene, [&](const auto& pointer, std::int64_t count) {
    bytes += sizeof(*pointer) * static_cast<std::uint64_t>(count);
  });
  // Arrays at one address are kept once.
  EXPECT_LE(arrays.kept_bytes(), bytes);
  EXPECT_GT(arrays.kept_bytes(), bytes / 2);
}

TEST(ResidentArrays, ReleaseAllIfThereIsNoRoom) {
  CountingBackend backend(33000);
  ResidentArrays arrays(backend);
  const auto given = ramp_scene();
  EXPECT_THROW(arrays.resident(given->scene(), given), Error);
  arrays.clear();
  EXPECT_EQ(arrays.kept_bytes(), 0u);
}

/// The copies alone are enough: the originals are destroyed before the rays are followed.
TEST(ResidentArrays, AreAllThatRaysLookAt) {
  CountingBackend backend;
  ResidentArrays arrays(backend);
  std::vector<float> colors[2];
  for (std::vector<float>& color : colors) {
    color.resize(4 * 64);
    auto given = ramp_scene();
    const DeviceScene there = arrays.resident(given->scene(), nullptr);
    if (&color == &colors[1]) given.reset();
    const ParallelFor parallel = parallel_for(2);
    std::vector<std::uint32_t> in_double(64), left(64);
    DeviceCounts counts;
    DeviceTask task;
    task.pixels = {0, 0, 8, 8, 1};
    task.image.color = color.data();
    task.image.width = 8;
    task.in_double.pixel = in_double.data();
    task.left.pixel = left.data();
    task.counts = &counts;
    backend.trace(there, task, parallel);
    EXPECT_EQ(counts.left, 0u);
    EXPECT_EQ(counts.over, 0u);
    EXPECT_GT(counts.evaluations, 0u);
    arrays.clear();
  }
  EXPECT_EQ(colors[0], colors[1]);
  EXPECT_GT(*std::ranges::max_element(colors[0]), 0.1f);
}

}  // namespace
}  // namespace pellucid::scenes::test_resident_arrays
