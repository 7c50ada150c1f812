// SPDX-License-Identifier: Apache-2.0
#include "pellucid/traverse/block_walk.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <iostream>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/traverse/build_block_records.h"
#include "walk_generator.h"

namespace pellucid::test_block_walk {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
using Step = StructuredWalk<double>::Step;

/// The blocks of a grid without data: the walk looks at the planes alone.
struct TestBlocks {
  std::vector<double> planes[3];
  BlockRecords view;

  explicit TestBlocks(const TestGrid<double>& grid) {
    for (int a = 0; a < 3; ++a) {
      planes[a].resize(static_cast<std::size_t>(block_count(grid.axis[a])) + 1);
      find_block_planes(grid.axis[a], planes[a].data());
      view.axis[a] = {planes[a].data(), static_cast<int>(planes[a].size()), 0};
    }
  }
};

std::vector<BlockStep> block_steps(const BlockRecords& blocks, const Ray<double>& ray,
                                   Interval<double> range = {0, infinity}) {
  std::vector<BlockStep> steps;
  for_each_block(blocks, ray, range, [&](const BlockStep& step) {
    steps.push_back(step);
    return steps.size() < 10000;
  });
  return steps;
}

bool same(const Step& p, const Step& q) {
  return p.cell[0] == q.cell[0] && p.cell[1] == q.cell[1] && p.cell[2] == q.cell[2] &&
         p.t_begin == q.t_begin && p.t_end == q.t_end && p.entry == q.entry && p.exit == q.exit;
}

/// The walks over the cells of one block after the other against the walk over the whole ray, to
/// the bit. Empty: they agree.
const char* check_blocks(const TestGrid<double>& grid, const BlockRecords& blocks,
                         const Ray<double>& ray, Interval<double> range, long& cells,
                         long& crossed) {
  const char* failure = "";
  StructuredWalk<double> whole(grid.axis, ray, range);
  double t = whole.remaining().begin;
  const double end = whole.remaining().end;
  const bool hits = whole.hits();
  Step expected, step;
  for_each_block(blocks, ray, range, [&](const BlockStep& block) {
    ++crossed;
    if (block.t_begin != t) failure = "a block does not begin where the last one ended";
    if (!(block.t_begin < block.t_end)) failure = "a block's interval is empty";
    t = block.t_end;
    StructuredWalk<double> inside(grid.axis, ray, {block.t_begin, block.t_end});
    if (inside.remaining().begin != block.t_begin || inside.remaining().end != block.t_end) {
      failure = "the cells of a block do not fill its interval";
    }
    while (inside.next(step)) {
      ++cells;
      if (!whole.next(expected)) {
        failure = "a cell too many";
        return false;
      }
      if (!same(step, expected)) failure = "a cell differs";
      if (blocks.index(step.cell[0] / block_width, step.cell[1] / block_width,
                       step.cell[2] / block_width) != block.block) {
        failure = "a cell of another block";
      }
    }
    return failure[0] == '\0';
  });
  if (failure[0] == '\0' && whole.next(expected)) failure = "a cell too few";
  if (failure[0] == '\0' && hits && t != end) failure = "the last block ends too early";
  return failure;
}

TEST(BlockWalk, MillionsOfRaysVisitTheCellsOfTheWholeWalkToTheBit) {
  long rays = 0, hits = 0, cells = 0, crossed = 0;
  for (const int most_values : {7, 17, 40}) {
    WalkGenerator<double> generate(most_values);
    for (int g = 0; g < 7000; ++g) {
      const TestGrid<double> grid = generate.grid();
      const TestBlocks blocks(grid);
      for (int n = 0; n < 100; ++n) {
        const Ray<double> ray = generate.ray(grid);
        Interval<double> range{0, infinity};
        if (generate.pick(8) == 0) range = {-1e9, 1e9};
        if (generate.pick(8) == 0) range = {10 * generate.uniform(), 30 * generate.uniform()};
        const long before = cells;
        const std::string failure = check_blocks(grid, blocks.view, ray, range, cells, crossed);
        ASSERT_EQ(failure, "") << text(ray) << ", range " << range.begin << " " << range.end
                               << ", grid " << g << " of " << most_values;
        ++rays;
        hits += cells > before;
      }
    }
  }
  std::cout << rays << " rays, " << hits << " hit, " << cells << " cells, " << crossed
            << " blocks\n";
  // The generator must keep making what it is for.
  EXPECT_GT(hits, rays / 2);
  EXPECT_GT(crossed, hits + hits / 4);
}

/// The walk over cubes of blocks to skip against that over the blocks: each step is one block's, or
/// all that the ray crosses of one cube. Empty: it is as it must be.
const char* check_cubes(const BlockRecords& blocks, const std::vector<BlockClass>& classes,
                        const Ray<double>& ray, Interval<double> range, long& cubes) {
  const std::vector<BlockStep> steps = block_steps(blocks, ray, range);
  const char* failure = "";
  std::size_t n = 0;
  const auto place = [&](int block, int a) {
    const int nx = blocks.axis[0].cells(), ny = blocks.axis[1].cells();
    return a == 0 ? block % nx : a == 1 ? block / nx % ny : block / nx / ny;
  };
  for_each_block(ClassifiedBlocks{blocks, {classes.data()}}, ray, range, [&](const BlockStep& s) {
    if (n == steps.size()) failure = "a step too many";
    if (failure[0] != '\0') return false;
    if (s.block != steps[n].block || s.t_begin != steps[n].t_begin) failure = "another begin";
    const int level = classes[static_cast<std::size_t>(s.block)].level;
    const auto in_cube = [&](int block) {
      bool in = true;
      for (int a = 0; a < 3; ++a) in = in && place(block, a) >> level == place(s.block, a) >> level;
      return in;
    };
    std::size_t last = n;
    while (last + 1 < steps.size() && level > 0 && in_cube(steps[last + 1].block)) ++last;
    cubes += last > n;
    if (s.t_end != steps[last].t_end) failure = "another end";
    n = last + 1;
    return true;
  });
  if (failure[0] == '\0' && n != steps.size()) failure = "a step too few";
  return failure;
}

TEST(BlockWalk, MillionsOfRaysCrossCubesOfBlocksWhereTheBlocksBeginAndEnd) {
  long rays = 0, cubes = 0;
  for (const int most_values : {30, 80}) {
    WalkGenerator<double> generate(most_values);
    for (int g = 0; g < 3000; ++g) {
      const TestGrid<double> grid = generate.grid();
      const TestBlocks blocks(grid);
      // A walk need not care whether a level is right.
      std::vector<BlockClass> classes(static_cast<std::size_t>(blocks.view.count()));
      const int cells = generate.pick(3);
      for (BlockClass& c : classes) {
        const bool skip = generate.pick(4) >= cells;
        const int level = skip ? generate.pick(BlockClasses::highest_level + 1) : 0;
        c = {0, skip ? BlockKind::skip : BlockKind::cells, static_cast<std::uint8_t>(level)};
      }
      for (int n = 0; n < 100; ++n) {
        const Ray<double> ray = generate.ray(grid);
        Interval<double> range{0, infinity};
        if (generate.pick(8) == 0) range = {-1e9, 1e9};
        if (generate.pick(8) == 0) range = {10 * generate.uniform(), 30 * generate.uniform()};
        const std::string failure = check_cubes(blocks.view, classes, ray, range, cubes);
        ASSERT_EQ(failure, "") << text(ray) << ", range " << range.begin << " " << range.end
                               << ", grid " << g << " of " << most_values;
        ++rays;
      }
    }
  }
  std::cout << rays << " rays, " << cubes << " steps over several blocks\n";
  EXPECT_GT(cubes, rays / 4);
}

TEST(BlockWalk, RaysBetweenPlanesOfBlocks) {
  // Every crossing of planes 0, 7, 8, 9, 16, … with every other, in every octant; ±0 as well.
  for (const int padding : {0, 1}) {
    TestGrid<double> grid;
    for (int a = 0; a < 3; ++a) grid.set_uniform(a, 20, padding);
    const TestBlocks blocks(grid);
    const double places[] = {grid.lower(0), 0, 6, 7, 8, 8.5, 9, 15, 16, 19, grid.upper(0)};
    const Vec3<double> directions[] = {{1, 0, -0.0},  {-1, 0, 0},     {0, 1, 0},   {0, 0, -1},
                                       {1, 1, 0},     {-1, 1, -0.0},  {1, -1, 1},  {-1, -1, -1},
                                       {1, 0.5, 0.5}, {-0.25, 1, -2}, {0, -1, -1}, {1e-320, 1, 0}};
    long cells = 0, crossed = 0;
    for (const double x : places) {
      for (const double y : places) {
        for (const double z : places) {
          for (const Vec3<double>& d : directions) {
            for (const double back : {0.0, 8.0, 40.0}) {
              const Ray<double> ray{Vec3<double>{x, y, z} - back * d, d};
              const std::string failure =
                  check_blocks(grid, blocks.view, ray, {0, infinity}, cells, crossed);
              ASSERT_EQ(failure, "") << text(ray);
            }
          }
        }
      }
    }
    EXPECT_GT(crossed, 5000);
  }
}

TEST(BlockWalk, KnownBlocks) {
  TestGrid<double> grid;  // 20 cells: 8, 8 and 4
  for (int a = 0; a < 3; ++a) grid.set_uniform(a, 21, 0);
  const TestBlocks blocks(grid);
  EXPECT_EQ(blocks.view.count(), 27);
  EXPECT_EQ(blocks.planes[0], (std::vector<double>{0, 8, 16, 20}));
  const auto steps = block_steps(blocks.view, {{-4, 8, 20}, {2, 0, 0}});
  ASSERT_EQ(steps.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const BlockStep& s = steps[static_cast<std::size_t>(i)];
    EXPECT_EQ(s.block, blocks.view.index(i, 1, 2));  // in planes: the upper block, or the last
    EXPECT_EQ(s.t_begin, 2 + 4 * i);
    EXPECT_EQ(s.t_end, i < 2 ? 6 + 4 * i : 12);
  }
  // From inside, backwards, and through an edge: no block that is only touched.
  const auto inside = block_steps(blocks.view, {{12, 12, 1}, {-1, -1, 0}});
  ASSERT_EQ(inside.size(), 2u);
  EXPECT_EQ(inside[0].block, blocks.view.index(1, 1, 0));
  EXPECT_EQ(inside[0].t_begin, 0);
  EXPECT_EQ(inside[0].t_end, 4);
  EXPECT_EQ(inside[1].block, blocks.view.index(0, 0, 0));
  EXPECT_EQ(inside[1].t_end, 12);

  grid.set_uniform(0, 9, 1);  // planes -½, 0, …, 8, 8½: 10 cells
  const TestBlocks centred(grid);
  EXPECT_EQ(centred.planes[0], (std::vector<double>{-0.5, 7, 8.5}));
  grid.set_uniform(0, 1, 1);
  EXPECT_EQ(TestBlocks(grid).planes[0], (std::vector<double>{-0.5, 0.5}));
  grid.set_uniform(0, 9, 0);
  EXPECT_EQ(TestBlocks(grid).planes[0], (std::vector<double>{0, 8}));
}

TEST(BlockWalk, StopsWhenToldTo) {
  TestGrid<double> grid;
  for (int a = 0; a < 3; ++a) grid.set_uniform(a, 41, 0);
  const TestBlocks blocks(grid);
  int seen = 0;
  for_each_block(blocks.view, {{-1, 1, 1}, {1, 0, 0}}, {0, infinity},
                 [&](const BlockStep&) { return ++seen < 3; });
  EXPECT_EQ(seen, 3);
}

TEST(BlockWalk, NothingOnRaysThatMissOrAreNotNumbers) {
  TestGrid<double> grid;
  for (int a = 0; a < 3; ++a) grid.set_uniform(a, 20, 1);
  const TestBlocks blocks(grid);
  const Ray<double> rays[] = {{{-1, 30, 1}, {1, 0, 0}},     {{-1, 1, 1}, {-1, 0, 0}},
                              {{nan, 1, 1}, {1, 0, 0}},     {{1, 1, 1}, {nan, 0, 0}},
                              {{1, nan, 1}, {1, 0, 0}},     {{1, 1, 1}, {0, 0, 0}},
                              {{-1, 1, 1}, {1e-320, 0, 0}}, {{-2, 1, 1}, {1, nan, 0}}};
  for (const Ray<double>& ray : rays) {
    EXPECT_TRUE(block_steps(blocks.view, ray).empty()) << text(ray);
  }
  EXPECT_TRUE(block_steps(blocks.view, {{-1, 1, 1}, {1, 0, 0}}, {5, 5}).empty());
  EXPECT_TRUE(block_steps(blocks.view, {{-1, 1, 1}, {1, 0, 0}}, {6, 5}).empty());
}

}  // namespace
}  // namespace pellucid::test_block_walk
