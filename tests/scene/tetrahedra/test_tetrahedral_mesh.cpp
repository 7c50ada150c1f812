// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/tetrahedral_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "lattice_mesh.h"
#include "tests/scene/expect_error.h"
#include "tests/scene/in_threads.h"

namespace pellucid::test_tetrahedral_mesh {
namespace {

using Place = Vec3<double>;
using Corners = std::array<std::int32_t, 4>;
using Face = std::array<std::int32_t, 3>;
using Description = TetrahedralMesh::Description;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Description corner() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, "corner.vtu"};
}

/// The codes of the tetrahedra that have each face.
std::map<Face, std::vector<std::int32_t>> owners(const TetrahedralMesh& mesh) {
  std::map<Face, std::vector<std::int32_t>> all;
  for (std::size_t i = 0; i < mesh.tetrahedra().size(); ++i) {
    for (int f = 0; f < 4; ++f) {
      Face face{};
      std::size_t n = 0;
      for (int k = 0; k < 4; ++k) {
        if (k != f) face[n++] = mesh.tetrahedra()[i][k];
      }
      std::sort(face.begin(), face.end());
      all[face].push_back(static_cast<std::int32_t>(4 * i) + f);
    }
  }
  return all;
}

void expect_refused(Description mesh, std::initializer_list<const char*> parts) {
  expect_error([&] { const TetrahedralMesh refused(std::move(mesh)); }, parts);
}

TEST(TetrahedralMesh, IsCounted) {
  Description description = corner();
  description.points.push_back({7, 7, 7});
  const TetrahedralMesh mesh(description);
  const MeshStatistics& s = mesh.statistics();
  EXPECT_EQ(s.points, 4u);
  EXPECT_EQ(s.unused_points, 1u);
  EXPECT_EQ(s.tetrahedra, 1u);
  EXPECT_EQ(s.boundary_faces, 4u);
  EXPECT_EQ(s.degenerate, 0u);
  EXPECT_EQ(s.folded_faces, 0u);
  EXPECT_DOUBLE_EQ(s.volume, 1.0 / 6);
  EXPECT_DOUBLE_EQ(s.mean_edge, (1 + std::sqrt(2.0)) / 2);
  EXPECT_EQ(mesh.name(), "corner.vtu");
  // The point that none uses counts for nothing.
  EXPECT_EQ(mesh.bounds().upper, (Place{1, 1, 1}));
  EXPECT_EQ(mesh.view().coordinate_bound, 1);
  EXPECT_EQ(mesh.view().count, 1);
}

TEST(TetrahedralMesh, KeepsTetrahedraInOrderAndTheirPointsAscending) {
  Description description = lattice_mesh(2, 5);
  std::vector<Corners> given = description.tetrahedra;
  const TetrahedralMesh mesh(std::move(description));
  ASSERT_EQ(mesh.tetrahedra().size(), given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    std::sort(given[i].begin(), given[i].end());
    EXPECT_TRUE(std::equal(given[i].begin(), given[i].end(), mesh.tetrahedra()[i].begin()));
  }
}

TEST(TetrahedralMesh, FacesArePairedAsByComparingAllOfThem) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Description description = lattice_mesh(4, seed);
    // With holes, so that inner faces become outer ones.
    std::erase_if(description.tetrahedra, [](const Corners& t) { return t[0] % 7 == 0; });
    const TetrahedralMesh mesh(std::move(description));
    std::size_t boundary = 0;
    for (const auto& [face, codes] : owners(mesh)) {
      const auto behind = [&](std::int32_t code) {
        return mesh.tetrahedra()[static_cast<std::size_t>(code >> 2)].neighbor[code & 3];
      };
      ASSERT_LE(codes.size(), 2u);
      if (codes.size() == 1) {
        ASSERT_EQ(behind(codes[0]), Tetrahedron::outside);
        ++boundary;
      } else {
        ASSERT_EQ(behind(codes[0]), codes[1]);
        ASSERT_EQ(behind(codes[1]), codes[0]);
      }
    }
    EXPECT_EQ(mesh.statistics().boundary_faces, boundary);
    EXPECT_EQ(mesh.statistics().folded_faces, 0u);
    EXPECT_EQ(mesh.statistics().degenerate, 0u);
    EXPECT_NEAR(mesh.statistics().volume, static_cast<double>(mesh.tetrahedra().size()) / 6, 1e-9);
  }
}

/// Each boundary face once, in a leaf whose box holds it, as do those of all nodes above.
TEST(TetrahedralMesh, TheTreeHoldsTheBoundary) {
  for (const int n : {1, 2, 5}) {
    Description description = lattice_mesh(n, 9);
    for (Place& p : description.points) p = {1e3 + 0.1 * p.x, p.y / 3, -1e-3 * p.z};
    const TetrahedralMesh mesh(std::move(description));
    const Tetrahedra view = mesh.view();
    std::vector<std::int32_t> expected;
    for (const auto& [face, codes] : owners(mesh)) {
      if (codes.size() == 1) expected.push_back(codes[0]);
    }
    std::vector<std::int32_t> found;
    std::vector<std::pair<std::int32_t, std::vector<std::int32_t>>> open{{0, {}}};
    while (!open.empty()) {
      auto [number, above] = std::move(open.back());
      open.pop_back();
      above.push_back(number);
      const BoundaryNode& node = view.tree[number];
      if (node.count == 0) {
        open.push_back({node.first, above});
        open.push_back({node.first + 1, above});
        continue;
      }
      for (std::int32_t i = 0; i < node.count; ++i) {
        const std::int32_t code = view.boundary[node.first + i];
        found.push_back(code);
        for (int k = 0; k < 4; ++k) {
          if (k == (code & 3)) continue;
          const Place& p = view.point[view.tetrahedron[code >> 2][k]];
          for (const std::int32_t box : above) {
            for (int a = 0; a < 3; ++a) {
              // Larger by more than what rounding to float can take.
              const double slack = 0x1p-22 * view.coordinate_bound;
              ASSERT_LE(static_cast<double>(view.tree[box].lower[a]), p[a] - slack);
              ASSERT_GE(static_cast<double>(view.tree[box].upper[a]), p[a] + slack);
            }
          }
        }
      }
    }
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(found, expected) << n;
    EXPECT_EQ(found.size(), static_cast<std::size_t>(12 * n * n));
  }
}

TEST(TetrahedralMesh, OrientationDoesNotMatter) {
  Description description{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {{0, 1, 2, 3}, {1, 2, 3, 4}}, ""};
  for (Corners t : {Corners{1, 2, 3, 4}, Corners{2, 1, 3, 4}, Corners{4, 3, 2, 1}}) {
    description.tetrahedra[1] = t;
    const TetrahedralMesh mesh(description);
    EXPECT_EQ(mesh.statistics().folded_faces, 0u);
    EXPECT_EQ(mesh.statistics().boundary_faces, 6u);
    EXPECT_DOUBLE_EQ(mesh.statistics().volume, 0.5);
  }
}

/// Both on the same side of the face that they share, however their points are numbered.
TEST(TetrahedralMesh, FoldedFacesAreCounted) {
  std::array<std::int32_t, 5> number{0, 1, 2, 3, 4};
  const Place place[5] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, 1}, {0.3, 0.1, 0.5}};
  do {
    const auto described = [&](double side) {
      Description mesh;
      mesh.points.resize(5);
      for (std::size_t i = 0; i < 5; ++i) {
        Place p = place[i];
        if (i == 4) p.z *= side;
        mesh.points[static_cast<std::size_t>(number[i])] = p;
      }
      mesh.tetrahedra = {{number[0], number[1], number[2], number[3]},
                         {number[0], number[1], number[2], number[4]}};
      return mesh;
    };
    EXPECT_EQ(TetrahedralMesh(described(1)).statistics().folded_faces, 1u);
    EXPECT_EQ(TetrahedralMesh(described(-1)).statistics().folded_faces, 0u);
  } while (std::next_permutation(number.begin(), number.end()));
}

TEST(TetrahedralMesh, FlatTetrahedraAreCountedAndFoldNothing) {
  Description description = corner();
  description.points.push_back({0.25, 0.5, 0});
  description.tetrahedra.push_back({0, 1, 2, 4});
  const TetrahedralMesh mesh(description);
  EXPECT_EQ(mesh.statistics().degenerate, 1u);
  EXPECT_EQ(mesh.statistics().folded_faces, 0u);
  EXPECT_DOUBLE_EQ(mesh.statistics().volume, 1.0 / 6);
  // All points in one place, and on a line that binary fractions lack.
  description = corner();
  for (std::size_t i = 0; i < 4; ++i) {
    description.points[i] = Place{0.1, 0.7, 1.0 / 3} * static_cast<double>(i);
  }
  EXPECT_EQ(TetrahedralMesh(description).statistics().degenerate, 1u);
  description.points.assign(4, {0.1, 0.2, 0.3});
  EXPECT_EQ(TetrahedralMesh(description).statistics().degenerate, 1u);
}

TEST(TetrahedralMesh, IsTheSameForAnyNumberOfThreads) {
  Description description = lattice_mesh(12, 4);
  for (Place& p : description.points) p = {0.1 * p.x, p.y / 3, p.z * p.z};
  const TetrahedralMesh one(description), two(description, in_threads);
  ASSERT_EQ(one.tetrahedra().size(), two.tetrahedra().size());
  for (std::size_t i = 0; i < one.tetrahedra().size(); ++i) {
    ASSERT_TRUE(std::equal(one.tetrahedra()[i].neighbor, one.tetrahedra()[i].neighbor + 4,
                           two.tetrahedra()[i].neighbor));
  }
  EXPECT_EQ(one.statistics().volume, two.statistics().volume);
  EXPECT_EQ(one.statistics().mean_edge, two.statistics().mean_edge);
}

TEST(TetrahedralMesh, TakesAtMostAHundredBytesATetrahedron) {
  const TetrahedralMesh mesh(lattice_mesh(16, 6));
  EXPECT_LE(mesh.memory_bytes(), 100 * mesh.tetrahedra().size());
}

TEST(TetrahedralMesh, RefusesWhatIsNoMesh) {
  expect_refused({}, {"mesh: ", "there is no tetrahedron"});
  expect_refused({{}, {}, "a.vtu"}, {"a.vtu: ", "at least one cell"});
  expect_refused({{}, {{0, 1, 2, 3}}, ""}, {"tetrahedron 0 has point 3, but there are 0"});
  for (const std::int32_t wrong : {-1, 4, std::numeric_limits<std::int32_t>::max(),
                                   std::numeric_limits<std::int32_t>::min()}) {
    for (std::size_t k = 0; k < 4; ++k) {
      Description description = corner();
      description.tetrahedra.push_back({0, 1, 2, 3});
      description.tetrahedra[1][k] = wrong;
      const std::string number = std::to_string(wrong);
      expect_refused(description,
                     {"corner.vtu: tetrahedron 1 has point ", number.c_str(), "are 4"});
    }
  }
  Description description = corner();
  description.tetrahedra[0] = {3, 1, 3, 0};
  expect_refused(description, {"tetrahedron 0 has point 3 twice"});
}

TEST(TetrahedralMesh, RefusesPointsThatAreNowhereOnlyWhereTheyAreUsed) {
  for (const double wrong : {nan, infinity, -infinity, 2.2e37, -1e300}) {
    for (int a = 0; a < 3; ++a) {
      Description description = corner();
      description.points[2][a] = wrong;
      expect_refused(description, {"corner.vtu: point 2 is ", "must be finite and within 2.1e37"});
      description.points.insert(description.points.begin(), {9, 9, 9});
      description.points[0][a] = wrong;
      description.points[3] = {0, 1, 0};
      description.tetrahedra[0] = {1, 2, 3, 4};
      EXPECT_EQ(TetrahedralMesh(description).statistics().unused_points, 1u);
    }
  }
}

TEST(TetrahedralMesh, RefusesAFaceOfMoreThanTwo) {
  Description description = corner();
  description.points.push_back({-1, -1, -1});
  description.points.push_back({1, 1, 1});
  description.tetrahedra = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}};
  expect_refused(description,
                 {"a face of the tetrahedron of points 0, 1, 2 and 3", "more than two tetrahedra"});
  description.tetrahedra = {{0, 1, 2, 3}, {3, 2, 1, 0}, {1, 0, 2, 3}};
  expect_refused(description, {"more than two tetrahedra", "cells stand twice"});
}

TEST(TetrahedralMesh, CallsPointsByTheirNumbers) {
  Description description = corner();
  description.point_numbers = {40, 10, 30, 20};
  const TetrahedralMesh mesh(description);
  EXPECT_EQ(mesh.point_number(2), 30);
  EXPECT_EQ(mesh.describe(0), "the tetrahedron of points 10, 20, 30 and 40");
  EXPECT_EQ(TetrahedralMesh(corner()).point_number(2), 2);
  description.points[1].y = infinity;
  expect_refused(description, {"point 10 is (1, inf, 0)"});
  description.point_numbers.pop_back();
  expect_refused(description, {"3 numbers for 4 points"});
}

TEST(TetrahedralMesh, RefusesATetrahedronThatStandsTwice) {
  Description description = corner();
  description.tetrahedra = {{0, 1, 2, 3}, {2, 0, 3, 1}};
  expect_refused(description, {"stand twice"});
}

}  // namespace
}  // namespace pellucid::test_tetrahedral_mesh
