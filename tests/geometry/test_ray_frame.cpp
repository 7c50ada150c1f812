// SPDX-License-Identifier: Apache-2.0
#include "pellucid/geometry/ray_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace pellucid::test_ray_frame {
namespace {

using Place = Vec3<double>;

/// The places of points with coordinates in {-1, 0, 1}, so that most meet the ray or lie in line.
std::vector<ProjectedPoint<double>> small_lattice() {
  std::vector<ProjectedPoint<double>> all;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) all.push_back({x, y, 0});
  }
  return all;
}

/// With the ray moved by ε along x and ε² along y, ε as small as it need be here: the sign of the
/// determinant then, in numbers that hold it exactly.
bool left_after_moving(const ProjectedPoint<double>& a, const ProjectedPoint<double>& b) {
  const double e = 0x1p-10;
  const double a_x = a.x - e, a_y = a.y - e * e, b_x = b.x - e, b_y = b.y - e * e;
  return a_x * b_y - a_y * b_x > 0;
}

TEST(SideOf, TiesAreBrokenAsIfTheRayWereMoved) {
  for (const auto& a : small_lattice()) {
    for (const auto& b : small_lattice()) {
      if (a.x == b.x && a.y == b.y) continue;
      const Side<double> side = side_of(a, b);
      EXPECT_EQ(side.area, a.x * b.y - a.y * b.x);
      EXPECT_EQ(side.left, left_after_moving(a, b))
          << a.x << " " << a.y << " to " << b.x << " " << b.y;
      EXPECT_NE(side_of(b, a).left, side.left);
      EXPECT_EQ(side_of(ProjectedPoint<float>{static_cast<float>(a.x), static_cast<float>(a.y), 0},
                        ProjectedPoint<float>{static_cast<float>(b.x), static_cast<float>(b.y), 0})
                    .left,
                side.left);
    }
  }
}

/// Whoever is inside of two of three neighbouring triangles, or of none, sees a crack: around the
/// ray, and with it on edges and points, exactly one of them is met.
TEST(SideOf, TrianglesAroundAPointMeetTheRayOnce) {
  const auto inside = [](const ProjectedPoint<double>& a, const ProjectedPoint<double>& b,
                         const ProjectedPoint<double>& c) {
    const bool first = side_of(a, b).left;
    return first == side_of(b, c).left && first == side_of(c, a).left;
  };
  // A fan around each point of the lattice, seen with the ray in every place of it.
  const double around[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                               {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
  for (const auto& middle : small_lattice()) {
    int met = 0;
    for (int i = 0; i < 8; ++i) {
      const auto corner = [&](int k) {
        return ProjectedPoint<double>{middle.x + 2 * around[k % 8][0],
                                      middle.y + 2 * around[k % 8][1], 0};
      };
      met += inside(middle, corner(i), corner(i + 1)) ? 1 : 0;
    }
    EXPECT_EQ(met, 1) << middle.x << " " << middle.y;
  }
}

/// Along an axis nothing is sheared: what stands on a grid stays there, to the bit.
TEST(RayFrame, AlongAnAxisPointsAreWhereTheyAre) {
  for (int z = 0; z < 3; ++z) {
    for (const double sign : {1.0, -1.0}) {
      Place direction{}, origin{0.1, -0.7, 1.0 / 3};
      direction[z] = sign;
      const RayFrame<double> view = make_ray_frame({origin, direction}, {5, 5, 5}, 10);
      const int x = (z + 1) % 3, y = (z + 2) % 3;
      for (const double a : {0.1, 0.3, -2.0 / 3}) {
        Place point{0.7, 1.1, -0.2};
        point[x] = a;
        const ProjectedPoint<double> seen = view.project(point);
        EXPECT_EQ(seen.x, a - origin[x]);
        EXPECT_EQ(seen.y, point[y] - origin[y]);
        EXPECT_NEAR(seen.t, sign * (point[z] - origin[z]), view.position_error);
        // On the ray's own line: at (0, 0), without any rounding.
        point[x] = origin[x];
        point[y] = origin[y];
        EXPECT_EQ(view.project(point).x, 0);
        EXPECT_EQ(view.project(point).y, 0);
      }
    }
  }
}

/// In long double, from the definition: along the ray's fastest axis the point is projected on it.
TEST(RayFrame, SeesPointsWithinTheBlurThatItStates) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  long double largest = 0;
  for (int i = 0; i < 4000; ++i) {
    const double far = i % 4 == 0 ? 1e6 : 3;
    const Place origin{far * uniform(random), far * uniform(random), far * uniform(random)};
    const Place direction =
        normalized(Place{uniform(random), uniform(random), i % 3 == 0 ? 1e-9 : uniform(random)});
    const Place point{uniform(random), uniform(random), uniform(random)};
    const RayFrame<double> view = make_ray_frame({origin, direction}, {0, 0, 0}, 1);
    int z = 0;
    for (int a = 1; a < 3; ++a) {
      if (std::fabs(direction[a]) > std::fabs(direction[z])) z = a;
    }
    const int x = z == 2 ? 0 : z + 1, y = x == 2 ? 0 : x + 1;
    // The direction is off by 2 u: the same for all who look, and part of the blur.
    const long double t = (static_cast<long double>(point[z]) - origin[z]) / direction[z];
    const auto place = [&](int a) {
      return static_cast<long double>(point[a]) - (origin[a] + t * direction[a]);
    };
    const ProjectedPoint<double> seen = view.project(point);
    for (const long double off : {seen.x - place(x), seen.y - place(y), seen.t - t}) {
      ASSERT_LE(std::fabs(off), static_cast<long double>(view.position_error)) << i;
      largest = std::max(largest, std::fabs(off) / static_cast<long double>(view.position_error));
    }
  }
  std::printf("[ accuracy ] places are off by up to %.2Lf of the blur\n", largest);
  // A bound that is of use is not a hundred times too large.
  EXPECT_GT(largest, 0.01L);
}

}  // namespace
}  // namespace pellucid::test_ray_frame
