// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "pellucid/traverse/mesh_spans.h"
#include "src/reference/mesh/mesh.h"
#include "tests/scenes/meshes.h"

/// The walk through a mesh against the reference, which meets each tetrahedron by itself: every one
/// once, none left out, wherever the ray goes.
namespace pellucid::test_mesh_walk {
namespace {

using Place = Vec3<double>;

struct Walked {
  double length = 0;
  int again = 0;  ///< tetrahedra gone through more than once
};

/// Both kinds of spans are told from each other by a channel that counts the tetrahedra.
Walked walk(const TetrahedralMesh& mesh, const std::vector<double>& numbers, const Place& origin,
            const Place& direction) {
  const Tetrahedra view = mesh.view();
  MeshFields fields;
  fields.channels = 1;
  fields.channel[0] = {numbers.data(), true};
  const Ray<double> ray{origin, direction};
  const RayFrame<double> seen =
      make_ray_frame(ray, 0.5 * (view.lower + view.upper), view.coordinate_bound);
  std::vector<MeshHit> hits;
  for_each_boundary_hit(view, ray, seen, [&](const MeshHit& hit) { hits.push_back(hit); });
  std::sort(hits.begin(), hits.end());
  EXPECT_EQ(hits.size() % 2, 0u);
  Walked result;
  std::set<double> met;
  for_each_mesh_span(view, fields, seen, hits.data(), static_cast<int>(hits.size()),
                     [&](const MeshSpan& span) {
                       EXPECT_FALSE(span.overlaps);
                       result.length += span.end - span.begin;
                       if (!met.insert(span.front[0]).second) ++result.again;
                       return true;
                     });
  return result;
}

Place unit(const Place& d) {
  return d * (1 / length(d));
}

/// Points, middles of edges and of faces of every tetrahedron.
std::vector<Place> marks_of(const TetrahedralMesh& mesh) {
  std::vector<Place> marks;
  for (const Tetrahedron& t : mesh.tetrahedra()) {
    const auto at = [&](int i) { return mesh.points()[static_cast<std::size_t>(t[i])]; };
    for (int i = 0; i < 4; ++i) {
      marks.push_back(at(i));
      for (int j = 0; j < i; ++j) marks.push_back(0.5 * (at(i) + at(j)));
      marks.push_back((at(0) + at(1) + at(2) + at(3) - at(i)) * (1.0 / 3));
    }
  }
  return marks;
}

/// A ray within the boundary, or as near to it as `position_error`, may be in or out.
bool in_doubt(const reference::Mesh& own, const Place& origin, const Place& direction,
              double length, double blur) {
  for (int i = 0; i < 8; ++i) {
    const double angle = 0.1 + 0.785398 * i;
    const Place side = unit(cross(direction, Place{std::cos(angle), 0.3, std::sin(angle)}));
    const Place moved = origin + side * blur;
    double inside = 0;
    for (const auto& c :
         own.crossings({{moved.x, moved.y, moved.z}, {direction.x, direction.y, direction.z}})) {
      inside += static_cast<double>(c.t_end - c.t_begin);
    }
    if (std::abs(inside - length) > 1e-4) return true;
  }
  return false;
}

void expect_watertight(TetrahedralMesh::Description description,
                       const std::vector<Place>& directions, std::size_t step) {
  const TetrahedralMesh mesh(std::move(description));
  const reference::Mesh own(mesh);
  std::vector<double> numbers(mesh.tetrahedra().size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  const double size = length(mesh.bounds().upper - mesh.bounds().lower);
  const std::vector<Place> marks = marks_of(mesh);
  int rays = 0, doubtful = 0;
  double largest = 0;
  for (const Place& way : directions) {
    const Place direction = unit(way);
    for (std::size_t m = 0; m < marks.size(); m += step) {
      const Place origin = marks[m] - 2 * size * direction;
      const auto crossings =
          own.crossings({{origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}});
      double inside = 0;
      for (const auto& c : crossings) inside += static_cast<double>(c.t_end - c.t_begin);
      const Walked walked = walk(mesh, numbers, origin, direction);
      EXPECT_EQ(walked.again, 0);
      ++rays;
      const double off = std::abs(walked.length - inside);
      if (off > 1e-12 * size && in_doubt(own, origin, direction, inside, 1e-14 * size)) {
        ++doubtful;
        continue;
      }
      largest = std::max(largest, off);
      ASSERT_LT(off, 1e-12 * size) << "mark " << m << ", direction " << way.x << " " << way.y << " "
                                   << way.z << ": " << walked.length << " for " << inside;
    }
  }
  std::printf("[ accuracy ] %d rays, %d of them within the boundary; lengths %.1e apart\n", rays,
              doubtful, largest);
  EXPECT_LT(doubtful, rays / 3);
}

std::vector<Place> many_directions() {
  std::vector<Place> result{{1, 0, 0},  {0, -1, 0}, {0, 0, 1},  {1, 1, 0},
                            {0, 1, -1}, {1, 1, 1},  {-1, 1, 1}, {2, 1, 0}};
  std::mt19937 random(5);
  const auto draw = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  for (int i = 0; i < 4; ++i) {
    const double x = draw(), y = draw();
    result.push_back({x, y, draw()});
  }
  return result;
}

TEST(MeshWalkIsWatertight, ThroughALattice) {
  expect_watertight(scenes::box_of_cubes(3), many_directions(), 1);
}

TEST(MeshWalkIsWatertight, ThroughALatticeThatBinaryFractionsLack) {
  expect_watertight(scenes::tetrahedralize({{4, 3, 3},
                                            [](int i, int j, int k) {
                                              return Place{0.1 * i + 0.3, 0.7 * j, k / 3.0};
                                            }}),
                    many_directions(), 1);
}

TEST(MeshWalkIsWatertight, ThroughDelaunaysSlivers) {
  expect_watertight(scenes::random_delaunay(120, 2), many_directions(), 3);
}

TEST(MeshWalkIsWatertight, ThroughSliversOfAMillionth) {
  TetrahedralMesh::Description flat = scenes::random_delaunay(120, 4);
  for (Place& p : flat.points) p.z *= 1e-6;
  expect_watertight(std::move(flat), many_directions(), 5);
}

TEST(MeshWalkIsWatertight, ThroughHoles) {
  scenes::Lattice lattice;
  lattice.cubes = {4, 4, 4};
  lattice.place = [](int i, int j, int k) { return Place{1.0 * i, 1.0 * j, 1.0 * k}; };
  lattice.keep = [](int i, int j, int k) { return (i * 5 + j * 3 + k * 7) % 4 != 0; };
  expect_watertight(scenes::tetrahedralize(lattice), {{0.3, -0.5, 0.7}, {0.9, 0.2, 0.1}}, 1);
}

}  // namespace
}  // namespace pellucid::test_mesh_walk
