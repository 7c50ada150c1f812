// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "pellucid/cpu/render.h"
#include "tests/packet/instruction_sets.h"
#include "tests/support/instruction_sets.h"

namespace pellucid {

/// What was seen over many frames.
struct Seen {
  int frames = 0, with_strides = 0;
  std::size_t pixels = 0, over = 0;  ///< compared, and over their tolerance as they say
  std::size_t between = 0;           ///< that were interpolated
  double largest_of_error = 0;
};

/// What pixels may say of themselves.
enum class Promise {
  within_tolerance,
  honest  ///< that they are over it, too; and the judge need not know all of them
};

/// The scene in packets against rays one by one in binary64, proved.
inline void compare(Scene scene, const std::vector<double>& tolerances, Seen& seen,
                    Promise promise = Promise::within_tolerance, RenderOptions options = {}) {
  constexpr double judge_tolerance = 1e-6;
  options.machine.threads = 1;
  options.outputs.error = true;
  options.machine.instruction_set = InstructionSet::scalar;
  scene.integration.tolerance = judge_tolerance;
  scene.integration.precision = Precision::float64;
  scene.integration.grade = Grade::proved;
  const Image truth = render(scene, options).image;
  scene.integration.precision = Precision::automatic;
  for (const InstructionSet set : packet_sets) {
    if (!test::runs_here(set)) continue;
    options.machine.instruction_set = set;
    for (const double tolerance : tolerances) {
      SCOPED_TRACE(testing::Message() << name_of(set) << " at " << tolerance);
      scene.integration.tolerance = tolerance;
      scene.integration.grade = Grade::estimated;
      const auto [image, report] = render(scene, options);
      ++seen.frames;
      if (report.spans.strides > 0) ++seen.with_strides;
      seen.between += report.pixels_interpolated;
      for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto said = static_cast<double>(image.error[i]);
        if (promise == Promise::within_tolerance) {
          ASSERT_LE(double{truth.error[i]}, 1e-5) << "the judge does not know pixel " << i;
          ASSERT_LE(said, tolerance * (1 + 1e-6)) << "pixel " << i;
        } else if (!(double{truth.error[i]} <= 1e-5)) {
          continue;
        }
        ++seen.pixels;
        if (!(said <= tolerance * (1 + 1e-6))) ++seen.over;
        for (std::size_t c = 0; c < 4; ++c) {
          const double off = std::fabs(static_cast<double>(image.pixels[i][c]) -
                                       static_cast<double>(truth.pixels[i][c]));
          ASSERT_LE(off, said + std::max(1.3 * judge_tolerance, double{truth.error[i]}))
              << "pixel " << i << ", channel " << c;
          if (said > 30 * judge_tolerance) {
            seen.largest_of_error = std::max(seen.largest_of_error, off / said);
          }
        }
      }
    }
  }
}

/// Many scenes, of which make(seed) gives one each. PELLUCID_TEST_SCENES sets how many there are,
/// PELLUCID_TEST_SEED where they begin.
template <class Make>
Seen compare_random_scenes(int count, const std::vector<double>& tolerances, const Make& make,
                           Promise promise = Promise::within_tolerance,
                           const RenderOptions& options = {}) {
  const char* const wanted = std::getenv("PELLUCID_TEST_SCENES");
  const char* const seed = std::getenv("PELLUCID_TEST_SEED");
  if (wanted != nullptr) count = std::atoi(wanted);
  const unsigned first = seed != nullptr ? static_cast<unsigned>(std::atoi(seed)) : 1;
  Seen seen;
  for (int n = 0; n < count; ++n) {
    const unsigned one = first + static_cast<unsigned>(n);
    SCOPED_TRACE(testing::Message() << "scene " << one);
    compare(make(one), tolerances, seen, promise, options);
    if (testing::Test::HasFatalFailure()) return seen;
  }
  testing::Test::RecordProperty("largest_error_of_said", std::to_string(seen.largest_of_error));
  if (wanted != nullptr) {
    std::printf(
        "%d frames, %d with strides; %zu pixels, %zu over, %zu between others; largest error %.3g "
        "of what is said\n",
        seen.frames, seen.with_strides, seen.pixels, seen.over, seen.between,
        seen.largest_of_error);
  }
  return seen;
}

/// Random scenes of all kinds, most of which come within their tolerance.
template <class Make>
void expect_honest_scenes(int count, const Make& make,
                          const std::vector<double>& tolerances = {1e-2, 1.0 / 512, 2e-4}) {
  const Seen seen = compare_random_scenes(count, tolerances, make, Promise::honest);
  EXPECT_GT(seen.pixels, 6000U * static_cast<unsigned>(set_count()));
  EXPECT_LT(seen.over, seen.pixels / 100);
}

}  // namespace pellucid
