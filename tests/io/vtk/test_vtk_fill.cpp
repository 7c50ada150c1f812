// SPDX-License-Identifier: Apache-2.0
//
// Files of VTK's that do not have what they say: VTK shows whatever memory holds there, or crashes.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mesh_files.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"
#include "vtk_pieces.h"

#ifdef PELLUCID_HAVE_VTK

namespace pellucid::test_vtk_fill {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::error_of;
using test::vtk_grid;
using test::vtk_list;
using test::vtk_values;
using test::vtk_words;
using test::VtkPiece;
using test::xml_array;
using test::xml_file;

const VtkPiece lower{{0, 3, 0, 4, 0, 3}, {}, {}}, upper{{0, 3, 0, 4, 3, 5}, {}, {}};

class VtkFill : public test::ScratchFolder {
 protected:
  std::string refused(const std::string& name, const std::string& text) const {
    const fs::path file = write(name, text);
    const std::string error = error_of([&] {
      if (is_mesh_file(file)) {
        read_mesh(file);
      } else {
        read_volume(file);
      }
    });
    EXPECT_TRUE(error.starts_with(file.string() + ": ")) << error;
    return error;
  }
  void expect_all(const fs::path& file) const {
    const Volume volume = read_volume(file);
    ASSERT_EQ(volume.description().dimensions, (std::array<int, 3>{4, 5, 6}));
    for (int i = 0; i < 120; ++i) {
      const int x = i % 4, y = i / 4 % 5, z = i / 20;
      ASSERT_EQ(test::value_at(volume, x, y, z), x + 10 * y + 100 * z) << i;
    }
  }
};

TEST_F(VtkFill, PiecesOfOneFileMustFillItsExtent) {
  for (const char* kind : {"ImageData", "RectilinearGrid", "StructuredGrid"}) {
    SCOPED_TRACE(kind);
    const std::string name = kind == std::string("StructuredGrid") ? "a.vts" : "a.vti";
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {lower})), "the point (0, 0, 4) is in none"));
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {upper})), "the point (0, 0, 0) is in none"));
    // Between them, and around one.
    VtkPiece first = lower, inner;
    first.extent[5] = 1;
    EXPECT_TRUE(
        contains(refused(name, vtk_grid(kind, {first, upper})), "the point (0, 0, 2) is in none"));
    inner.extent = {1, 2, 1, 3, 1, 4};
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {inner})), "(0, 0, 0)"));
    refused(name, vtk_grid(kind, {}));
  }
  for (const char* kind : {"ImageData", "RectilinearGrid"}) {
    expect_all(write("b.vti", vtk_grid(kind, {lower, upper})));
  }
  EXPECT_EQ(
      read_mesh(write("b.vts", vtk_grid("StructuredGrid", {lower, upper}))).grid.shapes.size(),
      60U);
}

// Points beside each other, but no cell between.
TEST_F(VtkFill, CellsBetweenPiecesMustBeThere) {
  VtkPiece below = lower, above = upper;
  below.has_points = above.has_points = false;
  below.has_cells = above.has_cells = true;
  below.extent[5] = 2;
  const std::string error = refused("a.vti", vtk_grid("ImageData", {below, above}));
  EXPECT_TRUE(contains(error, "the cell (0, 0, 2) is in none")) << error;
  EXPECT_TRUE(contains(refused("a.vtr", vtk_grid("RectilinearGrid", {below, above})), "(0, 0, 2)"));
  EXPECT_TRUE(contains(refused("a.vts", vtk_grid("StructuredGrid", {below, above})), "(0, 0, 2)"));
}

TEST_F(VtkFill, EachPieceMustHaveTheArray) {
  VtkPiece other = upper;
  other.points = xml_array("Int16", "w", vtk_values(upper.extent));
  for (const char* kind : {"ImageData", "RectilinearGrid", "StructuredGrid"}) {
    SCOPED_TRACE(kind);
    const std::string name = kind == std::string("StructuredGrid") ? "a.vts" : "a.vti";
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {lower, other})), "piece 2 lacks the array"));
    VtkPiece none = upper;
    none.has_points = false;
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {lower, none})), "piece 2 lacks the array"));
    VtkPiece doubles = upper;
    doubles.points = xml_array("Float64", "v", vtk_values(upper.extent));
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {lower, doubles})), "1 Float64"));
  }
  // Of an unstructured grid, whose pieces are one behind the other.
  const std::string mesh = test::small_vtu();
  const std::size_t begin = mesh.find("<Piece"), end = mesh.find("</Unstructured");
  std::string second = mesh.substr(begin, end - begin);
  second.replace(second.find("\"id\""), 4, "\"is\"");
  std::string two = mesh;
  two.insert(end, second);
  EXPECT_TRUE(contains(refused("a.vtu", two), "piece 2 lacks the array \"id\" of cells"));
}

TEST_F(VtkFill, PiecesMayCarryTheWholeExtent) {
  for (const std::string kind : {"ImageData", "RectilinearGrid"}) {
    SCOPED_TRACE(kind);
    write("l.xml", vtk_grid(kind, {lower}));
    write("u.xml", vtk_grid(kind, {upper}));
    expect_all(write("a.pvti",
                     vtk_list("P" + kind, {{"0 3 0 4 0 3", "l.xml"}, {"0 3 0 4 3 5", "u.xml"}})));
    // And their own.
    write("l.xml", vtk_grid(kind, {lower}, vtk_words(lower.extent)));
    write("u.xml", vtk_grid(kind, {upper}, vtk_words(upper.extent)));
    expect_all(path("a.pvti"));
    // More than the list takes from them.
    write("u.xml", vtk_grid(kind, {lower, upper}));
    expect_all(path("a.pvti"));
  }
  write("l.vts", vtk_grid("StructuredGrid", {lower}));
  write("u.vts", vtk_grid("StructuredGrid", {upper}));
  const MeshFile mesh = read_mesh(write(
      "a.pvts", vtk_list("PStructuredGrid", {{"0 3 0 4 0 3", "l.vts"}, {"0 3 0 4 3 5", "u.vts"}})));
  EXPECT_EQ(mesh.grid.shapes.size(), 60U);
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < mesh.grid.points.size(); ++i) {
          const Vec3<double>& p = mesh.grid.points[i];
          EXPECT_EQ(static_cast<double>(values[i]), p.x + 10 * p.y + 100 * p.z);
        }
      },
      mesh.grid.arrays.at(0).values);
}

TEST_F(VtkFill, ListsOfPiecesMustFillTheirExtent) {
  for (const std::string kind : {"ImageData", "RectilinearGrid", "StructuredGrid"}) {
    SCOPED_TRACE(kind);
    const std::string name = kind == "StructuredGrid" ? "a.pvts" : "a.pvti", p = "P" + kind;
    write("l.xml", vtk_grid(kind, {lower}));
    write("u.xml", vtk_grid(kind, {upper}));
    EXPECT_TRUE(contains(refused(name, vtk_list(p, {{"0 3 0 4 0 3", "l.xml"}})), "(0, 0, 4)"));
    // The file has not what the list says.
    const std::string error =
        refused(name, vtk_list(p, {{"0 3 0 4 0 3", "l.xml"}, {"0 3 0 4 3 5", "l.xml"}}));
    EXPECT_TRUE(contains(error, "its piece l.xml: its pieces do not fill")) << error;
    // Nor in the type that it says, nor the array.
    const auto both = std::vector<std::pair<std::string, std::string>>{{"0 3 0 4 0 3", "l.xml"},
                                                                       {"0 3 0 4 3 5", "u.xml"}};
    EXPECT_TRUE(
        contains(refused(name, vtk_list(p, both, "Float32")), "1 Int16 in place of 1 Float32"));
    VtkPiece none = upper;
    none.points = xml_array("Int16", "w", vtk_values(upper.extent));
    write("u.xml", vtk_grid(kind, {none}));
    EXPECT_TRUE(contains(refused(name, vtk_list(p, both)), "its piece u.xml: it lacks the array"));
  }
  const std::string pieces =
      "<PUnstructuredGrid GhostLevel=\"0\"><PPointData><PDataArray type=\"Float64\" Name=\"p\"/>"
      "</PPointData><PPoints><PDataArray type=\"Float64\" NumberOfComponents=\"3\"/></PPoints>"
      "<Piece Source=\"a.vtu\"/></PUnstructuredGrid>\n";
  write("a.vtu", test::small_vtu());
  EXPECT_TRUE(contains(refused("a.pvtu", xml_file("PUnstructuredGrid", pieces)),
                       "1 Float32 in place of 1 Float64"));
}

// 342 values for 343 cells and the like: VTK 9.1 crashes while it says so, if there are no others.
TEST_F(VtkFill, ArraysHaveAsManyValuesAsThereArePlaces) {
  const std::string right = vtk_values({0, 2, 0, 3, 0, 4});
  const auto cells = [&](const std::string& text) {
    VtkPiece piece;
    piece.has_points = false;
    piece.has_cells = true;
    piece.cells = xml_array("Int16", "c", text);
    return piece;
  };
  const std::string fewer = right.substr(0, right.rfind(' ', right.size() - 2) + 1);
  for (const char* kind : {"ImageData", "RectilinearGrid", "StructuredGrid"}) {
    SCOPED_TRACE(kind);
    const std::string name = kind == std::string("StructuredGrid") ? "a.vts" : "a.vti";
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {cells(fewer)})),
                         "the array \"c\" of cells has 59 numbers, but needs 60"));
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {cells("")})), "has 0 numbers"));
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {cells(right + "7 ")})), "has 61 numbers"));
    EXPECT_TRUE(contains(refused(name, vtk_grid(kind, {cells("1 2 nan " + fewer)})),
                         "has 2 numbers before \"nan\""));
    VtkPiece points;
    points.points = xml_array("Int16", "v", vtk_values(points.extent) + "1");
    EXPECT_TRUE(
        contains(refused(name, vtk_grid(kind, {points})), "has 121 numbers, but needs 120"));
  }
  for (const auto& [from, to] :
       {std::pair{"7 8 9", "7 8"}, std::pair{"7 8 9", "7 8 9 10"}, std::pair{"4 8 11", "4 8"},
        std::pair{"10 10 5", "10 10 5 5"}, std::pair{"1 1 1</", "1 1 1 1</"}}) {
    std::string mesh = test::small_vtu();
    mesh.replace(mesh.find(from), std::string(from).size(), to);
    EXPECT_TRUE(contains(refused("a.vtu", mesh), " numbers, but needs ")) << to;
  }
  // Cell data alone.
  test::AnyVtu of = test::polyhedron_vtu();
  of.cell_data = "<CellData>" + xml_array("Float32", "c", "1") + "</CellData>";
  EXPECT_TRUE(contains(refused("a.vtu", of.text()), "has 1 numbers, but needs 2"));
}

/// An image of 2 x 2 x 2 points with bytes behind its XML, or in base64.
std::string image_with(const std::string& array, const std::string& attributes,
                       const std::string& appended = "") {
  return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" " + attributes +
         "><ImageData WholeExtent=\"0 1 0 1 0 1\" Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece "
         "Extent=\"0 1 0 1 0 1\"><PointData><DataArray type=\"UInt8\" Name=\"v\" " +
         array + "</DataArray></PointData></Piece></ImageData>" + appended + "</VTKFile>";
}

TEST_F(VtkFill, BytesAreCounted) {
  const auto appended = [](std::uint64_t said, const std::string& bytes) {
    return image_with("format=\"appended\" offset=\"0\">", "header_type=\"UInt64\"",
                      "<AppendedData encoding=\"raw\">_" + test::bytes_of(std::vector{said}) +
                          bytes + "</AppendedData>");
  };
  const Volume volume = read_volume(write("a.vti", appended(8, "\1\2\3\4\5\6\7\10")));
  EXPECT_EQ(test::value_at(volume, 1, 1, 1), 8);
  EXPECT_TRUE(contains(refused("a.vti", appended(7, "1234567")), "has 7 numbers, but needs 8"));
  EXPECT_TRUE(contains(refused("a.vti", appended(9, "123456789")), "has 9 numbers"));
  // In base64: a header of 4 bytes, 8 or 7, and as many bytes.
  const std::string good = "CAAAAAECAwQFBgcI", bad = "BwAAAAECAwQFBgcI";
  EXPECT_EQ(test::value_at(read_volume(write("b.vti", image_with("format=\"binary\">" + good, ""))),
                           1, 1, 1),
            8);
  EXPECT_TRUE(contains(refused("b.vti", image_with("format=\"binary\">" + bad, "")), "has 7"));
  EXPECT_TRUE(contains(refused("b.vti", image_with("format=\"binary\">" + good.substr(0, 12), "")),
                       "has 5"));
  const std::string base64 = "<AppendedData encoding=\"base64\">_";
  EXPECT_EQ(
      test::value_at(read_volume(write("c.vti", image_with("format=\"appended\" offset=\"0\">", "",
                                                           base64 + good + "</AppendedData>"))),
                     0, 0, 0),
      1);
  EXPECT_TRUE(contains(refused("c.vti", image_with("format=\"appended\" offset=\"0\">", "",
                                                   base64 + bad + "</AppendedData>")),
                       "has 7"));
  // Compressed: one block of 7 bytes.
  const std::string packed = test::deflated("1234567", 15);
  const std::vector<std::uint64_t> head{1, 8, 7, packed.size()};
  const std::string compressed = image_with(
      "format=\"appended\" offset=\"0\">",
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"",
      "<AppendedData encoding=\"raw\">_" + test::bytes_of(head) + packed + "</AppendedData>");
  EXPECT_TRUE(contains(refused("d.vti", compressed), "has 7 numbers, but needs 8"));
}

TEST_F(VtkFill, TextHasNumbersOfItsType) {
  const auto with = [&](const std::string& type, const std::string& values) {
    VtkPiece piece;
    piece.has_points = false;
    piece.has_cells = true;
    std::string rest;
    for (int i = 0; i < 58; ++i) rest += " 5";
    piece.cells = xml_array(type, "c", values + rest);
    return vtk_grid("ImageData", {piece});
  };
  for (const auto& [type, word] :
       {std::pair{"UInt8", "300"}, std::pair{"UInt8", "-1"}, std::pair{"Int8", "128"},
        std::pair{"Int16", "2.5"}, std::pair{"Int32", "3e2"}, std::pair{"UInt32", "x"},
        std::pair{"Float32", "1,2"}, std::pair{"Float64", "--5"}, std::pair{"Float32", "none"}}) {
    const std::string error = refused("a.vti", with(type, std::string("1 ") + word));
    if (word != std::string("1,2")) {
      EXPECT_TRUE(contains(error, "has 1 numbers before \"" + std::string(word) + "\"")) << error;
    }
  }
  const Volume volume = read_volume(write("a.vti", with("Float32", "nan -NaN")));
  EXPECT_EQ(volume.statistics().nan, 2U);
  EXPECT_EQ(test::value_at(read_volume(write("b.vti", with("UInt8", "+7 255"))), 1, 0, 0), 255);
}

TEST_F(VtkFill, OtherArraysMayBeDamaged) {
  VtkPiece piece;
  piece.points = xml_array("Int16", "v", vtk_values(piece.extent)) + xml_array("Int16", "w", "1 2");
  expect_all(write("a.vti", vtk_grid("ImageData", {piece})));
  ReadOptions options;
  options.array = "w";
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.vti"), options); }), "has 2 numbers"));
}

TEST_F(VtkFill, AbsurdNumbersEndAtOnce) {
  std::string mesh = test::small_vtu();
  mesh.replace(mesh.find("NumberOfComponents=\"3\""), 22, "NumberOfComponents=\"4294967296\"");
  EXPECT_TRUE(contains(refused("a.vtu", mesh), "NumberOfComponents \"4294967296\""));
}

}  // namespace
}  // namespace pellucid::test_vtk_fill

#endif
