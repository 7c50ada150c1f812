// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "pellucid/field/sample.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/build_block_bends.h"
#include "tests/support/accuracy.h"

namespace pellucid {
namespace {

/// A grid of 19 x 12 x 26 values with its blocks, uniform, cell-centred or rectilinear.
template <class Value>
struct BlockedGrid {
  std::vector<Value> data;
  std::vector<double> plane[3], block_plane[3];
  GridAxis<double> axis[3];
  std::vector<BlockRange> range;
  std::vector<BlockBends> bends;
  BlockRanges blocks;
  static constexpr int size[3] = {19, 12, 26};

  template <class Field>
  BlockedGrid(int padding, bool rectilinear, Field&& field) {
    for (int k = 0; k < size[2]; ++k) {
      for (int j = 0; j < size[1]; ++j) {
        for (int i = 0; i < size[0]; ++i) data.push_back(static_cast<Value>(field(i, j, k)));
      }
    }
    int count = 1;
    for (int a = 0; a < 3; ++a) {
      axis[a] = {nullptr, size[a], padding};
      if (rectilinear) {
        double x = -3;
        for (int i = 0; i <= axis[a].cells(); ++i) {
          plane[a].push_back(x);
          x += 0.5 + 0.3 * std::sin(i + a);
        }
        axis[a].plane_position = plane[a].data();
      }
      block_plane[a].resize(static_cast<std::size_t>(block_count(axis[a])) + 1);
      find_block_planes(axis[a], block_plane[a].data());
      blocks.axis[a] = {block_plane[a].data(), block_count(axis[a]) + 1, 0};
      count *= block_count(axis[a]);
      double least = 1e9;
      for (int i = 0; i < axis[a].cells(); ++i) {
        least = std::min(least, axis[a].plane(i + 1) - axis[a].plane(i));
      }
      blocks.least_width[a] = least;
    }
    range.resize(static_cast<std::size_t>(count));
    bends.resize(static_cast<std::size_t>(count));
    build_block_ranges(view(), blocks.axis, 0, count, range.data());
    build_block_bends(view(), blocks.axis, 0, count, bends.data());
    blocks.range = range.data();
    blocks.bends = bends.data();
  }
  StructuredGrid<Value, double> view() const { return {data.data(), {axis[0], axis[1], axis[2]}}; }
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
  const auto view = grid.view();
  test::ErrorRecord ratio(std::string("distance from the chord / bound, ") + name, "");
  for (int n = 0; n < 3000; ++n) {
    Vec3<double> from, to;
    for (int a = 0; a < 3; ++a) {
      const double begin = grid.axis[a].plane(0), end = grid.axis[a].plane(grid.axis[a].cells());
      from[a] = begin + (end - begin) * unit(random);
      to[a] = begin + (end - begin) * unit(random);
      if (unit(random) < 0.2) to[a] = from[a];
    }
    const Vec3<double> way = to - from;
    if (!(dot(way, way) > 1e-6)) continue;
    const Ray<double> ray{from, way * (1 / std::sqrt(dot(way, way)))};
    const double length = std::sqrt(dot(way, way)) * std::pow(unit(random), 3);
    if (!(length > 1e-3)) continue;
    BlockBends bends{};
    bool first = true;
    for_each_block(grid.blocks, ray, {0, length}, [&](const BlockStep& step) {
      bends = first ? grid.blocks.bends[step.block] : join(bends, grid.blocks.bends[step.block]);
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

TEST(BlockBends, NoChordIsLeftByMoreThanTheBound) {
  expect_chords_within<std::uint8_t>(0, false, "u8");
  expect_chords_within<std::int16_t>(1, false, "i16, cell-centred");
  expect_chords_within<float>(0, false, "f32");
  expect_chords_within<double>(0, true, "f64, rectilinear");
  expect_chords_within<std::int32_t>(1, true, "i32, rectilinear, cell-centred");
}

TEST(BlockBends, OfAHatIsTheJumpOfItsSlopes) {
  // Height 10 in plane x = 8, which two blocks share: it is the upper face of the first.
  const BlockedGrid<float> hat(0, false, [](int x, int, int) { return x == 8 ? 10 : 0; });
  EXPECT_NEAR(hat.bends[0].bend[0], 20, 1e-5);
  EXPECT_NEAR(hat.bends[0].bend[1], 0, 1e-12);
  EXPECT_NEAR(hat.bends[0].twist[0], 0, 1e-12);
  // The second block sees the kink at x = 9.
  EXPECT_NEAR(hat.bends[1].bend[0], 10, 1e-5);
  const BlockedGrid<std::uint8_t> saddle(0, false, [](int x, int y, int) { return x * y; });
  EXPECT_EQ(saddle.bends[0].twist[2], 1);
  EXPECT_EQ(saddle.bends[0].bend[0], 0);
}

TEST(BlockBends, VacuumIsUnboundedAndItsNeighbourKeepsItsBound) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const BlockedGrid<float> grid(0, false, [&](int x, int, int) {
    return x == 9 ? nan : x == 7 ? 10.0f : 0.0f;
  });
  EXPECT_GE(grid.bends[0].bend[0], 20);
  EXPECT_TRUE(std::isinf(grid.bends[1].bend[0]));
}

}  // namespace
}  // namespace pellucid
