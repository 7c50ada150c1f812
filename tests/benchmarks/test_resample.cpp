// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdint>

#include "benchmarks/device/resample.h"
#include "pellucid/scene/error.h"
#include "tests/scenes/makers.h"

namespace pellucid::bench {
namespace {

Volume::Description description() {
  return scenes::grid_description({3, 4, 5}, {1, 2, 3}, {0.5, 0.25, 2});
}

TEST(Resample, KeepsATrilinearFieldAndItsBox) {
  const auto f = [](double x, double y, double z) { return 1 + x - 2 * y + 3 * z + x * y * z; };
  const scenes::VolumePointer old =
      scenes::make_volume<double>(description(), [&](int i, int j, int k) { return f(i, j, k); });
  const Volume fine = resampled(*old, 9);
  const std::array<int, 3> cube{9, 9, 9};
  EXPECT_EQ(fine.description().dimensions, cube);
  const auto before = old->world_corners(), after = fine.world_corners();
  for (std::size_t i = 0; i < 8; ++i) EXPECT_LT(length(before[i] - after[i]), 1e-14);
  const auto& values = std::get<DataArray<double>>(fine.data());
  std::size_t at = 0;
  for (int k = 0; k < 9; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 9; ++i) {
        EXPECT_NEAR(values[at++], f(i * 2 / 8.0, j * 3 / 8.0, k * 4 / 8.0), 1e-13);
      }
    }
  }
}

TEST(Resample, RoundsIntegers) {
  const scenes::VolumePointer old = scenes::make_volume<std::uint8_t>(
      scenes::grid_description({2, 2, 2}), [](int i, int, int) { return i == 0 ? 0 : 255; });
  const Volume fine = resampled(*old, 4);
  const auto& values = std::get<DataArray<std::uint8_t>>(fine.data());
  const std::uint8_t expected[] = {0, 85, 170, 255};
  for (std::size_t i = 0; i < 64; ++i) EXPECT_EQ(values[i], expected[i % 4]);
  // 255 / 2 = 127.5: halves go away from zero.
  EXPECT_EQ(std::get<DataArray<std::uint8_t>>(resampled(*old, 3).data())[1], 128);
}

TEST(Resample, RefusesOtherGrids) {
  Volume::Description cells = description();
  cells.centering = Centering::cell;
  const auto zero = [](int, int, int) { return 0; };
  EXPECT_THROW(resampled(*scenes::make_volume<float>(cells, zero), 9), Error);
  EXPECT_THROW(resampled(*scenes::make_volume<float>(description(), zero), 1), Error);
}

}  // namespace
}  // namespace pellucid::bench
