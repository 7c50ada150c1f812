// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cuda/trace_pixel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/cuda/grid_scene.h"

/// The functions of a card, one pixel after the other.
namespace pellucid::scenes::test_trace_pixel {
namespace {

constexpr int size = 21;
constexpr std::uint32_t pixels = size * size;

/// Memory for a frame.
struct Memory {
  std::vector<float> color = std::vector<float>(4 * pixels), depth = std::vector<float>(pixels),
                     error = std::vector<float>(pixels);
  std::vector<std::uint8_t> proved = std::vector<std::uint8_t>(pixels);
  DeviceImage view() { return {color.data(), depth.data(), error.data(), proved.data(), size}; }

  bool same(const Memory& other, std::uint32_t pixel) const {
    return std::memcmp(&color[4 * pixel], &other.color[4 * pixel], 16) == 0 &&
           std::memcmp(&depth[pixel], &other.depth[pixel], 4) == 0 &&
           error[pixel] == other.error[pixel] && proved[pixel] == other.proved[pixel];
  }
};

template <class Value>
VolumePointer waves(double scale) {
  return make_volume<Value>(
      grid_description({20, 19, 18}, {-1, -1, -1}, {0.1, 0.11, 0.12}), [=](int i, int j, int k) {
        return scale * (0.5 + 0.45 * std::sin(0.9 * i) * std::cos(0.5 * j - 0.2 * k));
      });
}

Points sheets(double scale) {
  return {{0, 0, {1, 1, 1}},
          {0.3 * scale, 0.2, {1, 0.5, 0}},
          {0.5 * scale, 6, {0, 0.5, 1}},
          {0.5 * scale, 1, {0, 1, 0}},
          {0.8 * scale, 0, {0, 1, 0}}};
}

template <class Value>
void expect_same_in_both_passes(double scale, double tolerance, int& single, int& again) {
  GridScene given(waves<Value>(scale), transfer(sheets(scale)), tolerance, size);
  given.scene().with_depth = true;
  Memory first, second;
  for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
    const PixelOutcome fast =
        trace_pixel<DeviceLook::grid, true>(given.scene(), first.view(), pixel);
    const PixelOutcome full =
        trace_pixel<DeviceLook::grid, false>(given.scene(), second.view(), pixel);
    ASSERT_EQ(full.fate, PixelFate::stored);
    // What the host's own function finds in data of their own type.
    const Ray<double> ray = given.volume().grid_from_world().ray(
        given.scene().camera.ray(static_cast<int>(pixel % size), static_cast<int>(pixel / size)));
    const RayResult typed = given.volume().visit([&](const auto& grid) {
      return integrate_ray(grid, &given.scene().lit.blocks, ray, given.scene().transfer,
                           given.scene().wanted, true);
    });
    const StoredPixel stored = stored_pixel(typed, given.scene().limits);
    ASSERT_EQ(std::memcmp(stored.color, &second.color[4 * pixel], 16), 0) << "pixel " << pixel;
    ASSERT_EQ(std::memcmp(&stored.depth, &second.depth[pixel], 4), 0) << "pixel " << pixel;
    ASSERT_EQ(full.evaluations, typed.evaluations);
    if (fast.fate == PixelFate::stored) {
      ++single;
      EXPECT_EQ(full.spans.in_double, 0u);
      ASSERT_TRUE(first.same(second, pixel)) << "pixel " << pixel;
      ASSERT_EQ(fast.evaluations, full.evaluations);
    } else {
      ++again;
      ASSERT_EQ(fast.fate, PixelFate::needs_double);
      EXPECT_GT(full.spans.in_double, 0u);
    }
  }
}

TEST(TracePixel, IsTheSameInBothPassesAndForAllTypes) {
  int single = 0, again = 0;
  for (const double tolerance : {1e-2, 1.0 / 512, 1e-4, 1e-6}) {
    expect_same_in_both_passes<std::uint8_t>(250, tolerance, single, again);
    expect_same_in_both_passes<std::int8_t>(120, tolerance, single, again);
    expect_same_in_both_passes<std::uint16_t>(60000, tolerance, single, again);
    expect_same_in_both_passes<std::int16_t>(30000, tolerance, single, again);
    expect_same_in_both_passes<std::uint32_t>(4e9, tolerance, single, again);
    expect_same_in_both_passes<std::int32_t>(2e9, tolerance, single, again);
    expect_same_in_both_passes<float>(1, tolerance, single, again);
    expect_same_in_both_passes<double>(1, tolerance, single, again);
  }
  EXPECT_GT(single, 1000);
  EXPECT_GT(again, 1000);
}

TEST(TracePixel, NamesPixelsOfALattice) {
  const PixelLattice lattice{3, 2, 4, 5, 2};
  std::vector<std::uint32_t> found;
  for (std::int64_t i = 0; i < lattice.count(); ++i) found.push_back(pixel_number(lattice, i, 100));
  std::vector<std::uint32_t> expected;
  for (std::uint32_t row : {2u, 4u, 6u, 8u, 10u}) {
    for (std::uint32_t column : {3u, 5u, 7u, 9u}) expected.push_back(100 * row + column);
  }
  EXPECT_EQ(found, expected);
  // Of an image with more pixels than an int counts.
  EXPECT_EQ(pixel_number({0, 0, 65536, 65535, 1}, 65536LL * 65534 + 7, 65536), 4294836231u);
}

/// Samples in empty blocks are left out, and no others.
TEST(SampleBlocks, GivesTheSamplesOfTheWholeRay) {
  const VolumePointer ball = sampled(
      {40, 40, 40}, [](double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); },
      "ball");
  for (const double step : {0.3, 0.05, 0.011}) {
    for (std::size_t camera = 0; camera < 3; ++camera) {
      GridScene given(ball,
                      transfer({{0.2, 0, {1, 1, 1}}, {0.3, 3, {1, 0.5, 0}}, {0.35, 0, {0, 0, 1}}}),
                      1.0 / 512, size, camera);
      given.scene().sampling_step = step;
      std::int64_t taken = 0, all = 0;
      for (std::uint32_t pixel = 0; pixel < pixels; ++pixel) {
        const Ray<double> ray = given.volume().grid_from_world().ray(given.scene().camera.ray(
            static_cast<int>(pixel % size), static_cast<int>(pixel / size)));
        const RayResult found = sample_blocks(given.scene(), ray, HalfOpacity{}.range);
        const RayResult whole =
            sample_ray<float>(given.scene().lit.grid, ray, given.scene().transfer.single,
                              SegmentRule::midpoint, step, 1, device_stop_tolerance, false);
        taken += found.cells;
        all += whole.cells;
        ASSERT_LE(found.cells, whole.cells);
        // A sample at a plane between two blocks may be of either.
        ASSERT_NEAR(found.opacity, whole.opacity, 1e-7) << "pixel " << pixel;
        ASSERT_NEAR(found.radiance.r, whole.radiance.r, 1e-7) << "pixel " << pixel;
      }
      EXPECT_LT(taken, all) << "step " << step << ", camera " << camera;
      EXPECT_GT(taken, 0);
    }
  }
}

}  // namespace
}  // namespace pellucid::scenes::test_trace_pixel
