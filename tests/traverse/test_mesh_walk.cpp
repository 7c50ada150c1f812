// SPDX-License-Identifier: Apache-2.0
#include "pellucid/traverse/mesh_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <vector>

#include "pellucid/traverse/boundary_hits.h"

/// What of the walk is topology: wherever rounding puts points, in float or in double, a ray that
/// comes in by a face of the boundary goes out by another, through each tetrahedron once.
namespace pellucid::test_mesh_walk {
namespace {

using Place = Vec3<double>;

/// n³ cubes of six tetrahedra, faces paired by comparing them all; one node holds the boundary.
struct Cubes {
  std::vector<Place> points;
  std::vector<Tetrahedron> tetrahedra;
  std::vector<std::int32_t> boundary;
  BoundaryNode root{{-1e9f, -1e9f, -1e9f}, {1e9f, 1e9f, 1e9f}, 0, 0};
  int n;

  explicit Cubes(int cubes) : n(cubes) {
    const int side = n + 1;
    for (int i = 0; i < side * side * side; ++i) {
      points.push_back({1.0 * (i % side), 1.0 * (i / side % side), 1.0 * (i / side / side)});
    }
    std::array<int, 3> step{1, side, side * side};
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          std::sort(step.begin(), step.end());
          do {
            Tetrahedron t{{i + side * (j + side * k)}};
            for (std::size_t c = 0; c < 3; ++c) t.corner[c + 1] = t.corner[c] + step[c];
            tetrahedra.push_back(t);
          } while (std::next_permutation(step.begin(), step.end()));
        }
      }
    }
    std::map<std::array<std::int32_t, 3>, std::int32_t> open;
    for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
      for (int f = 0; f < 4; ++f) {
        std::array<std::int32_t, 3> face{};
        for (int c = 0; c < 3; ++c) {
          face[static_cast<std::size_t>(c)] = tetrahedra[i][corner_of_face(f, c)];
        }
        const auto code = static_cast<std::int32_t>(4 * i) + f;
        const auto [found, is_new] = open.insert({face, code});
        if (is_new) continue;
        tetrahedra[i].neighbor[f] = found->second;
        tetrahedra[static_cast<std::size_t>(found->second >> 2)].neighbor[found->second & 3] = code;
        open.erase(found);
      }
    }
    for (const auto& [face, code] : open) boundary.push_back(code);
    root.count = static_cast<std::int32_t>(boundary.size());
  }

  Tetrahedra view() const {
    const double size = n;
    return {points.data(), tetrahedra.data(),  &root, boundary.data(),
            {0, 0, 0},     {size, size, size}, size,  static_cast<std::int32_t>(tetrahedra.size())};
  }
};

/// Follows the ray from every boundary face that it goes through, in T. Returns how many steps it
/// took; `met` how often each tetrahedron was gone through.
template <class T>
int follow(const Cubes& cubes, const Ray<double>& ray, std::vector<int>& met) {
  const Tetrahedra mesh = cubes.view();
  const RayFrame<double> view = make_ray_frame(ray, mesh.center(), mesh.coordinate_bound);
  const auto see = [&](std::int32_t point) {
    const ProjectedPoint<double> p = view.project(mesh.point[point]);
    return ProjectedPoint<T>{static_cast<T>(p.x), static_cast<T>(p.y), static_cast<T>(p.t)};
  };
  const auto load = [&](int point, ProjectedPoint<T>& seen, T& carried) noexcept {
    seen = see(point);
    carried = static_cast<T>(point);
  };
  std::vector<std::int32_t> ends;
  std::map<std::int32_t, std::int32_t> left_by;
  int steps = 0;
  met.assign(cubes.tetrahedra.size(), 0);
  for (const std::int32_t code : cubes.boundary) {
    SeenFace<T> face;
    if (!see_face(mesh, code, see, face)) continue;
    for (int i = 0; i < 3; ++i) face.carried[i] = static_cast<T>(face.point[i]);
    ends.push_back(code);
    MeshWalk<T> walk(mesh);
    walk.enter(true, face, code, load);
    while (walk.ahead() != Tetrahedron::outside) {
      const int here = walk.ahead() >> 2;
      ++met[static_cast<std::size_t>(here)];
      walk.step(true, load);
      EXPECT_EQ(walk.left_by() >> 2, here);
      // The face's points, and what is carried of them, are those of the tetrahedron's face.
      std::array<int, 3> expected{}, found{};
      for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        expected[at] = mesh.tetrahedron[here][corner_of_face(walk.left_by() & 3, i)];
        found[at] = walk.face().point[i];
        EXPECT_EQ(walk.face().carried[i], static_cast<T>(found[at]));
        EXPECT_EQ(walk.face().seen[i].x, see(found[at]).x);
      }
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected);
      // The areas are those that the face has, seen by itself.
      SeenFace<T> alone;
      EXPECT_TRUE(see_face(mesh, walk.left_by(), see, alone));
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) {
          if (alone.point[k] == walk.face().point[i]) {
            EXPECT_NEAR(static_cast<double>(walk.face().area[i]),
                        static_cast<double>(alone.area[k]),
                        1e-5 * mesh.coordinate_bound * mesh.coordinate_bound);
            EXPECT_EQ(walk.face().size[i], alone.size[k]);
          }
        }
      }
      if (++steps > 100000) {
        ADD_FAILURE() << "a walk without an end";
        return steps;
      }
    }
    left_by[code] = walk.left_by();
  }
  // Each way in is also a way out, and back by the same way.
  EXPECT_EQ(ends.size() % 2, 0u);
  for (const auto& [in, out] : left_by) {
    EXPECT_NE(in, out);
    EXPECT_TRUE(left_by.contains(out));
    if (left_by.contains(out)) {
      EXPECT_EQ(left_by[out], in);
    }
  }
  return steps;
}

template <class T>
void expect_every_tetrahedron_once(const Cubes& cubes) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::uniform_int_distribution<int> lattice(-2, 2);
  long steps = 0;
  for (int i = 0; i < 600; ++i) {
    const double size = cubes.n;
    Place direction{uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5};
    if (i % 2 == 0)
      direction = {1.0 * lattice(random), 1.0 * lattice(random), 1.0 * lattice(random)};
    if (dot(direction, direction) == 0) continue;
    Place target{size * uniform(random), size * uniform(random), size * uniform(random)};
    if (i % 4 < 2) target = cubes.points[random() % cubes.points.size()];
    direction = normalized(direction);
    std::vector<int> met;
    steps += follow<T>(cubes, {target - direction * (3 * size), direction}, met);
    // Once from each end.
    for (const int times : met) ASSERT_TRUE(times == 0 || times == 2) << times << ", ray " << i;
  }
  EXPECT_GT(steps, 5000);
}

TEST(MeshWalk, GoesThroughEachTetrahedronOnceInDouble) {
  expect_every_tetrahedron_once<double>(Cubes(3));
}
TEST(MeshWalk, GoesThroughEachTetrahedronOnceInFloat) {
  expect_every_tetrahedron_once<float>(Cubes(3));
}

}  // namespace
}  // namespace pellucid::test_mesh_walk
