// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/scenes/scene_hash.h"
#include "tests/scenes/test_names.h"
#include "tests/scenes/tolerance_matrix.h"

/// A small part of the matrix that scripts/matrix runs in full: every scene, from the camera whose
/// reference frame is kept (reference_truth.h); from all three cameras if PELLUCID_TEST_CAMERAS is
/// "all", against references made anew.
namespace pellucid::scenes {

namespace {

class ToleranceMatrix : public testing::TestWithParam<GalleryEntry> {};

void expect_kept(const MatrixRow& row, double min_tolerance, double least_proved) {
  EXPECT_GT(row.brightest, 0) << row.camera << ": there is nothing to see, so nothing is tested";
  for (const MatrixCell& cell : row.cells) {
    const Verdict& verdict = cell.verdict;
    const std::string where = row.scene + ", " + row.camera + ", " + grade_name(cell.grade);
    std::printf("[ accuracy ] %-64s %.1e: found %.1e, reported %.1e, evaluations per ray %.1f\n",
                where.c_str(), cell.tolerance, verdict.found, verdict.reported,
                cell.evaluations_per_ray());
    EXPECT_TRUE(verdict.kept()) << where << ", tolerance " << cell.tolerance << ": "
                                << verdict.text();
    // Where proofs are of the first order, a ray may give up.
    const bool may_give_up = cell.grade == Grade::proved && least_proved > 0;
    if (cell.tolerance >= min_tolerance && !may_give_up) {
      EXPECT_EQ(verdict.said_over, 0)
          << where << ", tolerance " << cell.tolerance << ": " << verdict.text();
    }
    if (cell.grade == Grade::proved) {
      EXPECT_EQ(verdict.proved, static_cast<int>(row.pixels)) << where;
    }
    EXPECT_EQ(cell.report.pixels_over_tolerance, static_cast<std::uint64_t>(verdict.said_over))
        << where;
    EXPECT_EQ(cell.report.pixels_proved, static_cast<std::uint64_t>(verdict.proved)) << where;
    EXPECT_FLOAT_EQ(static_cast<float>(cell.report.largest_error),
                    static_cast<float>(verdict.reported))
        << where;
  }
}

bool all_cameras() {
  const char* const cameras = std::getenv("PELLUCID_TEST_CAMERAS");
  return cameras != nullptr && std::strcmp(cameras, "all") == 0;
}

/// The reference gives the kept frame again: some of its pixels, others in each scene.
void expect_is_given_again(const ReferenceFrame& kept, const Scene& scene) {
  std::vector<std::size_t> places;
  for (std::size_t n = 0; n < 8; ++n) {
    places.push_back((scene_hash(scene) % 256 + n * 37) % kept.pixels.size());
  }
  const std::vector<std::array<double, 4>> pixels = reference_pixels(scene, places);
  for (std::size_t n = 0; n < places.size(); ++n) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double before = kept.pixels[places[n]][c], now = pixels[n][c];
      if (std::isnan(before) && std::isnan(now)) continue;
      EXPECT_NEAR(before, now, reference_accuracy * std::max(1.0, std::fabs(now)))
          << "pixel " << places[n] << ", channel " << c << " of tests/scenes/truth.rgba64f";
    }
  }
}

TEST_P(ToleranceMatrix, NoPixelIsOver) {
  const GalleryEntry& entry = GetParam();
  if (const std::string why = entry.why_missing(); !why.empty()) GTEST_SKIP() << why;
  MatrixOptions options;
  options.tolerances.assign(std::begin(quick_tolerances), std::end(quick_tolerances));
  options.size = truth_size;
  options.sampling = false;
  options.least_proved = entry.least_proved;
  const Exhibit exhibit = entry.make(options.size);
  ASSERT_EQ(exhibit.cameras.size(), 3u);
  if (all_cameras()) {
    for (std::size_t camera = 0; camera < 3; ++camera) {
      expect_kept(measure_row(entry.name, exhibit, camera, options), entry.min_tolerance,
                  entry.least_proved);
    }
    return;
  }
  static const ReferenceTruth truth(truth_file());
  options.truth = &truth;
  const std::size_t camera = camera_in_turn(entry.name, exhibit.cameras.size());
  const Scene scene = scene_of(exhibit, camera, options.size);
  if (const ReferenceFrame* const kept = truth.find(scene)) {
    expect_is_given_again(*kept, scene);
  } else {
    std::printf("[ truth    ] %s: not in the file, so made anew\n", entry.name.c_str());
  }
  expect_kept(measure_row(entry.name, exhibit, camera, options), entry.min_tolerance,
              entry.least_proved);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ToleranceMatrix, testing::ValuesIn(gallery()),
                         [](const auto& scene) { return test_name(scene.param.name); });

}  // namespace
}  // namespace pellucid::scenes
