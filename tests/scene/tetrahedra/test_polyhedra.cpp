// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "mixed_mesh.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/tetrahedralize.h"
#include "tetrahedra_check.h"

namespace pellucid::test_polyhedra {
namespace {

using Face = std::vector<std::int32_t>;

template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void add_polyhedron(UnstructuredGrid& grid, const std::vector<Face>& faces) {
  grid.shapes.push_back(CellShape::polyhedron);
  const std::size_t head = grid.layouts.size();
  grid.layouts.insert(grid.layouts.end(), {0, static_cast<std::int32_t>(faces.size())});
  std::int32_t count = 0;
  for (const Face& face : faces) {
    grid.layouts.push_back(static_cast<std::int32_t>(face.size()));
    grid.corners.insert(grid.corners.end(), face.begin(), face.end());
    count += static_cast<std::int32_t>(face.size());
  }
  grid.layouts[head] = count;
}

std::vector<Face> faces_of(const GridCell& cell) {
  const std::vector<Face> of =
      cell.shape == CellShape::tetrahedron
          ? std::vector<Face>{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}}
      : cell.shape == CellShape::pyramid
          ? std::vector<Face>{{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}
      : cell.shape == CellShape::wedge
          ? std::vector<Face>{{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}
          : std::vector<Face>{{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                              {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  std::vector<Face> faces;
  for (const Face& face : of) {
    faces.emplace_back();
    for (const std::int32_t i : face) {
      faces.back().push_back(cell.points[static_cast<std::size_t>(i)]);
    }
  }
  return faces;
}

/// Some of its cells as polyhedra, whose faces stand in any order and run either way from anywhere.
UnstructuredGrid with_polyhedra(const UnstructuredGrid& mixed, unsigned one_in,
                                std::mt19937& random) {
  UnstructuredGrid grid;
  grid.points = mixed.points;
  for (CellWalk walk(mixed); !walk.done();) {
    const GridCell cell = walk.next();
    if (random() % one_in != 0) {
      grid.shapes.push_back(cell.shape);
      grid.corners.insert(grid.corners.end(), cell.points.begin(), cell.points.end());
      continue;
    }
    std::vector<Face> faces = faces_of(cell);
    std::ranges::shuffle(faces, random);
    for (Face& face : faces) {
      std::ranges::rotate(face, face.begin() + static_cast<std::ptrdiff_t>(random() % face.size()));
      if (random() % 2 == 0) std::ranges::reverse(face);
    }
    add_polyhedron(grid, faces);
  }
  return grid;
}

TEST(Polyhedra, BesideOtherCellsHaveNoCracks) {
  for (const unsigned one_in : {1U, 2U}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      const int n = 1 + static_cast<int>(seed % 4);
      const MixedMesh mixed(n, seed, false);
      const UnstructuredGrid grid = with_polyhedra(mixed.grid(), one_in, random);
      const UnstructuredGrid tetrahedra = tetrahedralize(grid);
      const TetrahedraCheck check(tetrahedra);
      EXPECT_FALSE(check.crowded());
      EXPECT_EQ(check.euler_characteristic(), 1);
      EXPECT_NEAR(check.six_volumes / (6 * mixed.volume()), 1, 1e-12);
      EXPECT_GT(check.smallest, 0);
      EXPECT_EQ(check.boundary().size(), static_cast<std::size_t>(12 * n * n));
    }
  }
}

// A cube of edge 2 beside eight of edge 1: one side of it is four squares, and those beside have a
// point in the middle of an edge.
UnstructuredGrid refined(std::mt19937& random) {
  UnstructuredGrid grid;
  std::vector<std::int32_t> number(27 + 4);
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<std::int32_t>(i);
  std::ranges::shuffle(number, random);
  grid.points.resize(number.size());
  const auto point = [&](std::size_t i) { return number[i]; };
  const auto at = [&](int i, int j, int k) {
    return point(static_cast<std::size_t>(i + 3 * (j + 3 * k)));
  };
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        grid.points[static_cast<std::size_t>(at(i, j, k))] = {1.0 * i, 1.0 * j, 1.0 * k};
      }
    }
  }
  const std::int32_t a = point(27), b = point(28), c = point(29), d = point(30);
  const std::pair<std::int32_t, Vec3<double>> far[] = {
      {a, {4, 0, 0}}, {b, {4, 2, 0}}, {c, {4, 2, 2}}, {d, {4, 0, 2}}};
  for (const auto& [i, place] : far) grid.points[static_cast<std::size_t>(i)] = place;
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      for (int i = 0; i < 2; ++i) {
        grid.shapes.push_back(CellShape::hexahedron);
        for (const int z : {k, k + 1}) {
          for (const std::int32_t corner :
               {at(i, j, z), at(i + 1, j, z), at(i + 1, j + 1, z), at(i, j + 1, z)}) {
            grid.corners.push_back(corner);
          }
        }
      }
    }
  }
  std::vector<Face> faces{{a, b, c, d},
                          {at(2, 0, 0), at(2, 1, 0), at(2, 2, 0), b, a},
                          {at(2, 2, 0), at(2, 2, 1), at(2, 2, 2), c, b},
                          {at(2, 2, 2), at(2, 1, 2), at(2, 0, 2), d, c},
                          {at(2, 0, 2), at(2, 0, 1), at(2, 0, 0), a, d}};
  for (int k = 0; k < 2; ++k) {
    for (int j = 0; j < 2; ++j) {
      faces.push_back({at(2, j, k), at(2, j + 1, k), at(2, j + 1, k + 1), at(2, j, k + 1)});
    }
  }
  add_polyhedron(grid, faces);
  return grid;
}

TEST(Polyhedra, MeetFinerCells) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    UnstructuredGrid grid = refined(random);
    std::vector<double> values;
    for (const Vec3<double>& p : grid.points) values.push_back(3 * p.x - 2 * p.y + p.z + 1);
    grid.arrays.push_back({"field", Centering::point, 1, values});
    const UnstructuredGrid tetrahedra = tetrahedralize(grid);
    const TetrahedraCheck check(tetrahedra);
    EXPECT_FALSE(check.crowded());
    EXPECT_EQ(check.euler_characteristic(), 1);
    EXPECT_NEAR(check.six_volumes, 6 * 16, 1e-9);
    EXPECT_GT(check.smallest, 1e-3);
    // Of the fine cubes 20 squares, of the coarse one a square and four pentagons.
    EXPECT_EQ(check.boundary().size(), 20U * 2 + 2 + 4 * 3);
    // What is linear stays so at the new point.
    const auto& found = std::get<DataArray<double>>(tetrahedra.arrays[0].values);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Vec3<double>& p = tetrahedra.points[i];
      EXPECT_NEAR(found[i], 3 * p.x - 2 * p.y + p.z + 1, 1e-12);
    }
  }
}

/// Two prisms on both sides of a polygon in z = 0, whose faces begin and run as `random` says.
UnstructuredGrid two_prisms(const std::vector<Vec3<double>>& polygon, std::mt19937& random) {
  UnstructuredGrid grid;
  const auto n = static_cast<std::int32_t>(polygon.size());
  std::vector<std::int32_t> number(static_cast<std::size_t>(3 * n));
  for (std::size_t i = 0; i < number.size(); ++i) number[i] = static_cast<std::int32_t>(i);
  std::ranges::shuffle(number, random);
  const auto at = [&](std::int32_t layer, std::int32_t i) {
    return number[static_cast<std::size_t>(layer * n + i % n)];
  };
  grid.points.resize(number.size());
  for (std::int32_t layer = 0; layer < 3; ++layer) {
    for (std::int32_t i = 0; i < n; ++i) {
      Vec3<double> p = polygon[static_cast<std::size_t>(i)];
      p.z += layer - 1;
      grid.points[static_cast<std::size_t>(at(layer, i))] = p;
    }
  }
  for (std::int32_t low = 0; low < 2; ++low) {
    std::vector<Face> faces(2);
    for (std::int32_t i = 0; i < n; ++i) {
      faces[0].push_back(at(low, i));
      faces[1].push_back(at(low + 1, i));
      faces.push_back({at(low, i), at(low, i + 1), at(low + 1, i + 1), at(low + 1, i)});
    }
    for (Face& face : faces) {
      std::ranges::rotate(face, face.begin() + static_cast<std::ptrdiff_t>(random() % face.size()));
      if (random() % 2 == 0) std::ranges::reverse(face);
    }
    add_polyhedron(grid, faces);
  }
  return grid;
}

struct Outline {
  const char* what;
  std::vector<Vec3<double>> points;
  double area;
};

// Faces of many points, not flat, with points on straight edges, and concave ones.
TEST(Polyhedra, CutLargeFacesAlikeFromBothSides) {
  const std::vector<Outline> outlines{
      {"pentagon", {{0, 0, 0}, {4, 0, 0}, {5, 3, 0}, {2, 5, 0}, {-1, 3, 0}}, 21},
      {"hexagon that is not flat",
       {{2, 0, .2}, {4, 0, -.1}, {6, 3, .1}, {4, 6, 0}, {2, 6, -.2}, {0, 3, .1}},
       24},
      {"square with a point on each edge",
       {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}},
       4},
      {"triangle with a point on an edge", {{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {1, 3, 0}}, 6},
      {"dart", {{0, 0, 0}, {4, 1.5, 0}, {0, 3, 0}, {1, 1.5, 0}}, 4.5},
      {"concave pentagon", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 2.5, 0}, {0, 4, 0}}, 13}};
  for (const Outline& outline : outlines) {
    for (unsigned seed = 0; seed < 30; ++seed) {
      SCOPED_TRACE(std::string(outline.what) + ", seed " + std::to_string(seed));
      std::mt19937 random(seed);
      const UnstructuredGrid grid = two_prisms(outline.points, random);
      const UnstructuredGrid tetrahedra = tetrahedralize(grid);
      const TetrahedraCheck check(tetrahedra);
      const std::size_t n = outline.points.size();
      EXPECT_FALSE(check.crowded());
      EXPECT_EQ(check.euler_characteristic(), 1);
      EXPECT_EQ(check.boundary().size(), 2 * (n - 2) + 2 * 2 * n);
      // Where they are not flat, those outside depend on how they are cut.
      const bool flat = outline.points[0].z == 0;
      EXPECT_NEAR(check.six_volumes, 6 * 2 * outline.area, flat ? 1e-9 : 10);
      EXPECT_GT(check.smallest, 1e-6);
    }
  }
}

// Prisms over an L, a star with deep notches, and an arrow, none of which is convex.
TEST(Polyhedra, ConcaveOnesAreCutFromWhereAllIsSeen) {
  const std::vector<Outline> outlines{
      {"L", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 3},
      {"star", {{4, 0, 0}, {1, 1, 0}, {-2, 3, 0}, {-1, 0, 0}, {-2, -3, 0}, {1, -1, 0}}, 12},
      {"arrow", {{0, 0, 0}, {8, 3, 0}, {0, 6, 0}, {6, 3, 0}}, 6}};
  for (const Outline& outline : outlines) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(std::string(outline.what) + ", seed " + std::to_string(seed));
      std::mt19937 random(seed);
      UnstructuredGrid grid = two_prisms(outline.points, random);
      const TetrahedraCheck check(tetrahedralize(grid));
      EXPECT_FALSE(check.crowded());
      EXPECT_EQ(check.euler_characteristic(), 1);
      EXPECT_NEAR(check.six_volumes, 6 * 2 * outline.area, 1e-9);
      grid.arrays.push_back({"c", Centering::cell, 1, DataArray<float>(2)});
      const std::vector<MeshArrayChoice> choices{{"c", {}, {}}};
      EXPECT_EQ(cut_into_tetrahedra(grid, choices)->mesh().statistics().folded_faces, 0U);
    }
  }
}

TEST(Polyhedra, RefusesWhatIsNoBody) {
  UnstructuredGrid cube;
  cube.points.resize(9);
  cube.cell_numbers = {7};
  const std::vector<Face> faces = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                   {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  const auto error = [&](std::vector<Face> of) {
    UnstructuredGrid grid = cube;
    add_polyhedron(grid, of);
    return error_of([&] { tetrahedralize(grid); });
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  std::vector<Face> open = faces;
  open.pop_back();
  EXPECT_TRUE(has(error(open), "cell 7: the faces of its polyhedron do not close: the edge from"));
  std::vector<Face> twice = faces;
  twice.push_back(faces[0]);
  EXPECT_TRUE(has(error(twice), "belongs to 3 of them"));
  std::vector<Face> repeated = faces;
  repeated[0] = {0, 1, 1, 2, 3};
  EXPECT_TRUE(has(error(repeated), "point 1 twice in a row"));
  EXPECT_TRUE(has(error({{0, 1, 2}, {0, 1, 2}}), "polyhedron of 2 faces"));
  std::vector<Face> edge = faces;
  edge.push_back({0, 1});
  EXPECT_TRUE(has(error(edge), "a face of 2 points"));
  std::vector<Face> beyond = faces;
  beyond[0] = {0, 1, 2, 30};
  EXPECT_TRUE(has(error(beyond), "cell 7 has point 30"));
  EXPECT_TRUE(has(error({}), "its layout has 0 points"));
  UnstructuredGrid grid = cube;
  add_polyhedron(grid, faces);
  grid.layouts[1] = 90;
  EXPECT_TRUE(has(error_of([&] { tetrahedralize(grid); }), "90 faces is cut off"));
  grid.layouts[1] = 6;
  grid.layouts[4] = 5;
  EXPECT_TRUE(has(error_of([&] { tetrahedralize(grid); }), "25 points, but it says 24"));
}

}  // namespace
}  // namespace pellucid::test_polyhedra
