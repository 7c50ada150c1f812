// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <tuple>

#include "walk_check.h"

namespace pellucid::test_structured_walk {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double denormal = std::numeric_limits<double>::denorm_min();

using Cell = std::array<int, 3>;

TestGrid<double> uniform(int cells) {
  TestGrid<double> grid;
  for (int a = 0; a < 3; ++a) grid.set_uniform(a, cells + 1, 0);
  return grid;
}

std::vector<Cell> cells(const TestGrid<double>& grid, const Ray<double>& ray) {
  std::vector<Cell> visited;
  const auto steps = walk(grid, ray);
  EXPECT_EQ(check_exact(grid, ray, {0, infinity}, steps), "") << text(ray);
  for (const auto& s : steps) visited.push_back({s.cell[0], s.cell[1], s.cell[2]});
  return visited;
}

TEST(StructuredWalk, StraightThrough) {
  const TestGrid<double> grid = uniform(3);
  for (const double zero : {0.0, -0.0}) {
    const auto steps = walk(grid, {{-2, 0.5, 1.25}, {1, zero, zero}});
    ASSERT_EQ(steps.size(), 3u);
    for (int i = 0; i < 3; ++i) {
      const auto& s = steps[static_cast<std::size_t>(i)];
      EXPECT_EQ((Cell{s.cell[0], s.cell[1], s.cell[2]}), (Cell{i, 0, 1}));
      EXPECT_EQ(s.t_begin, 2 + i);
      EXPECT_EQ(s.t_end, 3 + i);
      EXPECT_EQ(s.entry, (Vec3<double>{0, 0.5, 0.25}));
      EXPECT_EQ(s.exit, (Vec3<double>{1, 0.5, 0.25}));
    }
    EXPECT_EQ(cells(grid, {{5, 0.5, 1.25}, {-1, zero, zero}}),
              (std::vector<Cell>{{2, 0, 1}, {1, 0, 1}, {0, 0, 1}}));
  }
}

TEST(StructuredWalk, DiagonalsThroughVerticesVisitNoTouchedCell) {
  const TestGrid<double> grid = uniform(3);
  for (int octant = 0; octant < 8; ++octant) {
    const auto sign = [octant](int a) { return ((octant >> a) & 1) ? -1.0 : 1.0; };
    const auto start = [octant](int a) { return ((octant >> a) & 1) ? 5.0 : -2.0; };
    const auto steps = walk(grid, {{start(0), start(1), start(2)}, {sign(0), sign(1), sign(2)}});
    ASSERT_EQ(steps.size(), 3u) << octant;
    for (int i = 0; i < 3; ++i) {
      const auto& s = steps[static_cast<std::size_t>(i)];
      EXPECT_EQ(s.t_begin, 2 + i);
      EXPECT_EQ(s.t_end, 3 + i);
      for (int a = 0; a < 3; ++a) {
        const bool down = sign(a) < 0;
        EXPECT_EQ(s.cell[a], down ? 2 - i : i);
        EXPECT_EQ(s.entry[a], down ? 1 : 0);
        EXPECT_EQ(s.exit[a], down ? 0 : 1);
      }
    }
  }
}

TEST(StructuredWalk, ThroughEdges) {
  const TestGrid<double> grid = uniform(3);
  EXPECT_EQ(cells(grid, {{-1, -1, 0.5}, {1, 1, 0}}),
            (std::vector<Cell>{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}));
  EXPECT_EQ(cells(grid, {{-1, 4, 0.5}, {1, -1, -0.0}}),
            (std::vector<Cell>{{0, 2, 0}, {1, 1, 0}, {2, 0, 0}}));
  // Touches the grid in an edge only, or in a vertex only.
  EXPECT_TRUE(cells(grid, {{-1, 1, 0.5}, {1, -1, 0}}).empty());
  EXPECT_TRUE(cells(grid, {{-1, 1, 1}, {1, -1, -1}}).empty());
  // Two planes at once, the third later.
  EXPECT_EQ(cells(grid, {{0.5, 0.5, 0.25}, {1, 1, 1}}),
            (std::vector<Cell>{{0, 0, 0}, {1, 1, 0}, {1, 1, 1}, {2, 2, 1}, {2, 2, 2}}));
}

TEST(StructuredWalk, InFacesBetweenCells) {
  const TestGrid<double> grid = uniform(3);
  for (const double zero : {0.0, -0.0}) {
    // The upper cell, but the last plane belongs to the last cell.
    EXPECT_EQ(cells(grid, {{-1, 1, 0.5}, {1, zero, zero}}),
              (std::vector<Cell>{{0, 1, 0}, {1, 1, 0}, {2, 1, 0}}));
    EXPECT_EQ(cells(grid, {{-1, 0, 2}, {1, zero, zero}}),
              (std::vector<Cell>{{0, 0, 2}, {1, 0, 2}, {2, 0, 2}}));
    EXPECT_EQ(cells(grid, {{4, 3, 3}, {-1, zero, zero}}),
              (std::vector<Cell>{{2, 2, 2}, {1, 2, 2}, {0, 2, 2}}));
    EXPECT_EQ(walk(grid, {{4, 3, 1}, {-1, zero, zero}})[0].entry, (Vec3<double>{1, 1, 0}));
    EXPECT_TRUE(cells(grid, {{-1, std::nextafter(3.0, 4.0), 1}, {1, zero, zero}}).empty());
    EXPECT_TRUE(cells(grid, {{-1, -denormal, 1}, {1, zero, zero}}).empty());
  }
}

TEST(StructuredWalk, OriginOnPlanesAndVertices) {
  const TestGrid<double> grid = uniform(3);
  EXPECT_EQ(cells(grid, {{1, 0.5, 0.5}, {1, 0, 0}}), (std::vector<Cell>{{1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(cells(grid, {{1, 0.5, 0.5}, {-1, 0, 0}}), (std::vector<Cell>{{0, 0, 0}}));
  EXPECT_EQ(cells(grid, {{1, 2, 1}, {1, -1, 1}}), (std::vector<Cell>{{1, 1, 1}, {2, 0, 2}}));
  EXPECT_EQ(cells(grid, {{0, 0, 0}, {1, 1, 1}}),
            (std::vector<Cell>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}));
  EXPECT_TRUE(cells(grid, {{3, 1, 1}, {1, 0, 0}}).empty());
  EXPECT_TRUE(cells(grid, {{0, 0, 0}, {-1, -1, -1}}).empty());
  EXPECT_EQ(cells(grid, {{3, 3, 3}, {-1, 0, 0}}),
            (std::vector<Cell>{{2, 2, 2}, {1, 2, 2}, {0, 2, 2}}));
}

TEST(StructuredWalk, OriginInsideStartsAtZero) {
  const TestGrid<double> grid = uniform(4);
  const Ray<double> ray{{1.25, 2.5, 0.75}, {1, 2, -0.25}};
  const auto steps = walk(grid, ray);
  ASSERT_FALSE(steps.empty());
  EXPECT_EQ(steps.front().t_begin, 0);
  EXPECT_EQ(steps.front().entry, (Vec3<double>{0.25, 0.5, 0.75}));
  EXPECT_EQ(check_exact(grid, ray, {0, infinity}, steps), "");
  EXPECT_EQ(check_brute_force(grid, ray, {0, infinity}, steps), "");
}

TEST(StructuredWalk, BehindTheOriginIsNothing) {
  const TestGrid<double> grid = uniform(3);
  EXPECT_TRUE(cells(grid, {{4, 1.5, 1.5}, {1, 0, 0}}).empty());
  EXPECT_TRUE(cells(grid, {{-1, -1, -1}, {-1, -1, -1}}).empty());
}

TEST(StructuredWalk, SingleCell) {
  const TestGrid<double> grid = uniform(1);
  const auto steps = walk(grid, {{-1, 0.25, 0.5}, {1, 0.25, -0.0}});
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].t_begin, 1);
  EXPECT_EQ(steps[0].t_end, 2);
  EXPECT_EQ(steps[0].entry, (Vec3<double>{0, 0.5, 0.5}));
  EXPECT_EQ(steps[0].exit, (Vec3<double>{1, 0.75, 0.5}));
}

TEST(StructuredWalk, CellCentredHalfCells) {
  TestGrid<double> grid;
  for (int a = 0; a < 3; ++a) grid.set_uniform(a, 2, 1);  // planes -½, 0, 1, 1½
  const auto steps = walk(grid, {{-1, 0.5, -0.25}, {1, 0, 0}});
  ASSERT_EQ(steps.size(), 3u);
  const double t[] = {0.5, 1, 2, 2.5};
  for (int i = 0; i < 3; ++i) {
    const auto& s = steps[static_cast<std::size_t>(i)];
    EXPECT_EQ((Cell{s.cell[0], s.cell[1], s.cell[2]}), (Cell{i, 1, 0}));
    EXPECT_EQ(s.t_begin, t[i]);
    EXPECT_EQ(s.t_end, t[i + 1]);
    EXPECT_EQ(s.entry, (Vec3<double>{0, 0.5, 0.5}));
    EXPECT_EQ(s.exit, (Vec3<double>{1, 0.5, 0.5}));
  }
  // A single value: two half cells along each axis.
  for (int a = 0; a < 3; ++a) grid.set_uniform(a, 1, 1);
  EXPECT_EQ(cells(grid, {{-1, -0.25, -1}, {1, 0, 1}}), (std::vector<Cell>{{0, 0, 0}, {1, 0, 1}}));
}

TEST(StructuredWalk, RectilinearPlanes) {
  TestGrid<double> grid;
  grid.set_planes(0, {-3, -2.5, 0, 0.125, 7}, 0);
  grid.set_planes(1, {10, 20}, 0);
  grid.set_uniform(2, 2, 0);
  const auto steps = walk(grid, {{8, 12.5, 0.5}, {-1, 0, 0}});
  ASSERT_EQ(steps.size(), 4u);
  const double t[] = {1, 7.875, 8, 10.5, 11};
  for (int i = 0; i < 4; ++i) {
    const auto& s = steps[static_cast<std::size_t>(i)];
    EXPECT_EQ(s.cell[0], 3 - i);
    EXPECT_EQ(s.t_begin, t[i]);
    EXPECT_EQ(s.t_end, t[i + 1]);
    EXPECT_EQ(s.entry.y, 0.25);
  }
}

TEST(StructuredWalk, DenormalDirectionsAreAlmostParallel) {
  const TestGrid<double> grid = uniform(3);
  for (const double tiny : {denormal, 1e-310, 1e-300}) {
    const std::vector<Cell> straight{{0, 1, 1}, {1, 1, 1}, {2, 1, 1}};
    EXPECT_EQ(cells(grid, {{-1, 1.5, 1.5}, {1, tiny, -tiny}}), straight);
    // From a plane, the smallest slope decides for the cell it moves into.
    EXPECT_EQ(cells(grid, {{-1, 1, 1.5}, {1, tiny, 0}}), straight);
    EXPECT_EQ(cells(grid, {{-1, 2, 1.5}, {1, -tiny, 0}}), straight);
    EXPECT_TRUE(cells(grid, {{-1, 3, 1.5}, {1, tiny, 0}}).empty());
    EXPECT_EQ(cells(grid, {{-1, 3, 1.5}, {1, -tiny, 0}}),
              (std::vector<Cell>{{0, 2, 1}, {1, 2, 1}, {2, 2, 1}}));
  }
}

TEST(StructuredWalk, RaysWithoutEndOrSenseMeetNothing) {
  const TestGrid<double> grid = uniform(3);
  EXPECT_TRUE(walk(grid, {{1.5, 1.5, 1.5}, {0, -0.0, 0}}).empty());
  EXPECT_TRUE(walk(grid, {{1.5, 1.5, 1.5}, {denormal, 0, 0}}).empty());
  EXPECT_TRUE(walk(grid, {{-1, 1.5, 1.5}, {denormal, 0, 0}}).empty());
  for (int a = 0; a < 3; ++a) {
    for (const double bad : {nan, infinity, -infinity}) {
      Ray<double> ray{{-1, -1, -1}, {1, 1, 1}};
      ray.origin[a] = bad;
      EXPECT_TRUE(walk(grid, ray).empty());
    }
    Ray<double> ray{{-1, -1, -1}, {1, 1, 1}};
    ray.direction[a] = nan;
    EXPECT_TRUE(walk(grid, ray).empty());
  }
}

TEST(StructuredWalk, HitsAndRemaining) {
  const TestGrid<double> grid = uniform(2);
  const Ray<double> ray{{-1, 0.5, 0.5}, {1, 0, 0}};
  StructuredWalk<double> w(grid.axis, ray, {0, infinity});
  StructuredWalk<double>::Step step;
  EXPECT_TRUE(w.hits());
  EXPECT_EQ(w.remaining().begin, 1);
  EXPECT_EQ(w.remaining().end, 3);
  EXPECT_TRUE(w.next(step));
  EXPECT_EQ(w.remaining().begin, 2);
  EXPECT_TRUE(w.next(step));
  EXPECT_FALSE(w.hits());
  EXPECT_FALSE(w.next(step));
  EXPECT_FALSE(w.next(step));
  EXPECT_FALSE(
      (StructuredWalk<double>(grid.axis, {{-1, 5, 0.5}, {1, 0, 0}}, {0, infinity}).hits()));
}

TEST(StructuredWalk, RangeCutsTheRay) {
  const TestGrid<double> grid = uniform(3);
  const Ray<double> ray{{-1, 0.5, 0.5}, {1, 0, 0}};
  const auto steps = walk(grid, ray, {1.25, 2.5});
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].t_begin, 1.25);
  EXPECT_EQ(steps[0].entry.x, 0.25);
  EXPECT_EQ(steps[0].exit.x, 1);
  EXPECT_EQ(steps[1].t_end, 2.5);
  EXPECT_EQ(steps[1].exit.x, 0.5);
  EXPECT_TRUE(walk(grid, ray, {4, 9}).empty());
  EXPECT_TRUE(walk(grid, ray, {2, 2}).empty());
  EXPECT_TRUE(walk(grid, ray, {3, 2}).empty());
  // A cut on a plane: the cells before and behind it, none twice.
  EXPECT_EQ(walk(grid, ray, {0, 2}).size(), 1u);
  EXPECT_EQ(walk(grid, ray, {2, 9}).size(), 2u);
  EXPECT_EQ(walk(grid, ray, {2, 9})[0].entry.x, 0);
}

}  // namespace
}  // namespace pellucid::test_structured_walk
