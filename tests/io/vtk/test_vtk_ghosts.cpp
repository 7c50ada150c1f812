// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include "mesh_files.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"
#include "vtk_pieces.h"

#ifdef PELLUCID_HAVE_VTK

namespace pellucid::test_vtk_ghosts {
namespace {

using test::contains;
using test::error_of;
using test::vtk_grid;
using test::vtk_values;
using test::VtkPiece;
using test::xml_array;
using test::xml_file;

class VtkGhosts : public test::ScratchFolder {};

// Files of version 0.1 have numbers of layers where newer ones have flags.
TEST_F(VtkGhosts, GhostLevelsAreGhosts) {
  for (const char* version : {"0.1", "1.0", "2.2"}) {
    SCOPED_TRACE(version);
    test::SmallVtu of;
    of.more = xml_array("UInt8", "vtkGhostLevels", "0 1 0");
    std::string text = test::small_vtu(of);
    text.replace(text.find("version=\"1.0\" byte"), 13, std::string("version=\"") + version + "\"");
    const MeshFile file = read_mesh(write("a.vtu", text));
    EXPECT_EQ(file.ghost_cells, 1U);
    EXPECT_EQ(file.grid.shapes.size(), 1U);
    for (const MeshArray& array : file.grid.arrays) {
      EXPECT_FALSE(contains(array.name, "Ghost")) << array.name;
    }
    // Two pieces that overlap: the second has the tetrahedra of the first as its ghosts.
    test::SmallVtu own, ghosts;
    own.more = xml_array("UInt8", "vtkGhostLevels", "0 0 0");
    ghosts.more = xml_array("UInt8", "vtkGhostLevels", "1 2 1");
    const auto with_version = [&](std::string mesh) {
      return mesh.replace(mesh.find("version=\"1.0\" byte"), 13,
                          std::string("version=\"") + version + "\"");
    };
    write("l.vtu", with_version(test::small_vtu(own)));
    write("r.vtu", with_version(test::small_vtu(ghosts)));
    const std::string pieces = with_version(xml_file(
        "PUnstructuredGrid",
        "<PUnstructuredGrid GhostLevel=\"1\"><PCellData><PDataArray type=\"UInt8\" "
        "Name=\"vtkGhostLevels\"/><PDataArray type=\"Int32\" Name=\"id\"/></PCellData><PPoints>"
        "<PDataArray type=\"Float64\" NumberOfComponents=\"3\"/></PPoints><Piece "
        "Source=\"l.vtu\"/><Piece Source=\"r.vtu\"/></PUnstructuredGrid>\n"));
    EXPECT_EQ(read_mesh(write("a.pvtu", pieces)).grid.shapes.size(), 2U);
    // A list that does not name them.
    std::string unlisted = pieces;
    const std::string named = "<PDataArray type=\"UInt8\" Name=\"vtkGhostLevels\"/>";
    ASSERT_TRUE(contains(unlisted, named));
    unlisted.erase(unlisted.find(named), named.size());
    EXPECT_EQ(read_mesh(write("b.pvtu", unlisted)).grid.shapes.size(), 2U);
    write("b.vtm", xml_file("vtkMultiBlockDataSet",
                            "<vtkMultiBlockDataSet><DataSet index=\"0\" file=\"b.pvtu\"/>"
                            "</vtkMultiBlockDataSet>\n"));
    EXPECT_EQ(read_mesh(path("b.vtm")).grid.shapes.size(), 2U);
    // Levels of points are no values to show, in images neither.
    VtkPiece piece;
    std::string levels;
    for (int i = 0; i < 120; ++i) levels += "0 ";
    piece.points = xml_array("UInt8", "vtkGhostLevels", levels) +
                   xml_array("Int16", "v", vtk_values(piece.extent));
    const Volume volume = read_volume(write("a.vti", with_version(vtk_grid("ImageData", {piece}))));
    EXPECT_EQ(test::value_at(volume, 3, 4, 5), 543);
    EXPECT_EQ(list_arrays(path("a.vti")).size(), 1U);
  }
}

TEST_F(VtkGhosts, HiddenPointsHideTheCellsAround) {
  const std::string legacy = test::small_structured_vtk();
  const auto with = [&](const std::string& flags) {
    return legacy + "POINT_DATA 12\nFIELD FieldData 1\nvtkGhostType 1 12 unsigned_char\n" + flags +
           "\n";
  };
  EXPECT_EQ(read_mesh(write("a.vtk", with("2 0 0 0 0 0 0 0 0 0 0 0"))).ghost_cells, 1U);
  EXPECT_EQ(read_mesh(write("a.vtk", with("0 0 0 0 0 0 0 0 0 0 0 2"))).grid.cell_numbers.size(),
            0U);
  EXPECT_EQ(read_mesh(write("a.vtk", with("0 0 0 0 0 0 0 0 1 0 0 0"))).grid.shapes.size(), 2U);
  // One in the middle hides both.
  write("a.vtk", with("0 2 0 0 0 0 0 0 0 0 0 0"));
  EXPECT_TRUE(contains(error_of([&] { read_mesh(path("a.vtk")); }), "no cell"));
}

// 8 is REFINEDCELL, of a cell that a finer level shows.
TEST_F(VtkGhosts, RefinedCellsAreHidden) {
  test::SmallVtu of;
  of.more = xml_array("UInt8", "vtkGhostType", "0 8 0");
  EXPECT_EQ(read_mesh(write("a.vtu", test::small_vtu(of))).ghost_cells, 1U);
  EXPECT_EQ(
      read_mesh(write("a.vtk", test::small_structured_vtk() + "FIELD FieldData 1\nvtkGhostType 1 2 "
                                                              "unsigned_char\n8 0\n"))
          .ghost_cells,
      1U);
  VtkPiece piece;
  piece.extent = {0, 2, 0, 1, 0, 1};
  piece.has_points = false;
  piece.has_cells = true;
  piece.cells = xml_array("UInt8", "vtkGhostType", "0 8") + xml_array("Int16", "v", "1 2");
  const Volume volume = read_volume(write("a.vti", vtk_grid("ImageData", {piece}, "0 2 0 1 0 1")));
  EXPECT_EQ(test::value_at(volume, 0, 0, 0), 1);
  EXPECT_TRUE(std::isnan(test::value_at(volume, 1, 0, 0)));
}

TEST_F(VtkGhosts, HiddenPointsHideCellsOfUnstructuredGrids) {
  const auto with = [&](const std::string& flags) {
    std::string text = test::small_vtu();
    const std::string end = "</PointData>";
    return text.insert(text.find(end), xml_array("UInt8", "vtkGhostType", flags));
  };
  EXPECT_EQ(read_mesh(write("a.vtu", with("0 0 0 0 2"))).ghost_cells, 1U);
  // Cell 0 is left, whose number is its place.
  EXPECT_TRUE(read_mesh(write("a.vtu", with("0 0 0 0 2"))).grid.cell_numbers.empty());
  EXPECT_EQ(read_mesh(write("a.vtu", with("0 0 0 0 1"))).ghost_cells, 0U);
  // The triangle has this corner, too.
  EXPECT_EQ(read_mesh(write("a.vtu", with("2 0 0 0 0"))).ghost_cells, 2U);
}

}  // namespace
}  // namespace pellucid::test_vtk_ghosts

#endif
