// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "tests/cuda/card.h"
#include "tests/cuda/device_matrix.h"
#include "tests/scenes/test_names.h"

/// The scenes of the tolerance matrix by the functions of a card: no pixel is over what it says.
namespace pellucid::scenes::test_device_matrix {

namespace {

void expect_kept(const GalleryEntry& entry, Device device, int size) {
  const Exhibit exhibit = entry.make(size);
  DeviceRow all;
  for (std::size_t camera = 0; camera < exhibit.cameras.size(); ++camera) {
    const DeviceRow row = check_on_device(entry, exhibit, camera, device, size);
    for (const std::string& fault : row.faults) ADD_FAILURE() << fault;
    if (!row.on_device) return;
    all.pixels += row.pixels;
    all.in_double += row.in_double;
    all.left += row.left;
  }
  std::printf("[ device   ] %-50s %zu pixels: %llu again in double, %llu left to the CPU\n",
              entry.name.c_str(), all.pixels, static_cast<unsigned long long>(all.in_double),
              static_cast<unsigned long long>(all.left));
}

class DeviceMatrix : public testing::TestWithParam<GalleryEntry> {};

TEST_P(DeviceMatrix, NoPixelIsOverOnTheCpu) {
  if (const std::string why = GetParam().why_missing(); !why.empty()) GTEST_SKIP() << why;
  expect_kept(GetParam(), Device::emulated, 10);
}

INSTANTIATE_TEST_SUITE_P(Scenes, DeviceMatrix, testing::ValuesIn(gallery()),
                         [](const auto& scene) { return test_name(scene.param.name); });

TEST(DeviceMatrixOnACard, NoPixelIsOver) {
  if (const std::string missing = missing_card(); !missing.empty()) GTEST_SKIP() << missing;
  for (const GalleryEntry& entry : gallery()) {
    SCOPED_TRACE(entry.name);
    if (entry.why_missing().empty()) expect_kept(entry, Device::cuda, 16);
  }
}

}  // namespace
}  // namespace pellucid::scenes::test_device_matrix
