// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "pellucid/scene/error.h"
#include "tests/cuda/card.h"
#include "tests/scenes/test_names.h"
#include "tests/scenes/tolerance_matrix.h"

/// The scenes of the tolerance matrix by the functions of a card: no pixel is over what it says.
namespace pellucid::scenes::test_device_matrix {

namespace {

/// Returns whether the rays of a scene are left to the CPU, which says so.
bool goes_to_cpu(const RenderReport& report) {
  return report.device.starts_with("rendered by the CPU: ");
}

/// Whether a device is to follow the rays of a scene: as the documents say.
bool is_for_devices(const Scene& scene) {
  if (scene.layers.size() != 1 || !scene.clips.empty()) return false;
  const Layer& layer = scene.layers[0];
  const auto* const volume = std::get_if<VolumeContent>(&layer.content);
  if (!layer.visible || !layer.clips.empty() || layer.projection || has_surfaces(layer)) {
    return false;
  }
  if (volume != nullptr) return volume->mask == nullptr;
  return !std::holds_alternative<LabelContent>(layer.content) && !is_lit(layer) && !scene.backdrop;
}

bool is_missing(const GalleryEntry& entry) {
  return !entry.file.empty() && !std::filesystem::exists(entry.file);
}

void expect_kept(const GalleryEntry& entry, Device device, int size) {
  MatrixOptions options;
  options.tolerances.assign(std::begin(quick_tolerances), std::end(quick_tolerances));
  options.size = size;
  options.sampling = false;
  options.least_proved = entry.least_proved;
  options.device = device;
  const Exhibit exhibit = entry.make(options.size);
  std::uint64_t pixels = 0, in_double = 0, left = 0;
  for (std::size_t camera = 0; camera < exhibit.cameras.size(); ++camera) {
    const Scene scene = scene_of(exhibit, camera, options.size);
    if (!is_for_devices(scene)) {
      // The CPU's own matrix has these.
      RenderOptions one;
      one.device = device;
      RenderReport report;
      render(scene, one, &report);
      EXPECT_TRUE(goes_to_cpu(report)) << report.device;
      return;
    }
    const MatrixRow row = measure_row(entry.name, exhibit, camera, options);
    EXPECT_GT(row.brightest, 0) << row.camera << ": there is nothing to see";
    for (const MatrixCell& cell : row.cells) {
      const Verdict& verdict = cell.verdict;
      const std::string where = row.camera + ", " + grade_name(cell.grade) + ", tolerance " +
                                std::to_string(cell.tolerance) + ": " + verdict.text();
      EXPECT_FALSE(goes_to_cpu(cell.report)) << where << cell.report.device;
      EXPECT_TRUE(verdict.kept()) << where;
      const bool may_give_up = cell.grade == Grade::proved && entry.least_proved > 0;
      if (cell.tolerance >= entry.least_tolerance && !may_give_up) {
        EXPECT_EQ(verdict.said_over, 0) << where;
      }
      EXPECT_EQ(cell.report.pixels_over_tolerance, static_cast<std::uint64_t>(verdict.said_over))
          << where;
      EXPECT_EQ(cell.report.pixels_proved, static_cast<std::uint64_t>(verdict.proved)) << where;
      EXPECT_FLOAT_EQ(static_cast<float>(cell.report.largest_error),
                      static_cast<float>(verdict.reported))
          << where;
      pixels += row.pixels;
      in_double += cell.report.pixels_in_double;
      left += cell.report.pixels_left;
    }
  }
  std::printf("[ device   ] %-50s %llu pixels: %llu again in double, %llu left to the CPU\n",
              entry.name.c_str(), static_cast<unsigned long long>(pixels),
              static_cast<unsigned long long>(in_double), static_cast<unsigned long long>(left));
}

class DeviceMatrix : public testing::TestWithParam<GalleryEntry> {};

TEST_P(DeviceMatrix, NoPixelIsOverOnTheCpu) {
  if (is_missing(GetParam())) GTEST_SKIP() << GetParam().file.string() << " not found";
  expect_kept(GetParam(), Device::emulated, 10);
}

INSTANTIATE_TEST_SUITE_P(Scenes, DeviceMatrix, testing::ValuesIn(gallery()),
                         [](const auto& scene) { return test_name(scene.param.name); });

TEST(DeviceMatrixOnACard, NoPixelIsOver) {
  if (const std::string missing = missing_card(); !missing.empty()) GTEST_SKIP() << missing;
  for (const GalleryEntry& entry : gallery()) {
    SCOPED_TRACE(entry.name);
    if (!is_missing(entry)) expect_kept(entry, Device::cuda, 16);
  }
}

}  // namespace
}  // namespace pellucid::scenes::test_device_matrix
