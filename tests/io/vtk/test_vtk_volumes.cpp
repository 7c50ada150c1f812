// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh_files.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "src/io/volumes/volume_axes.h"
#include "tests/io/volume_files.h"
#include "tests/support/test_data.h"

namespace pellucid::test_vtk_volumes {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::world_of;

std::string numbers(int count, int first = 0) {
  std::string text;
  for (int i = first; i < first + count; ++i) text += std::to_string(i) + " ";
  return text;
}

/// A legacy image of 5 x 4 x 3 points, and what stands behind its grid.
std::string legacy(const std::string& data, const std::string& coding = "ASCII") {
  return "# vtk DataFile Version 3.0\nby hand\n" + coding +
         "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 3\nORIGIN 1 2 -3\nSPACING 0.5 1 2\n" + data;
}

std::string scalars(const std::string& type, const std::string& values,
                    const std::string& name = "a") {
  return "SCALARS " + name + " " + type + " 1\nLOOKUP_TABLE default\n" + values + "\n";
}

/// An XML image; the extent is that of 5 x 4 x 3 points.
struct XmlImage {
  std::string extent = "0 4 0 3 0 2", origin = "1 2 -3", spacing = "0.5 1 2", more;
  std::string points, cells;  ///< arrays

  std::string text(const std::string& kind = "ImageData") const {
    return test::xml_file(kind, "<" + kind + " WholeExtent=\"" + extent + "\" Origin=\"" + origin +
                                    "\" Spacing=\"" + spacing + "\"" + more +
                                    ">\n<Piece Extent=\"" + extent + "\">\n<PointData>" + points +
                                    "</PointData>\n<CellData>" + cells +
                                    "</CellData>\n</Piece>\n</" + kind + ">\n");
  }
};

class VtkVolumes : public test::ScratchFolder {
 protected:
  Volume parse(const std::string& bytes, const std::string& array = "",
               const std::string& name = "a.vtk") const {
    ReadOptions options;
    if (!array.empty()) options.array = array;
    return read_volume(write(name, bytes), options);
  }
  std::string refused(const std::string& bytes, const std::string& array = "",
                      const std::string& name = "a.vtk") const {
    const std::string error = error_of([&] { parse(bytes, array, name); });
    EXPECT_TRUE(error.starts_with(path(name).string() + ": ")) << error;
    return error;
  }
};

// VTK takes its defaults for places that it cannot read.
TEST_F(VtkVolumes, PlacesOfXmlImagesMustBeNumbers) {
  const auto refusal = [&](const std::string& origin, const std::string& spacing,
                           const std::string& more = "") {
    XmlImage image;
    image.origin = origin;
    image.spacing = spacing;
    image.more = more;
    image.points = test::xml_array("Float64", "p", numbers(60));
    return error_of([&] { parse(image.text(), "", "a.vti"); });
  };
  for (const char* spacing : {"2,3,4", "0,5 1 1", "2 3", "nan 1 1", "2mm 3mm 4mm", "1 2 3 4"}) {
    const std::string error = refusal("0 0 0", spacing);
    EXPECT_TRUE(contains(error, "its Spacing is \"" + std::string(spacing) + "\"")) << error;
  }
  EXPECT_TRUE(contains(refusal("inf 0 0", "1 1 1"), "its Origin is"));
  EXPECT_TRUE(contains(refusal("5 6", "1 1 1"), "its Origin is"));
  EXPECT_TRUE(contains(refusal("0 0 0", "1 1 1", " Direction=\"1 0 0 0 1 0\""), "Direction"));
}

TEST_F(VtkVolumes, AreToldFromMeshesByTheirFirstBytes) {
  EXPECT_FALSE(is_mesh_file(write("image.vtk", legacy(""))));
  EXPECT_FALSE(is_mesh_file(write("nameless", legacy(""))));
  EXPECT_FALSE(is_mesh_file(write("image.xml", XmlImage{}.text())));
  EXPECT_FALSE(is_mesh_file(write("grid.xml", XmlImage{}.text("RectilinearGrid"))));
  EXPECT_FALSE(is_mesh_file(write("pieces", XmlImage{}.text("PImageData"))));
  EXPECT_TRUE(is_mesh_file(write("mesh.vtk", test::small_vtk())));
  EXPECT_TRUE(is_mesh_file(write("curved.vtk", test::small_structured_vtk())));
  EXPECT_TRUE(is_mesh_file(write("mesh.vti", test::small_vtu())));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("mesh.vtk")); }), "is a mesh"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("mesh.vti")); }), "is a mesh"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("none.vti")); }), "none.vti"));
}

TEST_F(VtkVolumes, ArraysAreRefusedWhereTheyHaveNoNames) {
  ReadOptions options;
  options.array = "a";
  options.dimensions = {5, 4, 3};
  options.type = "f32";
  const fs::path raw = write("a.raw", test::bytes_of(counting()));
  EXPECT_TRUE(contains(error_of([&] { read_volume(raw, options); }), "no arrays"));
  EXPECT_TRUE(list_arrays(raw, options).empty());
}

#ifdef PELLUCID_HAVE_VTK

TEST_F(VtkVolumes, LegacyTextOfEveryType) {
  const std::pair<const char*, const char*> types[] = {
      {"unsigned_char", "u8"}, {"char", "i8"},   {"unsigned_short", "u16"}, {"short", "i16"},
      {"unsigned_int", "u32"}, {"int", "i32"},   {"unsigned_long", "u8"},   {"long", "u8"},
      {"vtktypeint64", "u8"},  {"float", "f32"}, {"double", "f64"}};
  for (const auto& [vtk, type] : types) {
    SCOPED_TRACE(vtk);
    expect_counting(parse(legacy("POINT_DATA 60\n" + scalars(vtk, numbers(60)))), type);
  }
  std::string bits;
  for (int i = 0; i < 60; ++i) bits += std::to_string(i % 7 == 2) + " ";
  const Volume volume = parse(legacy("POINT_DATA 60\n" + scalars("bit", bits)));
  EXPECT_EQ(type_name(volume.data()), "u8");
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(test::value_at(volume, i % 5, i / 5 % 4, i / 20), i % 7 == 2);
  }
}

TEST_F(VtkVolumes, LegacyBinaryIsBigEndian) {
  const auto expect = [&](auto value, const std::string& vtk, const std::string& type) {
    SCOPED_TRACE(type);
    const auto values = counting<decltype(value)>();
    const std::string bytes = std::endian::native == std::endian::little
                                  ? test::swapped_bytes_of(values)
                                  : test::bytes_of(values);
    expect_counting(parse(legacy("POINT_DATA 60\n" + scalars(vtk, bytes), "BINARY")), type);
  };
  expect(std::uint8_t{}, "unsigned_char", "u8");
  expect(std::uint16_t{}, "unsigned_short", "u16");
  expect(std::int16_t{}, "short", "i16");
  expect(std::int32_t{}, "int", "i32");
  expect(std::int64_t{}, "long", "u8");
  expect(0.F, "float", "f32");
  expect(0., "double", "f64");
}

TEST_F(VtkVolumes, PointsStandAtTheOriginAndCellsHalfOfOneFurther) {
  const std::string both = "POINT_DATA 60\n" + scalars("float", numbers(60)) + "CELL_DATA 24\n" +
                           scalars("int", numbers(24), "c");
  const Volume points = parse(legacy(both));
  EXPECT_EQ(points.description().centering, Centering::point);
  expect_near(world_of(points, 0, 0, 0), {1, 2, -3}, 0);
  expect_near(world_of(points, 4, 3, 2), {3, 5, 1}, 0);
  const Volume cells = parse(legacy(both), "c");
  EXPECT_EQ(cells.description().centering, Centering::cell);
  EXPECT_EQ(cells.description().dimensions, (std::array<int, 3>{4, 3, 2}));
  expect_near(world_of(cells, 0, 0, 0), {1.25, 2.5, -2}, 0);
  EXPECT_EQ(type_name(cells.data()), "i32");
  EXPECT_EQ(test::value_at(cells, 3, 2, 1), 23);
  // The box of the cells is that of the points.
  EXPECT_EQ(cells.world_corners(), points.world_corners());
  ReadOptions options;
  options.spacing = {2, 2, 2};
  options.origin = {7, 8, 9};
  expect_near(world_of(read_volume(path("a.vtk"), options), 1, 1, 1), {9, 10, 11}, 0);
}

TEST_F(VtkVolumes, ChooseAmongArrays) {
  const std::string file =
      legacy("POINT_DATA 60\nVECTORS v float\n" + numbers(180) + "\n" +
             scalars("short", numbers(60), "b") + scalars("short", numbers(60, 100), "a") +
             "FIELD more 1\nf 2 60 double\n" + numbers(120) + "\nCELL_DATA 24\n" +
             scalars("float", numbers(24), "b"));
  const std::vector<VolumeArray> arrays = list_arrays(write("a.vtk", file));
  std::string text;
  for (const VolumeArray& array : arrays) {
    text += array.name + " " + array.type + " " + std::to_string(array.components.size()) + " " +
            (array.centering == Centering::cell ? "cell " : "") +
            (array.is_default ? "shown " : "") + std::to_string(array.components.front().maximum) +
            "\n";
  }
  for (const char* line :
       {"b i16 1 ", "a i16 1 ", "v f32 3 177.0", "f f64 2 118.0", "b_cell f32 1 cell 23.0"}) {
    EXPECT_TRUE(contains(text, line)) << line << " is not in\n" << text;
  }
  EXPECT_EQ(arrays.size(), 5u);
  EXPECT_EQ(std::ranges::count_if(arrays, [](const auto& a) { return a.is_default; }), 1);
  expect_counting(parse(file, "b"), "i16");
  EXPECT_EQ(test::value_at(parse(file, "a"), 0, 0, 0), 100);
  EXPECT_EQ(parse(file, "b_cell").description().centering, Centering::cell);
  const std::string missing = refused(file, "nothing");
  EXPECT_TRUE(contains(missing, "\"nothing\"") && contains(missing, "b_cell")) << missing;
  EXPECT_TRUE(contains(refused(file, "v"), "3 components (array \"v\")"));
  ReadOptions options;
  options.array = "v";
  const std::vector<Volume> vectors = read_components(path("a.vtk"), options);
  ASSERT_EQ(vectors.size(), 3u);
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < 60; ++i) {
      ASSERT_EQ(test::value_at(vectors[static_cast<std::size_t>(c)], i % 5, i / 5 % 4, i / 20),
                3 * i + c);
    }
  }
  options.component = 2;
  EXPECT_EQ(test::value_at(read_volume(path("a.vtk"), options), 0, 0, 0), 2);
  EXPECT_EQ(read_named_components(path("a.vtk"), options).array, "v");
}

/// Of 3 x 2 x 2 points.
std::string rectilinear(const std::string& x, const std::string& data,
                        const std::string& type = "float") {
  return "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET RECTILINEAR_GRID\n"
         "DIMENSIONS 3 2 2\nX_COORDINATES 3 " +
         type + "\n" + x + "\nY_COORDINATES 2 " + type + "\n-1 4\nZ_COORDINATES 2 " + type +
         "\n0 2\n" + data;
}

TEST_F(VtkVolumes, RectilinearGridsOfOneDistanceAreUniform) {
  const std::string values = "POINT_DATA 12\n" + scalars("float", numbers(12));
  // 0.1, 0.3, 0.5 are not at one distance in binary32, but as far as it can tell.
  const Volume volume = parse(rectilinear("0.1 0.3 0.5", values));
  EXPECT_TRUE(volume.description().coordinates[0].empty());
  expect_near(volume.description().placement.spacing, {0.2, 5, 2}, 1e-7);
  expect_near(world_of(volume, 2, 1, 1), {0.5, 4, 2}, 1e-7);
  EXPECT_TRUE(
      parse(rectilinear("1000.1 1000.2 1000.3", values)).description().coordinates[0].empty());
  EXPECT_FALSE(parse(rectilinear("1000.1 1000.2 1000.3001", values, "double"))
                   .description()
                   .coordinates[0]
                   .empty());
  const Volume cells = parse(rectilinear("0 1 2", "CELL_DATA 2\n" + scalars("float", "7 8")));
  EXPECT_EQ(cells.description().dimensions, (std::array<int, 3>{2, 1, 1}));
  expect_near(world_of(cells, 1, 0, 0), {1.5, 1.5, 1}, 0);
  // In double they are told apart.
  EXPECT_FALSE(parse(rectilinear("0.1 0.3 0.500001", values, "double"))
                   .description()
                   .coordinates[0]
                   .empty());
}

TEST_F(VtkVolumes, RectilinearGridsKeepTheirPositions) {
  const std::string values = "POINT_DATA 12\n" + scalars("float", numbers(12));
  const Volume volume = parse(rectilinear("0 1 4", values));
  EXPECT_EQ(volume.description().coordinates[0], (std::vector<double>{0, 1, 4}));
  EXPECT_TRUE(volume.description().coordinates[1].empty());
  const auto corners = volume.world_corners();
  expect_near(corners[0], {0, -1, 0}, 0);
  expect_near(corners[7], {4, 4, 2}, 0);
  const Volume cells = parse(rectilinear("0 1 4", "CELL_DATA 2\n" + scalars("float", "7 8")));
  EXPECT_EQ(cells.description().coordinates[0], (std::vector<double>{0, 1, 4}));
  EXPECT_EQ(cells.world_corners(), corners);
  // Descending: the axis is turned round, and the first value stays at 4.
  const Volume turned = parse(rectilinear("4 1 0", values));
  EXPECT_EQ(turned.description().coordinates[0], (std::vector<double>{-4, -1, 0}));
  expect_near(turned.world_from_grid().point(turned.grid_lower()), {4, -1, 0}, 0);
  EXPECT_TRUE(contains(refused(rectilinear("0 1 1", values)), "one direction at number 2"));
  Volume::Description description;
  EXPECT_TRUE(contains(error_of([&] {
                         place_axis(description, 0, {0, std::nan(""), 1}, 0);
                       }),
                       "not all finite"));
  ReadOptions options;
  options.spacing = {1, 1, 1};
  const fs::path file = write("a.vtk", rectilinear("0 1 4", values));
  EXPECT_TRUE(contains(error_of([&] { read_volume(file, options); }), "leave the spacing out"));
}

TEST_F(VtkVolumes, XmlImages) {
  XmlImage image;
  image.points = test::xml_array("UInt16", "p", numbers(60)) +
                 test::xml_array("Float32", "v", numbers(180), 3);
  image.cells = test::xml_array("Int64", "c", numbers(24));
  const Volume points = parse(image.text(), "p", "a.vti");
  expect_counting(points, "u16");
  expect_near(world_of(points, 4, 3, 2), {3, 5, 1}, 0);
  // No scalars are marked: the first of points with one component.
  expect_counting(parse(image.text(), "", "a.vti"), "u16");
  const Volume cells = parse(image.text(), "c", "a.vti");
  EXPECT_EQ(type_name(cells.data()), "u8");
  expect_near(world_of(cells, 0, 0, 0), {1.25, 2.5, -2}, 0);
  ReadOptions options;
  options.array = "v";
  options.component = 1;
  EXPECT_EQ(test::value_at(read_volume(path("a.vti"), options), 1, 0, 0), 4);
  EXPECT_EQ(list_arrays(path("a.vti")).size(), 3u);
}

TEST_F(VtkVolumes, AnExtentNeedNotBeginAtZero) {
  XmlImage image;
  image.extent = "10 14 -2 1 0 2";
  image.points = test::xml_array("Float64", "p", numbers(60));
  const Volume volume = parse(image.text(), "", "a.vti");
  expect_counting(volume, "f64");
  expect_near(world_of(volume, 0, 0, 0), {6, 0, -3}, 0);
  expect_near(world_of(volume, 4, 3, 2), {8, 3, 1}, 0);
}

TEST_F(VtkVolumes, DirectionsAreTheColumnsOfTheMatrix) {
  XmlImage image;
  // x goes to y, y to -x, z stays.
  image.more = " Direction=\"0 -1 0 1 0 0 0 0 1\"";
  image.extent = "0 4 0 3 1 3";
  image.points = test::xml_array("Float64", "p", numbers(60));
  image.cells = test::xml_array("Float64", "c", numbers(24));
  const Volume volume = parse(image.text(), "", "a.vti");
  expect_near(world_of(volume, 0, 0, 0), {1, 2, -1}, 0);
  expect_near(world_of(volume, 2, 0, 0), {1, 3, -1}, 0);
  expect_near(world_of(volume, 0, 3, 0), {-2, 2, -1}, 0);
  EXPECT_EQ(parse(image.text(), "c", "a.vti").world_corners(), volume.world_corners());
}

TEST_F(VtkVolumes, LegacyFilesOfFewBytesHaveFewPoints) {
  const std::string error = refused(
      "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 100 100 "
      "100\n"
      "ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 1000000\n" +
      scalars("float", numbers(60)));
  EXPECT_TRUE(contains(error, "1000000 points, which its")) << error;
}

TEST_F(VtkVolumes, ANegativeSpacingTurnsTheAxis) {
  XmlImage image;
  image.spacing = "0.5 -1 2";
  image.points = test::xml_array("Float64", "p", numbers(60));
  const Volume volume = parse(image.text(), "", "a.vti");
  EXPECT_EQ(volume.description().placement.spacing.y, 1);
  expect_near(world_of(volume, 0, 0, 0), {1, 2, -3}, 0);
  expect_near(world_of(volume, 4, 3, 2), {3, -1, 1}, 0);
}

TEST_F(VtkVolumes, AppendedBytesOfBothOrders) {
  const auto values = counting<std::int16_t>();
  for (const bool big : {false, true}) {
    const bool swapped = big == (std::endian::native == std::endian::little);
    const std::vector<std::uint64_t> size{120};
    const std::string file =
        std::string("<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"") +
        (big ? "BigEndian" : "LittleEndian") +
        "\" header_type=\"UInt64\"><ImageData WholeExtent=\"0 4 0 3 0 2\" Origin=\"0 0 0\" "
        "Spacing=\"1 1 1\"><Piece Extent=\"0 4 0 3 0 2\"><PointData><DataArray type=\"Int16\" "
        "Name=\"p\" format=\"appended\" offset=\"0\"/></PointData></Piece></ImageData>"
        "<AppendedData encoding=\"raw\">_" +
        (swapped ? test::swapped_bytes_of(size) : test::bytes_of(size)) +
        (swapped ? test::swapped_bytes_of(values) : test::bytes_of(values)) +
        "</AppendedData></VTKFile>";
    expect_counting(parse(file, "", "a.vti"), "i16");
    // Cut off anywhere.
    for (std::size_t length = 0; length < file.size() - 1; length += 37) {
      SCOPED_TRACE(length);
      refused(file.substr(0, length), "", "a.vti");
    }
  }
}

TEST_F(VtkVolumes, PiecesAreJoined) {
  XmlImage left, right;
  left.extent = "0 2 0 3 0 2";
  right.extent = "2 4 0 3 0 2";
  std::string values[2];
  for (int i = 0; i < 60; ++i) {
    if (i % 5 <= 2) values[0] += std::to_string(i) + " ";
    if (i % 5 >= 2) values[1] += std::to_string(i) + " ";
  }
  left.points = test::xml_array("Float32", "p", values[0]);
  right.points = test::xml_array("Float32", "p", values[1]);
  write("l.vti", left.text());
  write("r.vti", right.text());
  const std::string whole = test::xml_file(
      "PImageData",
      "<PImageData WholeExtent=\"0 4 0 3 0 2\" Origin=\"1 2 -3\" Spacing=\"0.5 1 2\">"
      "<PPointData><PDataArray type=\"Float32\" Name=\"p\"/></PPointData>"
      "<Piece Extent=\"0 2 0 3 0 2\" Source=\"l.vti\"/>"
      "<Piece Extent=\"2 4 0 3 0 2\" Source=\"r.vti\"/></PImageData>");
  const Volume volume = parse(whole, "", "a.pvti");
  expect_counting(volume, "f32");
  expect_near(world_of(volume, 4, 3, 2), {3, 5, 1}, 0);
  const std::string piece = read(path("r.vti"));
  write("r.vti", piece.substr(0, piece.size() - 12));
  EXPECT_TRUE(contains(refused(whole, "", "a.pvti"), "its part r.vti is cut off"));
  fs::remove(path("r.vti"));
  refused(whole, "", "a.pvti");
}

TEST_F(VtkVolumes, WhatIsHiddenIsNan) {
  XmlImage image;
  std::string hidden;
  for (int i = 0; i < 60; ++i) hidden += i == 7 ? "2 " : i == 8 ? "1 " : "0 ";
  image.points =
      test::xml_array("UInt8", "p", numbers(60)) + test::xml_array("UInt8", "vtkGhostType", hidden);
  image.cells = test::xml_array("Int32", "c", numbers(24));
  const Volume points = parse(image.text(), "p", "a.vti");
  EXPECT_EQ(type_name(points.data()), "f32");
  EXPECT_TRUE(std::isnan(test::value_at(points, 2, 1, 0)));
  EXPECT_EQ(points.statistics().nan, 1u);
  EXPECT_EQ(test::value_at(points, 3, 1, 0), 8);  // a duplicate is no ghost in one file
  // The cells around the point (2, 1, 0).
  const Volume cells = parse(image.text(), "c", "a.vti");
  EXPECT_EQ(type_name(cells.data()), "f64");
  EXPECT_EQ(cells.statistics().nan, 4u);
  for (const int i : {1, 2}) {
    for (const int j : {0, 1}) EXPECT_TRUE(std::isnan(test::value_at(cells, i, j, 0)));
  }
  XmlImage cells_hidden;
  cells_hidden.points = test::xml_array("UInt8", "p", numbers(60));
  const auto hide_cell = [&](int hidden_one) {
    std::string of_cells;
    for (int i = 0; i < 24; ++i) of_cells += i == hidden_one ? "32 " : "0 ";
    cells_hidden.cells = test::xml_array("UInt8", "vtkGhostType", of_cells) +
                         test::xml_array("Float32", "c", numbers(24));
  };
  // Of 4 x 3 x 2 cells one at a corner has a point of its own, one at an edge has none.
  hide_cell(1);
  EXPECT_TRUE(contains(refused(cells_hidden.text(), "p", "a.vti"), "hides cells between others"));
  EXPECT_TRUE(std::isnan(test::value_at(parse(cells_hidden.text(), "c", "a.vti"), 1, 0, 0)));
  hide_cell(0);
  EXPECT_TRUE(std::isnan(test::value_at(parse(cells_hidden.text(), "c", "a.vti"), 0, 0, 0)));
  const Volume corner = parse(cells_hidden.text(), "p", "a.vti");
  EXPECT_TRUE(std::isnan(test::value_at(corner, 0, 0, 0)));
  EXPECT_EQ(corner.statistics().nan, 1u);
  EXPECT_EQ(list_arrays(path("a.vti")).size(), 2u);
}

TEST_F(VtkVolumes, RefusesWhatIsNoVolume) {
  XmlImage flat;
  flat.extent = "0 4 0 3 0 0";
  flat.points = test::xml_array("Float32", "p", numbers(20));
  EXPECT_TRUE(contains(refused(flat.text(), "", "a.vti"), "flat along z"));
  EXPECT_TRUE(contains(refused(XmlImage{}.text(), "", "a.vti"), "no array"));
  EXPECT_TRUE(contains(refused(legacy("")), "no array"));
  XmlImage zero;
  zero.spacing = "0 1 1";
  zero.points = test::xml_array("Float32", "p", numbers(60));
  EXPECT_TRUE(contains(refused(zero.text(), "", "a.vti"), "spacing"));
  refused("not VTK's at all", "", "a.vti");
  refused("", "", "a.vti");
}

TEST_F(VtkVolumes, RefusesSizesThatCannotBe) {
  const std::string values = "POINT_DATA 60\n" + scalars("float", numbers(60));
  for (const char* sides : {"2000000000 2000000000 2000000000", "100000 1000 1000", "-5 4 3",
                            "0 4 3", "5 4", "5 4 3000"}) {
    SCOPED_TRACE(sides);
    std::string file = legacy(values);
    refused(file.replace(file.find("5 4 3"), 5, sides));
  }
  for (const char* extent : {"0 2000000000 0 2000000000 0 2000000000", "0 100000 0 99999 0 9999",
                             "0 -1 0 -1 0 -1", "4 0 0 3 0 2", "0 4 0 3", "0 4 0 3 0 200"}) {
    SCOPED_TRACE(extent);
    XmlImage image;
    image.extent = extent;
    image.points = test::xml_array("Float32", "p", numbers(60));
    refused(image.text(), "", "a.vti");
  }
  // Infinite values, as everywhere.
  std::string infinite = legacy(values);
  refused(infinite.replace(infinite.find(" 59 "), 4, " inf "));
}

TEST_F(VtkVolumes, CutOffIsAnError) {
  const std::string file = legacy("POINT_DATA 60\n" + scalars("float", numbers(60)));
  for (std::size_t length = 0; length < file.size() - 4; length += 11) {
    SCOPED_TRACE(length);
    refused(file.substr(0, length));
  }
}

TEST_F(VtkVolumes, RealFiles) {
  struct Known {
    const char* file;
    std::array<int, 3> dimensions;
    Vec3<double> spacing;
    const char* type;
    std::size_t components;
    double minimum, maximum;
    const char* array;
  };
  const Known files[] = {
      {"structured/hydrogen.vti", {64, 64, 64}, {1, 1, 1}, "f32", 1, 0, 1, "probability_density"},
      {"structured/isabel_30.vti",
       {125, 125, 25},
       {4.0080321286, 4.0080321286, 4.0408163266},
       "f64",
       1,
       0,
       78.6594,
       "velocityMag"},
      {"structured/ironProt.vtk", {68, 68, 68}, {1, 1, 1}, "u8", 1, 0, 255, "scalars"},
      {"multivariate/carotid.vtk", {76, 49, 45}, {1, 1, 1}, "f32", 1, 0, 580, "scalars"},
      {"multivariate/vase_4comp.vti", {115, 101, 75}, {1, 1, 1}, "u8", 4, 0, 239, "Scalars_"},
      {"structured/RectGrid2.vtk", {47, 33, 11}, {1, 1, 1}, "f32", 1, 0, 10.3964, "scalars"}};
  for (const Known& known : files) {
    SCOPED_TRACE(known.file);
    const fs::path file = test_data_folder() / known.file;
    if (!fs::exists(file)) GTEST_SKIP() << file.string() << " not found";
    const NamedComponents read = read_named_components(file);
    EXPECT_EQ(read.array, known.array);
    ASSERT_EQ(read.components.size(), known.components);
    double maximum = 0;
    for (const Volume& volume : read.components) {
      EXPECT_EQ(volume.description().dimensions, known.dimensions);
      EXPECT_EQ(type_name(volume.data()), known.type);
      EXPECT_EQ(volume.statistics().minimum, known.minimum);
      maximum = std::max(maximum, volume.statistics().maximum);
    }
    EXPECT_NEAR(maximum, known.maximum, 1e-4);
    if (read.components.front().description().coordinates[0].empty()) {
      expect_near(read.components.front().description().placement.spacing, known.spacing, 1e-12);
    }
  }
}

#endif

}  // namespace
}  // namespace pellucid::test_vtk_volumes
