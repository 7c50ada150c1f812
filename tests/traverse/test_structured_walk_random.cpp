// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <iostream>
#include <limits>
#include <vector>

#include "walk_check.h"
#include "walk_generator.h"

namespace pellucid::test_structured_walk_random {
namespace {

template <class T>
class RandomWalks : public testing::Test {};
using NumberTypes = testing::Types<float, double>;
TYPED_TEST_SUITE(RandomWalks, NumberTypes);

TYPED_TEST(RandomWalks, MillionsAreContiguousAndCoverTheRay) {
  using T = TypeParam;
  constexpr Interval<T> range{T(0), std::numeric_limits<T>::infinity()};
  WalkGenerator<T> generate;
  long rays = 0, hits = 0, steps_total = 0, ties = 0;
  for (int g = 0; g < 10000; ++g) {
    const TestGrid<T> grid = generate.grid();
    for (int n = 0; n < 100; ++n) {
      const Ray<T> ray = generate.ray(grid);
      const auto steps = walk(grid, ray);
      const std::string failure = check_exact(grid, ray, range, steps);
      ASSERT_EQ(failure, "") << text(ray) << ", grid " << g;
      ++rays;
      hits += !steps.empty();
      steps_total += static_cast<long>(steps.size());
      for (std::size_t i = 1; i < steps.size(); ++i) {
        int moved = 0;
        for (int a = 0; a < 3; ++a) moved += steps[i].cell[a] != steps[i - 1].cell[a];
        ties += moved > 1;
      }
    }
  }
  std::cout << rays << " rays, " << hits << " hit, " << steps_total << " cells, " << ties
            << " steps through edges or vertices\n";
  // The generator must keep making what it is for.
  EXPECT_GT(hits, rays / 2);
  EXPECT_GT(ties, rays / 50);
}

TYPED_TEST(RandomWalks, AgreeWithBruteForce) {
  using T = TypeParam;
  constexpr Interval<T> range{T(0), std::numeric_limits<T>::infinity()};
  WalkGenerator<T> generate;
  for (int g = 0; g < 5000; ++g) {
    const TestGrid<T> grid = generate.grid();
    for (int n = 0; n < 40; ++n) {
      const Ray<T> ray = generate.ray(grid);
      const auto steps = walk(grid, ray);
      ASSERT_EQ(check_brute_force(grid, ray, range, steps), "") << text(ray) << ", grid " << g;
      ASSERT_EQ(check_positions(grid, ray, steps), "") << text(ray) << ", grid " << g;
    }
  }
}

TYPED_TEST(RandomWalks, CutsAnywhereMeetAgain) {
  using T = TypeParam;
  constexpr T infinity = std::numeric_limits<T>::infinity();
  WalkGenerator<T> generate;
  for (int g = 0; g < 2000; ++g) {
    const TestGrid<T> grid = generate.grid();
    for (int n = 0; n < 50; ++n) {
      const Ray<T> ray = generate.ray(grid);
      const auto whole = walk(grid, ray);
      if (whole.empty()) continue;
      const auto& somewhere =
          whole[static_cast<std::size_t>(generate.pick(static_cast<int>(whole.size())))];
      const T cut = generate.pick(2) == 0
                        ? somewhere.t_end
                        : somewhere.t_begin + static_cast<T>(generate.uniform()) *
                                                  (somewhere.t_end - somewhere.t_begin);
      const auto front = walk(grid, ray, {T(0), cut});
      const auto back = walk(grid, ray, {cut, infinity});
      ASSERT_EQ(check_exact(grid, ray, {T(0), cut}, front), "") << text(ray);
      ASSERT_EQ(check_exact(grid, ray, {cut, infinity}, back), "") << text(ray);
      // The steps are those of the whole ray, but for the cell that the cut divides.
      std::size_t f = 0;
      for (; f < front.size() && front[f].t_end == whole[f].t_end; ++f) {
        for (int a = 0; a < 3; ++a) ASSERT_EQ(front[f].cell[a], whole[f].cell[a]) << text(ray);
        ASSERT_EQ(front[f].exit, whole[f].exit) << text(ray);
      }
      if (f < front.size()) {
        ASSERT_EQ(front.size(), f + 1) << text(ray);
        ASSERT_EQ(front[f].t_end, cut) << text(ray);
      }
      ASSERT_EQ(back.size(), whole.size() - f) << text(ray);
      for (std::size_t b = 0; b < back.size(); ++b) {
        for (int a = 0; a < 3; ++a) ASSERT_EQ(back[b].cell[a], whole[f + b].cell[a]) << text(ray);
        ASSERT_EQ(back[b].t_end, whole[f + b].t_end) << text(ray);
        ASSERT_EQ(back[b].exit, whole[f + b].exit) << text(ray);
      }
    }
  }
}

TYPED_TEST(RandomWalks, SignOfZeroDoesNotMatter) {
  using T = TypeParam;
  WalkGenerator<T> generate;
  int compared = 0;
  for (int g = 0; g < 2000; ++g) {
    const TestGrid<T> grid = generate.grid();
    for (int n = 0; n < 20; ++n) {
      Ray<T> ray = generate.ray(grid);
      ray.direction[generate.pick(3)] = T(0);
      Ray<T> other = ray;
      for (int a = 0; a < 3; ++a) {
        if (ray.direction[a] == T(0)) other.direction[a] = -ray.direction[a];
      }
      const auto p = walk(grid, ray), q = walk(grid, other);
      ASSERT_EQ(p.size(), q.size()) << text(ray);
      for (std::size_t i = 0; i < p.size(); ++i) {
        for (int a = 0; a < 3; ++a) ASSERT_EQ(p[i].cell[a], q[i].cell[a]) << text(ray);
        ASSERT_EQ(p[i].t_begin, q[i].t_begin) << text(ray);
        ASSERT_EQ(p[i].t_end, q[i].t_end) << text(ray);
        ASSERT_EQ(p[i].entry, q[i].entry) << text(ray);
        ASSERT_EQ(p[i].exit, q[i].exit) << text(ray);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 20000);
}

TEST(RandomWalks, MirroredGridGivesMirroredWalk) {
  // Negating every coordinate is exact, so that the walks must be mirror images to the bit, but for
  // rays that do not move along a plane (which belongs to its upper cell).
  WalkGenerator<double> generate;
  int compared = 0;
  for (int g = 0; g < 4000; ++g) {
    const TestGrid<double> grid = generate.grid();
    TestGrid<double> mirrored;
    for (int a = 0; a < 3; ++a) {
      std::vector<double> planes;
      for (int i = grid.axis[a].cells(); i >= 0; --i) planes.push_back(-grid.axis[a].plane(i));
      mirrored.set_planes(a, planes, 0);
    }
    for (int n = 0; n < 20; ++n) {
      const Ray<double> ray = generate.ray(grid);
      if (ray.direction.x == 0 || ray.direction.y == 0 || ray.direction.z == 0) continue;
      const auto p = walk(grid, ray);
      const auto q = walk(mirrored, {-ray.origin, -ray.direction});
      ASSERT_EQ(p.size(), q.size()) << text(ray);
      for (std::size_t i = 0; i < p.size(); ++i) {
        for (int a = 0; a < 3; ++a) {
          ASSERT_EQ(p[i].cell[a], grid.axis[a].cells() - 1 - q[i].cell[a]) << text(ray);
        }
        ASSERT_EQ(p[i].t_begin, q[i].t_begin) << text(ray);
        ASSERT_EQ(p[i].t_end, q[i].t_end) << text(ray);
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 50000);
}

TEST(RandomWalks, HugeOffsetsStayInTheGrid) {
  // Where the planes can no longer be told apart from so far away, cells are passed over; what is
  // left must still be in order, and the walk must end.
  WalkGenerator<double> generate;
  for (int n = 0; n < 20000; ++n) {
    TestGrid<double> grid;
    for (int a = 0; a < 3; ++a) grid.set_uniform(a, 2 + generate.pick(40), generate.pick(2));
    const double distance =
        std::pow(10, 12 + 290 * generate.uniform() * generate.pick(2) + 6 * generate.uniform());
    Ray<double> ray;
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = distance * (2 * generate.uniform() - 1);
      ray.direction[a] = 5 - ray.origin[a];
    }
    if (generate.pick(2) == 0) ray.direction = ray.direction * (1 / distance);
    const Interval<double> range{0, std::numeric_limits<double>::infinity()};
    const auto steps = walk(grid, ray);
    ASSERT_EQ(check_exact(grid, ray, range, steps), "") << text(ray);
  }
}

}  // namespace
}  // namespace pellucid::test_structured_walk_random
