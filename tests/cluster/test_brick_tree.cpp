// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "pellucid/cluster/brick_tree.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/scene.h"

namespace pellucid {
namespace {

using Random = std::mt19937_64;

double in(Random& random, double lower, double upper) {
  return std::uniform_real_distribution<double>(lower, upper)(random);
}

Affine<double> oblique() {
  Affine<double> map;
  map.matrix.column[0] = {0.9, 0.2, -0.1};
  map.matrix.column[1] = {-0.3, 0.8, 0.2};
  map.matrix.column[2] = {0.1, -0.1, 1.7};
  map.translation = {3, -2, 5};
  return map;
}

constexpr Box<double> bounds{{0, 0, 0}, {40, 30, 20}};

std::vector<BrickTree> trees() {
  std::vector<BrickTree> list;
  for (const int bricks : {1, 2, 3, 4, 7, 8, 13}) {
    list.push_back(BrickTree::split(oblique(), bounds, bricks, {}, bricks % 2 == 0));
  }
  return list;
}

Ray<double> any_ray(Random& random) {
  const Vec3<double> origin{in(random, -60, 60), in(random, -60, 60), in(random, -60, 60)};
  const Vec3<double> to =
      oblique().point({in(random, 0, 40), in(random, 0, 30), in(random, 0, 20)});
  return {origin, normalized(to - origin)};
}

TEST(BrickTree, RaysArePartitioned) {
  Random random(1);
  for (const BrickTree& tree : trees()) {
    for (int n = 0; n < 300; ++n) {
      const Ray<double> ray = any_ray(random);
      std::vector<Interval<double>> parts;
      for (int brick = 0; brick < tree.count(); ++brick) {
        const Interval<double> part = tree.region(brick).range(ray);
        if (part.begin < part.end) parts.push_back(part);
      }
      std::ranges::sort(parts, {}, &Interval<double>::begin);
      ASSERT_FALSE(parts.empty());
      EXPECT_EQ(parts.front().begin, 0);
      EXPECT_EQ(parts.back().end, std::numeric_limits<double>::infinity());
      // To the bit: neither a gap nor an overlap.
      for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        EXPECT_EQ(parts[i].end, parts[i + 1].begin);
      }
      EXPECT_GE(static_cast<int>(parts.size()), tree.bricks_on(ray));
    }
  }
}

TEST(BrickTree, ARayInAFaceIsInOneBrick) {
  const BrickTree tree = BrickTree::of_boxes({}, {{{0, 0, 0}, {4, 8, 8}}, {{4, 0, 0}, {8, 8, 8}}});
  const Ray<double> ray{{4, 3, -10}, {0, 0, 1}};
  int met = 0;
  for (int brick = 0; brick < 2; ++brick) {
    const Interval<double> part = tree.region(brick).range(ray);
    met += part.begin < part.end ? 1 : 0;
  }
  EXPECT_EQ(met, 1);
  EXPECT_EQ(tree.bricks_on(ray), 1);
}

TEST(BrickTree, RaysMeetBricksInTheOrderOfTheCamera) {
  Random random(2);
  for (const BrickTree& tree : trees()) {
    for (int n = 0; n < 60; ++n) {
      Camera camera;
      camera.projection = n % 2 == 0 ? Projection::perspective : Projection::orthographic;
      camera.position = {in(random, -40, 60), in(random, -40, 60), in(random, -40, 60)};
      camera.focal_point =
          oblique().point({in(random, 0, 40), in(random, 0, 30), in(random, 0, 20)});
      camera.up = {in(random, -1, 1), in(random, -1, 1), in(random, -1, 1)};
      camera.vertical_angle = 70;
      camera.parallel_scale = 20;
      const CameraFrame<double> frame = make_camera_frame(camera, {7, 5});
      const std::vector<int> order = tree.front_to_back(frame);
      ASSERT_EQ(static_cast<int>(order.size()), tree.count());
      for (int row = 0; row < 5; ++row) {
        for (int column = 0; column < 7; ++column) {
          double last = 0;
          for (const int brick : order) {
            const Interval<double> part = tree.region(brick).range(frame.ray(column, row));
            if (!(part.begin < part.end)) continue;
            EXPECT_GE(part.begin, last);
            last = part.end;
          }
        }
      }
    }
  }
}

TEST(BrickTree, BricksHaveEqualWeights) {
  BrickWeights weights{{40, 30, 20}, std::vector<double>(40 * 30 * 20, 0.01)};
  // All in one corner.
  for (std::size_t k = 0; k < 10; ++k) {
    for (std::size_t j = 0; j < 15; ++j) {
      for (std::size_t i = 0; i < 20; ++i) weights.weight[i + 40 * (j + 30 * k)] = 1;
    }
  }
  for (const int bricks : {2, 3, 7, 8}) {
    const BrickTree tree = BrickTree::split({}, bounds, bricks, weights);
    double all = 0, most = 0;
    for (int brick = 0; brick < bricks; ++brick) {
      double sum = 0;
      for (std::size_t k = 0; k < 20; ++k) {
        for (std::size_t j = 0; j < 30; ++j) {
          for (std::size_t i = 0; i < 40; ++i) {
            const Vec3<double> p{0.5 + static_cast<double>(i), 0.5 + static_cast<double>(j),
                                 0.5 + static_cast<double>(k)};
            const Box<double>& box = tree.box(brick);
            bool inside = true;
            for (int a = 0; a < 3; ++a) {
              inside = inside && p[a] >= box.lower[a] && p[a] < box.upper[a];
            }
            if (inside) sum += weights.weight[i + 40 * (j + 30 * k)];
          }
        }
      }
      all += sum;
      most = std::max(most, sum);
    }
    EXPECT_NEAR(all, 3000 + 0.01 * 21000, 1e-6);
    EXPECT_LT(most, 1.25 * all / bricks);
  }
}

TEST(BrickTree, BricksLieBesideEachOtherOnTheScreen) {
  constexpr Box<double> cube{{0, 0, 0}, {20, 20, 20}};
  Random random(3);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int bricks : {2, 4, 8}) {
      Vec3<double> view{0, 0, 0};
      view[axis] = axis == 1 ? -2 : 2;
      const BrickTree tree = BrickTree::split({}, cube, bricks, {}, false, view);
      for (int n = 0; n < 50; ++n) {
        Vec3<double> origin{in(random, 1, 19), in(random, 1, 19), in(random, 1, 19)};
        origin[axis] = axis == 1 ? 30 : -10;
        EXPECT_EQ(tree.bricks_on({origin, normalized(view)}), 1);
      }
    }
  }
  // But not at any price: bricks stay compact.
  const Box<double> slab{{0, 0, 0}, {4, 4, 20}};
  const BrickTree tree = BrickTree::split({}, slab, 2, {}, false, {0, 0, 1});
  EXPECT_EQ(tree.bricks_on({{1, 1, -5}, {0, 0, 1}}), 2);
}

TEST(BrickTree, BoxesThatNoPlaneSeparatesAreRefused) {
  // A pinwheel.
  const std::vector<Box<double>> boxes{{{0, 0, 0}, {2, 1, 1}},
                                       {{2, 0, 0}, {3, 2, 1}},
                                       {{1, 2, 0}, {3, 3, 1}},
                                       {{0, 1, 0}, {1, 3, 1}},
                                       {{1, 1, 0}, {2, 2, 1}}};
  EXPECT_THROW(BrickTree::of_boxes({}, boxes), Error);
  EXPECT_THROW(BrickTree::of_boxes({}, {{{0, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {3, 1, 1}}}), Error);
  EXPECT_THROW(BrickTree::of_boxes({}, {}), Error);
  EXPECT_THROW(BrickTree::split({}, bounds, 0), Error);
  EXPECT_THROW(BrickTree::split({}, {{0, 0, 0}, {1, 0, 1}}, 2), Error);
}

}  // namespace
}  // namespace pellucid
