// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "pellucid/io/read_mesh.h"
#include "pellucid/io/write_mesh.h"
#include "pellucid/scene/error.h"
#include "tests/io/scratch_folder.h"

namespace pellucid::test_vtu_file {
namespace {

/// One cell of every shape that VTK and we know, each at points of its own, with arrays of all
/// types.
UnstructuredGrid grid() {
  UnstructuredGrid g;
  for (const CellShape shape :
       {CellShape::tetrahedron, CellShape::pyramid, CellShape::wedge, CellShape::hexahedron,
        CellShape::voxel, CellShape::quadratic_tetrahedron, CellShape::quadratic_pyramid,
        CellShape::quadratic_wedge, CellShape::quadratic_hexahedron, CellShape::biquadratic_wedge,
        CellShape::triquadratic_hexahedron}) {
    g.shapes.push_back(shape);
    for (int i = 0; i < point_count(shape); ++i) {
      const auto n = static_cast<std::int32_t>(g.points.size());
      g.corners.push_back(n);
      g.points.push_back({n + 0.1, n * n * 1e-3, -n / 3.0});
    }
  }
  const std::size_t points = g.points.size(), cells = g.shapes.size();
  const auto counted = [](auto zero, std::size_t count) {
    std::vector<decltype(zero)> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<decltype(zero)>(i);
    return values;
  };
  g.arrays = {{"u8", Centering::point, 1, counted(std::uint8_t{}, points)},
              {"i8", Centering::cell, 1, counted(std::int8_t{}, cells)},
              {"u16", Centering::cell, 2, counted(std::uint16_t{}, 2 * cells)},
              {"i16", Centering::point, 1, counted(std::int16_t{}, points)},
              {"u32", Centering::point, 1, counted(std::uint32_t{}, points)},
              {"i32", Centering::cell, 1, counted(std::int32_t{}, cells)},
              {"<a & \"b\">", Centering::point, 3, counted(0.F, 3 * points)},
              {"f64", Centering::point, 1, counted(0.0, points)}};
  return g;
}

class VtuFile : public test::ScratchFolder {};

// Read by VTK itself, which the writer does without.
TEST_F(VtuFile, IsWhatVtkReads) {
  const UnstructuredGrid written = grid();
  write_vtu(written, path("a.vtu"));
  MeshFile file;
  try {
    file = read_mesh(path("a.vtu"));
  } catch (const Error& error) {
    if (std::string(error.what()).find("this build does not read") == std::string::npos) throw;
    GTEST_SKIP() << "built without VTK";
  }
  const UnstructuredGrid& got = file.grid;
  ASSERT_EQ(got.points.size(), written.points.size());
  for (std::size_t i = 0; i < got.points.size(); ++i) {
    EXPECT_TRUE(got.points[i] == written.points[i]) << i;
  }
  EXPECT_EQ(got.shapes, written.shapes);
  EXPECT_EQ(got.corners, written.corners);
  ASSERT_EQ(got.arrays.size(), written.arrays.size());
  for (const MeshArray& array : written.arrays) {
    bool found = false;
    for (const MeshArray& other : got.arrays) {
      if (other.name != array.name) continue;
      found = true;
      EXPECT_EQ(other.centering, array.centering) << array.name;
      EXPECT_EQ(other.components, array.components) << array.name;
      EXPECT_TRUE(other.values == array.values) << array.name;
    }
    EXPECT_TRUE(found) << array.name;
  }
}

TEST_F(VtuFile, NamesAreUtf8WithoutControlCharacters) {
  UnstructuredGrid g = grid();
  g.arrays.resize(1);
  g.arrays[0].name = "a\n\xff\xc3\xa4";
  write_vtu(g, path("a.vtu"));
  EXPECT_NE(read(path("a.vtu")).find("Name=\"a_\xef\xbf\xbd\xc3\xa4\""), std::string::npos);
}

TEST_F(VtuFile, RefusesWhatDoesNotAgreeAndLeavesNothing) {
  UnstructuredGrid g = grid();
  g.corners.pop_back();
  EXPECT_THROW(write_vtu(g, path("a.vtu")), Error);
  g = grid();
  g.arrays[1].components = 2;
  EXPECT_THROW(write_vtu(g, path("a.vtu")), Error);
  EXPECT_THROW(write_vtu(grid(), path("nowhere/a.vtu")), Error);
  EXPECT_TRUE(std::filesystem::is_empty(path("")));
}

}  // namespace
}  // namespace pellucid::test_vtu_file
