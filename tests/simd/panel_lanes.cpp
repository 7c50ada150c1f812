// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <random>
#include <vector>

#include "tests/simd/every_instruction_set.h"
#include "tests/simd/panels.h"

/// Panels of Gaussians in lanes: what one number at a time gives, within the errors of both.
namespace pellucid::test {
namespace {

class PanelLanes : public EveryInstructionSet {
 protected:
  static const simd_panels::Panels& panels() {
    return *choose(PELLUCID_ENTRIES(pellucid_simd_panels))();
  }
};

TEST_P(PanelLanes, AreThoseOfOnePanel) {
  std::mt19937_64 random(15);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  const auto lanes = static_cast<std::size_t>(panels().lanes);
  long count = 0, close = 0, cut = 0, other = 0, clear = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<double> primitives;
    for (int i = 0; i < 4; ++i) {
      const double size = std::pow(10.0, 2 * unit(random) - 0.5);
      for (int k = 0; k < 2; ++k) primitives.push_back(unit(random));
      for (int k = 0; k < 4; ++k) primitives.push_back(size * normal(random));
      primitives.push_back(std::pow(10.0, 3 * unit(random) - 2));
      for (int k = 0; k < 3; ++k) primitives.push_back(unit(random));
    }
    const double table[6] = {0.3, 0.3 + 0.4 * unit(random), 0.8, 0, unit(random), 0};
    const simd_panels::Task task{primitives.data(), 4, round % 3 == 0 ? table : nullptr,
                                 std::pow(10.0, -7 * unit(random)), round % 2 == 0};
    std::vector<double> in[10], out[simd_panels::outputs], one[simd_panels::outputs];
    for (std::size_t n = 0; n < lanes; ++n) {
      const double wide = std::pow(10.0, -2 * unit(random));
      for (std::size_t c = 0; c < 2; ++c) {
        const double a = unit(random), b = a + wide * normal(random);
        for (std::size_t k = 0; k < 4; ++k) {
          in[4 * c + k].push_back(a + static_cast<double>(k) * (b - a) / 3 +
                                  0.1 * wide * wide * normal(random));
        }
      }
      in[8].push_back(round % 5 == 0 && n == 1 ? 0 : std::pow(10.0, -2 * unit(random)));
      in[9].push_back(unit(random) < 0.3 ? 1 : 0);
    }
    const double* from[10];
    double *to[simd_panels::outputs], *to_one[simd_panels::outputs];
    for (int k = 0; k < 10; ++k) from[k] = in[k].data();
    for (int k = 0; k < simd_panels::outputs; ++k) {
      out[k].resize(lanes);
      one[k].resize(lanes);
      to[k] = out[k].data();
    }
    panels().run(task, from, to);
    for (std::size_t n = 0; n < lanes; ++n) {
      for (int k = 0; k < 10; ++k) from[k] = &in[k][n];
      for (int k = 0; k < simd_panels::outputs; ++k) to_one[k] = &one[k][n];
      panels().one(task, from, to_one);
      ++count;
      const auto apart = [&](simd_panels::Output k) { return std::fabs(out[k][n] - one[k][n]); };
      const double errors = out[simd_panels::error][n] + one[simd_panels::error][n];
      ASSERT_TRUE(std::isfinite(errors)) << round;
      ASSERT_LE(apart(simd_panels::optical_depth),
                1e-11 * (1 + one[simd_panels::optical_depth][n]));
      ASSERT_LE(apart(simd_panels::opacity), errors + 1e-12) << round;
      ASSERT_LE(apart(simd_panels::red), errors + 1e-12) << round;
      ASSERT_LE(apart(simd_panels::green), errors + 1e-12) << round;
      other += out[simd_panels::done][n] != one[simd_panels::done][n];
      cut += out[simd_panels::done][n] == 0;
      clear += out[simd_panels::opacity][n] == 0;
      close += apart(simd_panels::red) <= 1e-12 && apart(simd_panels::error) <= 1e-9 * errors &&
               apart(simd_panels::cut) <= 1e-9;
      if (in[8][n] == 0) {
        EXPECT_EQ(out[simd_panels::opacity][n], 0);
      }
    }
  }
  std::printf("[ lanes    ] %d lanes: %ld panels, %ld close, %ld cut, %ld done otherwise\n",
              panels().lanes, count, close, cut, other);
  // What is negligible goes by the number of terms that matter in any of the lanes.
  EXPECT_GT(close, count * 90 / 100);
  EXPECT_LE(other, count / 200);
  EXPECT_GT(cut, count / 20);
  EXPECT_LT(clear, count / 2);
}

PELLUCID_EVERY_INSTRUCTION_SET(PanelLanes);

}  // namespace
}  // namespace pellucid::test
