// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/scenes/test_names.h"
#include "tests/scenes/tolerance_matrix.h"

/// A small part of the matrix that scripts/matrix runs in full: every scene, from one of its
/// cameras in turn.
namespace pellucid::scenes {

namespace {

class ToleranceMatrix : public testing::TestWithParam<GalleryEntry> {};

void expect_kept(const MatrixRow& row, double least_tolerance, double least_proved) {
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
    if (cell.tolerance >= least_tolerance && !may_give_up) {
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

TEST_P(ToleranceMatrix, NoPixelIsOver) {
  const GalleryEntry& entry = GetParam();
  if (!entry.file.empty() && !std::filesystem::exists(entry.file)) {
    GTEST_SKIP() << entry.file.string() << " not found";
  }
  MatrixOptions options;
  options.tolerances.assign(std::begin(quick_tolerances), std::end(quick_tolerances));
  options.size = 16;
  options.sampling = false;
  options.least_proved = entry.least_proved;
  const Exhibit exhibit = entry.make(options.size);
  ASSERT_EQ(exhibit.cameras.size(), 3u);
  for (std::size_t camera = 0; camera < 3; ++camera) {
    expect_kept(measure_row(entry.name, exhibit, camera, options), entry.least_tolerance,
                entry.least_proved);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ToleranceMatrix, testing::ValuesIn(gallery()),
                         [](const auto& scene) { return test_name(scene.param.name); });

}  // namespace
}  // namespace pellucid::scenes
