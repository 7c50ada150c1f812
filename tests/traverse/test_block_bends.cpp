// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "block_field.h"
#include "pellucid/field/sample.h"
#include "pellucid/traverse/block_walk.h"
#include "tests/support/accuracy.h"

namespace pellucid::test_block_bends {
namespace {

/// A grid of 19 x 12 x 26 values with its blocks, uniform, cell-centred or rectilinear.
template <class Value>
struct BlockedGrid : BlockField<Value> {
  template <class Field>
  BlockedGrid(int padding, bool rectilinear, Field&& field) {
    constexpr int size[3] = {19, 12, 26};
    for (int a = 0; a < 3; ++a) {
      std::vector<double> places;
      double x = -3;
      for (int i = 0; rectilinear && i < size[a] + 2 * padding; ++i) {
        places.push_back(x);
        x += 0.5 + 0.3 * std::sin(i + a);
      }
      this->set_axis(a, size[a], padding, places);
    }
    this->fill(field);
    this->build();
  }
};

/// Along random rays, on stretches of one block or of several: no data leaves its chord by more
/// than the bound, anywhere.
template <class Value>
void expect_chords_within(int padding, bool rectilinear, const char* name) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  const double k = 1.3;
  const BlockedGrid<Value> grid(padding, rectilinear, [&](int x, int y, int z) {
    return 100 + 60 * std::sin(0.4 * x + 0.1 * y) * std::cos(k * z) + 30 * unit(random) * (x > 9);
  });
  const auto& view = grid.grid;
  test::ErrorRecord ratio(std::string("distance from the chord / bound, ") + name, "");
  for (int n = 0; n < 3000; ++n) {
    Vec3<double> from, to;
    for (int a = 0; a < 3; ++a) {
      const double begin = grid.grid.axis[a].plane(0),
                   end = grid.grid.axis[a].plane(grid.grid.axis[a].cells());
      from[a] = begin + (end - begin) * unit(random);
      to[a] = begin + (end - begin) * unit(random);
      if (unit(random) < 0.2) to[a] = from[a];
    }
    const Vec3<double> way = to - from;
    if (!(dot(way, way) > 1e-6)) continue;
    const Ray<double> ray{from, way * (1 / std::sqrt(dot(way, way)))};
    const double length = std::sqrt(dot(way, way)) * std::pow(unit(random), 3);
    if (!(length > 1e-3)) continue;
    CurvatureBounds bends{};
    bool first = true;
    for_each_block(grid.blocks, ray, {0, length}, [&](const BlockStep& step) {
      bends = first ? grid.blocks.curvature(step.block)
                    : join(bends, grid.blocks.curvature(step.block));
      first = false;
      return true;
    });
    const double bound = bend_deviation(
        derivative_variation(bends, ray.direction, grid.blocks.least_width, length), length);
    const double f0 = sample_value<double>(view, ray.at(0)),
                 f1 = sample_value<double>(view, ray.at(length));
    double farthest = 0;
    for (int i = 1; i < 64; ++i) {
      const double s = i / 64.0;
      const double f = sample_value<double>(view, ray.at(s * length));
      farthest = std::max(farthest, std::fabs(f - (f0 + s * (f1 - f0))));
    }
    ratio.add(std::max(farthest - 1e-10, 0.0) / (bound + 1e-300), "stretch " + std::to_string(n));
  }
  ratio.print();
  EXPECT_LE(ratio.largest(), 1);
  EXPECT_GT(ratio.largest(), 0.2L);
}

TEST(CurvatureBounds, NoChordIsLeftByMoreThanTheBound) {
  expect_chords_within<std::uint8_t>(0, false, "u8");
  expect_chords_within<std::int16_t>(1, false, "i16, cell-centred");
  expect_chords_within<float>(0, false, "f32");
  expect_chords_within<double>(0, true, "f64, rectilinear");
  expect_chords_within<std::int32_t>(1, true, "i32, rectilinear, cell-centred");
}

TEST(CurvatureBounds, OfAHatIsTheJumpOfItsSlopes) {
  // Height 10 in plane x = 8, which two blocks share: it is the upper face of the first.
  const BlockedGrid<float> hat(0, false, [](int x, int, int) { return x == 8 ? 10 : 0; });
  const auto expect_near = [](float bound, float truth) {  // one of 128 steps
    EXPECT_GE(bound, truth);
    EXPECT_LE(bound, truth * (1 + 1 / 128.0f));
  };
  expect_near(hat.blocks.curvature(0).second_difference[0], 20);
  EXPECT_NEAR(hat.blocks.curvature(0).second_difference[1], 0, 1e-12);
  EXPECT_NEAR(hat.blocks.curvature(0).twist[0], 0, 1e-12);
  // The second block sees the kink at x = 9.
  expect_near(hat.blocks.curvature(1).second_difference[0], 10);
  const BlockedGrid<std::uint8_t> saddle(0, false, [](int x, int y, int) { return x * y; });
  EXPECT_EQ(saddle.blocks.curvature(0).twist[2], 1);
  EXPECT_EQ(saddle.blocks.curvature(0).second_difference[0], 0);
}

TEST(CurvatureBounds, VacuumIsUnboundedAndItsNeighbourKeepsItsBound) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const BlockedGrid<float> grid(0, false, [&](int x, int, int) {
    return x == 9 ? nan : x == 7 ? 10.0f : 0.0f;
  });
  EXPECT_GE(grid.blocks.curvature(0).second_difference[0], 20);
  EXPECT_TRUE(std::isinf(grid.blocks.curvature(1).second_difference[0]));
}

}  // namespace
}  // namespace pellucid::test_block_bends
