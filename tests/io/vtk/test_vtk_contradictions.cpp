// SPDX-License-Identifier: Apache-2.0
//
// Files of VTK's that contradict themselves: VTK reads them, and shows something else.
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "mesh_files.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/noting_folder.h"
#include "tests/io/volume_files.h"
#include "vtk_pieces.h"

#ifdef PELLUCID_HAVE_VTK

namespace pellucid::test_vtk_contradictions {
namespace {

namespace fs = std::filesystem;

using test::bytes_of;
using test::contains;
using test::error_of;
using test::value_at;
using test::vtk_grid;
using test::vtk_list;
using test::VtkPiece;
using test::xml_array;
using test::xml_file;

/// An image of 2 x 2 x 2 points.
std::string image(const std::string& arrays, const std::string& attributes = "",
                  const std::string& appended = "", const std::string& of_image = "") {
  return "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" " + attributes +
         "><ImageData WholeExtent=\"0 1 0 1 0 1\" Origin=\"0 0 0\" Spacing=\"1 1 1\" " + of_image +
         "><Piece Extent=\"0 1 0 1 0 1\"><PointData>" + arrays +
         "</PointData></Piece></ImageData>" + appended + "</VTKFile>";
}

/// The values 1 to 8, or as many, in Float32.
std::string floats(int count = 8, float first = 1) {
  std::vector<float> values;
  for (int i = 0; i < count; ++i) values.push_back(first + static_cast<float>(i));
  return bytes_of(values);
}

template <class Header>
std::string block(const std::string& bytes) {
  return bytes_of(std::vector<Header>{static_cast<Header>(bytes.size())}) + bytes;
}

std::string base64(const std::string& bytes) {
  constexpr const char* letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t at) {
      return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0U;
    };
    const unsigned bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (unsigned n = 0; n < 4; ++n) {
      text += i + n > bytes.size() ? '=' : letters[bits >> (18 - 6 * n) & 63];
    }
  }
  return text;
}

std::string appended(const std::string& bytes, const std::string& encoding = "raw") {
  return "<AppendedData encoding=\"" + encoding + "\">\n _" + bytes + "\n  </AppendedData>";
}

std::string at(const std::string& offset, const std::string& name = "v",
               const std::string& more = "") {
  return "<DataArray type=\"Float32\" Name=\"" + name + "\" " + more +
         " format=\"appended\" offset=\"" + offset + "\"/>";
}

std::string inlined(const std::string& text) {
  return "<DataArray type=\"Float32\" Name=\"v\" format=\"binary\">\n  " + text + "\n</DataArray>";
}

class VtkContradictions : public test::NotingFolder {
 protected:
  std::string refused_text(const std::string& name, const std::string& text) const {
    const fs::path file = write(name, text);
    const std::string error = error_of([&] {
      if (is_mesh_file(file)) {
        read_mesh(file);
      } else {
        read_volume(file);
      }
    });
    EXPECT_TRUE(error.starts_with(file.string() + ": ")) << error;
    EXPECT_EQ(error.find('\n'), error.npos) << error;
    return error;
  }
  void expect_counting(const std::string& text, const ReadOptions& options = {}) const {
    const Volume volume = read_volume(write("good.vti", text), options);
    for (int i = 0; i < 8; ++i) EXPECT_EQ(value_at(volume, i % 2, i / 2 % 2, i / 4), 1 + i) << i;
  }
};

// What is read as a header of 32 bits leaves the rest of it in front of the values.
TEST_F(VtkContradictions, HeadersHaveTheBitsThatHeaderTypeSays) {
  using Narrow = std::uint32_t;
  using Wide = std::uint64_t;
  const std::string wide = "header_type=\"UInt64\"", narrow = "header_type=\"UInt32\"";
  const std::string good = block<Narrow>(floats()), other = block<Wide>(floats());
  for (const std::string& said : {std::string(), narrow}) {
    for (const std::string& bad :
         {image(inlined(base64(other)), said), image(at("0"), said, appended(other)),
          image(inlined(base64(other.substr(0, 8)) + base64(floats())), said),
          image(at("0"), said, appended(base64(other), "base64")),
          image(at("0") + at("40", "w"), said, appended(other + other)),
          image(at("0") + at("56", "w"), said,
                appended(base64(other) + base64(other), "base64"))}) {
      const std::string error = refused_text("a.vti", bad);
      EXPECT_TRUE(contains(error, "have 64 bits")) << error;
      EXPECT_TRUE(contains(error, "header_type=\"UInt64\"")) << error;
    }
  }
  // Zeros in front, which the other way round are the rest of a header.
  const std::string zero = block<Narrow>(floats(8, 0));
  EXPECT_TRUE(contains(refused_text("a.vti", image(inlined(base64(zero)), wide)), "have 32 bits"));
  EXPECT_TRUE(contains(
      refused_text("a.vti", image(at("0") + at("36", "w"), wide, appended(zero + zero))), "32"));
  for (const std::string& right :
       {image(inlined(base64(good))), image(inlined(base64(good)), narrow),
        image(inlined(base64(good.substr(0, 4)) + base64(floats()))),
        image(inlined(base64(other)), wide), image(at("0"), wide, appended(other)),
        image(at("0"), "", appended(good)), image(at("0"), "", appended(base64(good), "base64")),
        image(at("0") + at("36", "w"), "", appended(good + good)),
        image(at("0") + at("0", "w"), "", appended(good)),
        // With room between arrays.
        image(at("4") + at("44", "w"), "", appended("0000" + good + "0000" + good + "0000"))}) {
    ReadOptions options;
    options.array = "v";
    expect_counting(right, options);
  }
  // Of an empty array first, and of meshes.
  std::string mesh = test::small_vtu();
  const std::string values = "format=\"ascii\">0 1 2 3 4<";
  mesh.replace(mesh.find(values), values.size(),
               "format=\"binary\">" + base64(block<Wide>(floats(5))) + "<");
  EXPECT_TRUE(contains(refused_text("a.vtu", mesh), "have 64 bits"));
}

// The number of bytes is a large one in the other order, and there are as many as needed.
TEST_F(VtkContradictions, BytesHaveTheOrderThatByteOrderSays) {
  const std::string bytes = block<std::uint32_t>(floats());
  for (const std::string& file :
       {image(at("0"), "", appended(bytes)), image(inlined(base64(bytes))),
        image(at("0"), "", appended(base64(bytes), "base64"))}) {
    expect_counting(file);
    std::string other = file;
    other.replace(other.find("LittleEndian"), 12, "BigEndian");
    EXPECT_TRUE(contains(refused_text("a.vti", other), "its byte_order is wrong"));
  }
}

TEST_F(VtkContradictions, CompressedHeadersToo) {
  const std::string packed = test::deflated(floats(), 15);
  const auto file = [&](const std::string& header, const std::string& type) {
    return image(at("0"), "compressor=\"vtkZLibDataCompressor\" header_type=\"" + type + "\"",
                 appended(header + packed));
  };
  const auto size = static_cast<std::uint32_t>(packed.size());
  const std::string narrow = bytes_of(std::vector<std::uint32_t>{1, 32, 0, size});
  const std::string wide = bytes_of(std::vector<std::uint64_t>{1, 32, 0, size});
  expect_counting(file(narrow, "UInt32"));
  expect_counting(file(wide, "UInt64"));
  EXPECT_TRUE(contains(refused_text("a.vti", file(wide, "UInt32")), "have 64 bits"));
  EXPECT_TRUE(contains(refused_text("a.vti", file(narrow, "UInt64")), "have 32 bits"));
}

TEST_F(VtkContradictions, OffsetsLieWithinWhatIsAppended) {
  const std::string bytes = appended(block<std::uint32_t>(floats()));
  for (const std::string offset : {"-4", "-1", "0x", "abc", "1e3", "4 4", "100000", "37.5"}) {
    const std::string error = refused_text("a.vti", image(at(offset), "", bytes));
    EXPECT_TRUE(contains(error, "the array \"v\" of points has the offset \"" + offset)) << error;
  }
  const std::string none = "<DataArray type=\"Float32\" Name=\"v\" format=\"appended\"/>";
  EXPECT_TRUE(contains(refused_text("a.vti", image(none, "", bytes)), "has no offset"));
  EXPECT_TRUE(contains(refused_text("a.vti", image(at("0"))), "has no AppendedData"));
  const std::string format =
      "<DataArray type=\"Float32\" Name=\"v\" format=\"Binary\">1</DataArray>";
  EXPECT_TRUE(contains(refused_text("a.vti", image(format)), "has the format \"Binary\""));
  expect_counting(image(at(" 0 "), "", bytes));
  // VTK goes by the offset, whatever the format.
  const std::string bare = "<DataArray type=\"Float32\" Name=\"v\" format=\"ascii\" offset=\"0\">";
  expect_counting(image(bare + "\n</DataArray>", "", bytes));
  EXPECT_TRUE(contains(refused_text("a.vti", image(bare + "9 9</DataArray>", "", bytes)),
                       "has an offset, and values of its own"));
  // Into another array, and behind the last.
  const std::string two = block<std::uint32_t>(floats()) + block<std::uint32_t>(floats());
  EXPECT_TRUE(contains(refused_text("b.vti", image(at("0") + at("20", "w"), "", appended(two))),
                       "has 4 numbers, but needs 8"));
  // An array that is not shown may be damaged.
  ReadOptions options;
  options.array = "v";
  expect_counting(image(at("0") + at("-4", "w"), "", bytes), options);
}

TEST_F(VtkContradictions, NamesAreThereOnce) {
  const std::string v = xml_array("Float32", "v", "1 2 3 4 5 6 7 8"),
                    again = xml_array("Float32", "v", "8 8 8 8 8 8 8 8"),
                    w = xml_array("Float32", "w", "9 9 9 9 9 9 9 9");
  EXPECT_TRUE(contains(refused_text("a.vti", image(v + again)),
                       "the array \"v\" of points is there 2 times"));
  ReadOptions options;
  options.array = "w";
  EXPECT_EQ(value_at(read_volume(write("b.vti", image(v + again + w)), options), 0, 0, 0), 9);
  // In meshes, and in lists of cells and points.
  test::SmallVtu of;
  of.more = xml_array("Int32", "id", "1 2 3");
  EXPECT_TRUE(contains(refused_text("a.vtu", test::small_vtu(of)), "of cells is there 2 times"));
  std::string mesh = test::small_vtu();
  mesh.insert(mesh.find("</Cells>"), xml_array("Int64", "offsets", "4 8 11"));
  EXPECT_TRUE(contains(refused_text("a.vtu", mesh), "list \"offsets\" of cells is there 2 times"));
  mesh = test::small_vtu();
  mesh.insert(mesh.find("</Points>"), xml_array("Float64", "Q", of.points, 3));
  EXPECT_TRUE(contains(refused_text("a.vtu", mesh), "the list of points is there 2 times"));
}

TEST_F(VtkContradictions, AttributesAreNumbers) {
  const std::string values = "1 2 3 4 5 6 7 8";
  for (const std::string components : {"-1", "x", "1.5", "99999999999"}) {
    const std::string error =
        refused_text("a.vti", image("<DataArray type=\"Float32\" Name=\"v\" NumberOfComponents=\"" +
                                    components + "\" format=\"ascii\">" + values + "</DataArray>"));
    EXPECT_TRUE(contains(error, "has the NumberOfComponents \"" + components)) << error;
  }
  for (const std::string count : {"-1", "5x", "1e1", "abc"}) {
    for (const std::string name : {"NumberOfPoints", "NumberOfCells"}) {
      std::string mesh = test::small_vtu();
      mesh.replace(mesh.find(name), name.size() + 4, name + "=\"" + count + "\"");
      EXPECT_TRUE(contains(refused_text("a.vtu", mesh), "a piece has the " + name + " \"" + count));
    }
  }
  for (const std::string name : {"", "Name=\"\""}) {
    const std::string error =
        refused_text("a.vti", image("<DataArray type=\"Float32\" " + name + " format=\"ascii\">" +
                                    values + "</DataArray>"));
    EXPECT_TRUE(contains(error, "an array of points has no name")) << error;
  }
  for (const auto& [word, text] :
       {std::pair{"1e400", ", which is no Float32"}, std::pair{"1e39", ", which is no Float32"},
        std::pair{"1.2.3", ", which is no Float32"}, std::pair{"Infinity", ", which is no Float32"},
        std::pair{"nan(ind)", ", which is no Float32"}, std::pair{"0x10", ", which is no Float32"},
        std::pair{"4-5", ", which is no Float32"}}) {
    const std::string all = "1 2 3 " + std::string(word) + " 5 6 7 8";
    const std::string error = refused_text("a.vti", image(xml_array("Float32", "v", all)));
    EXPECT_TRUE(contains(error, "has 3 numbers before \"" + std::string(word) + "\"" + text))
        << error;
  }
  const Volume volume =
      read_volume(write("b.vti", image(xml_array("Float32", "v", "1 2 +3 4.e0 .5E1 6 7 1e-60"))));
  EXPECT_EQ(value_at(volume, 0, 0, 1), 5);
  EXPECT_EQ(value_at(volume, 1, 1, 1), 0);
}

std::string step(const std::string& values, const std::string& number) {
  return "<DataArray type=\"Float32\" Name=\"v\" format=\"ascii\" TimeStep=\"" + number + "\">" +
         values + "</DataArray>";
}

TEST_F(VtkContradictions, StepsInTimeAreChosen) {
  const std::string first = "1 2 3 4 5 6 7 8", second = "2 2 2 2 2 2 2 9";
  const std::string times = "TimeValues=\"0&#10;2.5\"";
  const fs::path file = write("a.vti", image(step(first, "0") + step(second, "1"), "", "", times));
  EXPECT_EQ(value_at(components(file).front(), 1, 1, 1), 8);
  EXPECT_TRUE(is_noted("has 2 steps in time, from 0 to 2.5")) << notes();
  ReadOptions options;
  options.time = 2.4;
  EXPECT_EQ(value_at(components(file, options).front(), 1, 1, 1), 9);
  EXPECT_EQ(notes(), "");
  options.time = -7;
  EXPECT_EQ(value_at(components(file, options).front(), 1, 1, 1), 8);
  EXPECT_EQ(list_arrays(file).size(), 1U);
  // Appended, and only a part.
  const std::string bytes =
      appended(block<std::uint32_t>(floats()) + block<std::uint32_t>(floats(8, 11)));
  write("b.vti",
        image(at("0", "v", "TimeStep=\"0\"") + at("36", "v", "TimeStep=\"1\""), "", bytes, times));
  options.time = 2.5;
  options.part = [](const Volume::Description&) { return IndexBox{{0, 0, 0}, {2, 2, 2}}; };
  EXPECT_EQ(value_at(components(path("b.vti"), options).front(), 1, 1, 1), 18);
  // A step without values, or with two.
  EXPECT_TRUE(contains(refused_text("c.vti", image(step(first, "0"), "", "", times)),
                       "is not there for the step 1 in time"));
  EXPECT_TRUE(
      contains(refused_text("c.vti", image(step(first, "0 1") + step(second, "1"), "", "", times)),
               "is there 2 times for the step 1"));
  EXPECT_TRUE(contains(refused_text("c.vti", image(step(first, "0"), "", "", "TimeValues=\"x\"")),
                       "its TimeValues are \"x\""));
  // Files without steps.
  write("d.vti", image(xml_array("Float32", "v", first)));
  EXPECT_TRUE(contains(refused(path("d.vti"), options), "no steps in time"));
}

TEST_F(VtkContradictions, StepsOfMeshesAreKnownByTheirTimes) {
  std::string mesh = test::small_vtu();
  const std::string array = xml_array("Float32", "p", "0 1 2 3 4");
  const auto of_step = [&](const std::string& number, const std::string& values) {
    std::string text = xml_array("Float32", "p", values);
    return text.insert(text.find(" type"), " TimeStep=\"" + number + "\"");
  };
  mesh.replace(mesh.find(array), array.size(),
               of_step("0", "0 1 2 3 4") + of_step("1", "5 6 7 8 9") + of_step("2", "7 7 7 7 7"));
  mesh.replace(mesh.find("<UnstructuredGrid>"), 18, "<UnstructuredGrid TimeValues=\"0 2.5 30\">");
  write("a.vtu", mesh);
  const MeshFile file = read_mesh(path("a.vtu"), {2.0, {}, {}});
  EXPECT_EQ(file.time, 2.5);
  EXPECT_EQ(file.times, (std::vector<double>{0, 2.5, 30}));
  std::visit([](const auto& values) { EXPECT_EQ(values[0], 5); }, default_array(file).values);
  // In a list whose steps are others.
  const std::string list =
      xml_file("Collection", "<Collection><DataSet timestep=\"0\" file=\"a.vtu\"/></Collection>\n");
  EXPECT_TRUE(contains(refused_text("a.pvd", list), "has steps in time of its own"));
}

const VtkPiece lower{{0, 3, 0, 4, 0, 3}, {}, {}}, upper{{0, 3, 0, 4, 3, 5}, {}, {}};

TEST_F(VtkContradictions, PiecesStandWhereTheirListSays) {
  const std::string list =
      vtk_list("PImageData", {{"0 3 0 4 0 3", "l.vti"}, {"0 3 0 4 3 5", "u.vti"}});
  const std::string right = vtk_grid("ImageData", {upper});
  write("l.vti", vtk_grid("ImageData", {lower}));
  for (const auto& [from, to] :
       {std::pair{"Origin=\"0 0 0\"", "Origin=\"0 0 9\""},
        std::pair{"Spacing=\"1 2 3\"", "Spacing=\"1 2 4\""},
        std::pair{"Spacing=\"1 2 3\"", "Spacing=\"3 2 1\""},
        std::pair{"Spacing", "Direction=\"0 -1 0 1 0 0 0 0 1\" Spacing"}}) {
    std::string other = right;
    other.replace(other.find(from), std::string(from).size(), to);
    write("u.vti", other);
    const std::string error = refused_text("a.pvti", list);
    EXPECT_TRUE(contains(error, "its piece u.vti: its Origin, Spacing or Direction is not"))
        << error;
  }
  // Rounded, and not said.
  for (const char* spacing : {"Spacing=\"1 1.9999999 3\"", ""}) {
    std::string other = right;
    other.replace(other.find("Spacing=\"1 2 3\""), 15, spacing);
    write("u.vti", other);
    EXPECT_EQ(value_at(read_volume(write("a.pvti", list)), 3, 4, 5), 543);
  }
}

TEST_F(VtkContradictions, GhostsThatAListDoesNotNameAreGhosts) {
  test::SmallVtu own, ghosts;
  own.more = xml_array("UInt8", "vtkGhostType", "0 0 0");
  ghosts.more = xml_array("UInt8", "vtkGhostType", "1 1 1");
  write("l.vtu", test::small_vtu(own));
  write("r.vtu", test::small_vtu(ghosts));
  const std::string pieces = xml_file(
      "PUnstructuredGrid",
      "<PUnstructuredGrid GhostLevel=\"1\"><PCellData><PDataArray type=\"Int32\" Name=\"id\"/>"
      "</PCellData><PPoints><PDataArray type=\"Float64\" "
      "NumberOfComponents=\"3\"/></PPoints><Piece "
      "Source=\"l.vtu\"/><Piece Source=\"r.vtu\"/></PUnstructuredGrid>\n");
  EXPECT_EQ(read_mesh(write("a.pvtu", pieces)).grid.shapes.size(), 2U);
  // Of grids they hide values, which VTK would show.
  VtkPiece hides = upper;
  std::string flags = "2";
  for (int i = 1; i < 60; ++i) flags += " 0";
  hides.points = xml_array("UInt8", "vtkGhostType", flags) +
                 xml_array("Int16", "v", test::vtk_values(upper.extent));
  for (const std::string kind : {"ImageData", "RectilinearGrid"}) {
    write("l.xml", vtk_grid(kind, {lower}));
    write("u.xml", vtk_grid(kind, {hides}));
    const std::string error = refused_text(
        "a.pvti", vtk_list("P" + kind, {{"0 3 0 4 0 3", "l.xml"}, {"0 3 0 4 3 5", "u.xml"}}));
    EXPECT_TRUE(contains(error, "\"vtkGhostType\", which the list of pieces does not name"))
        << error;
  }
}

// One of points has the same name, and is not the active one.
TEST_F(VtkContradictions, TheActiveArrayOfCellsIsNotThatOfPoints) {
  std::string mesh = test::small_vtu();
  mesh.replace(mesh.find(" Scalars=\"p\""), 12, "");
  mesh.replace(mesh.find("<CellData>"), 10, "<CellData Scalars=\"p\">");
  mesh.replace(mesh.find("Name=\"id\""), 9, "Name=\"p\"");
  const MeshFile file = read_mesh(write("a.vtu", mesh));
  EXPECT_EQ(file.active, "p_cell");
  EXPECT_EQ(default_array(file).centering, Centering::cell);
}

/// A copy of a piece with other values, "7", at some of its points.
VtkPiece with_values(VtkPiece piece, const std::string& from, const std::string& to) {
  std::string values = test::vtk_values(piece.extent);
  values.replace(values.find(from), from.size(), to);
  piece.points = xml_array("Int16", "v", values);
  return piece;
}

TEST_F(VtkContradictions, PiecesThatDisagreeAreTold) {
  // The point (1, 2, 3) is in both.
  const VtkPiece other = with_values(upper, " 321 ", " 300 ");
  for (const std::string kind : {"ImageData", "RectilinearGrid"}) {
    SCOPED_TRACE(kind);
    const std::string list =
        vtk_list("P" + kind, {{"0 3 0 4 0 3", "l.xml"}, {"0 3 0 4 3 5", "u.xml"}});
    write("l.xml", vtk_grid(kind, {lower}));
    write("u.xml", vtk_grid(kind, {upper}));
    EXPECT_EQ(value_at(components(write("a.pvti", list)).front(), 1, 2, 3), 321);
    EXPECT_EQ(notes(), "");
    write("u.xml", vtk_grid(kind, {other}));
    const bool is_image = kind == "ImageData";
    EXPECT_EQ(value_at(components(path("a.pvti")).front(), 1, 2, 3), is_image ? 321 : 300);
    EXPECT_TRUE(is_noted("disagree about 1 value there, by up to 21")) << notes();
    EXPECT_TRUE(is_noted(is_image ? "the first piece are shown" : "the last piece are shown"));
  }
  write("l.vts", vtk_grid("StructuredGrid", {lower}));
  write("u.vts", vtk_grid("StructuredGrid", {other}));
  const std::string list =
      vtk_list("PStructuredGrid", {{"0 3 0 4 0 3", "l.vts"}, {"0 3 0 4 3 5", "u.vts"}});
  const MeshFile mesh = read_mesh(write("a.pvts", list));
  ASSERT_EQ(mesh.notes.size(), 1U);
  EXPECT_TRUE(contains(mesh.notes[0], "disagree about 1 value there")) << mesh.notes[0];
  write("u.vts", vtk_grid("StructuredGrid", {upper}));
  EXPECT_EQ(read_mesh(path("a.pvts")).notes.size(), 0U);
  // Cells of both.
  VtkPiece cells = lower, more = upper;
  cells.has_points = more.has_points = false;
  cells.has_cells = more.has_cells = true;
  more.extent[4] = 2;
  std::string values = test::vtk_values({0, 2, 0, 3, 2, 4});
  more.cells = xml_array("Int16", "c", "9" + values.substr(values.find(' ')));
  for (const std::string kind : {"ImageData", "RectilinearGrid"}) {
    write("l.xml", vtk_grid(kind, {cells}));
    write("u.xml", vtk_grid(kind, {more}));
    components(write(
        "a.pvti",
        vtk_list("P" + kind, {{"0 3 0 4 0 3", "l.xml"}, {"0 3 0 4 2 5", "u.xml"}}, "Int16", true)));
    EXPECT_TRUE(is_noted("disagree about 1 value there, by up to 191")) << notes();
  }
}

TEST_F(VtkContradictions, PiecesAgreeAboutPositions) {
  for (const std::string kind : {"RectilinearGrid", "StructuredGrid"}) {
    const bool is_mesh = kind == "StructuredGrid";
    const std::string name = is_mesh ? "a.pvts" : "a.pvtr", right = vtk_grid(kind, {upper});
    const std::string list =
        vtk_list("P" + kind, {{"0 3 0 4 0 3", "l.xml"}, {"0 3 0 4 3 5", "u.xml"}});
    write("l.xml", vtk_grid(kind, {lower}));
    // A position along x that both have, and along z on the face between.
    for (const auto& [from, to] : is_mesh ? std::vector{std::pair{"2 0 3 ", "2 1 3 "}}
                                          : std::vector{std::pair{"0 1 4 9 <", "0 2 4 9 <"},
                                                        std::pair{"9 16 25", "8 16 25"}}) {
      std::string other = right;
      other.replace(other.find(from), std::string(from).size(), to);
      write("u.xml", other);
      EXPECT_TRUE(contains(refused_text(name, list), "disagrees with another about positions"));
    }
  }
}

TEST_F(VtkContradictions, LegacyNumbersAreOfTheirTypes) {
  const auto image_of = [](const std::string& arrays) {
    return "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET STRUCTURED_POINTS\n"
           "DIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\n" +
           arrays;
  };
  const std::string numbers = "1 2 3 4\n5 6 7 ";
  for (const auto& [type, number] :
       {std::pair{"unsigned_char", "300"}, std::pair{"unsigned_char", "-1"},
        std::pair{"char", "128"}, std::pair{"short", "40000"}, std::pair{"unsigned_short", "65536"},
        std::pair{"int", "2147483648"}, std::pair{"unsigned_int", "4294967296"},
        std::pair{"int", "2.5"}, std::pair{"long", "9223372036854775808"}}) {
    for (const std::string& array :
         {"SCALARS v " + std::string(type) + " 1\nLOOKUP_TABLE default\n",
          "SCALARS v " + std::string(type) + "\nLOOKUP_TABLE default\n",
          "FIELD FieldData 1\nv 1 8 " + std::string(type) + "\n",
          "FIELD FieldData 1\n2v 1 8 " + std::string(type) + "\n"}) {
      const std::string error = refused_text("a.vtk", image_of(array + numbers + number + "\n"));
      EXPECT_TRUE(
          contains(error, "has the number " + std::string(number) + ", which is no " + type))
          << error;
      EXPECT_EQ(value_at(read_volume(write("b.vtk", image_of(array + numbers + "8\n"))), 1, 1, 1),
                8);
    }
  }
  // Reals behind whole numbers, and colors of a table.
  const std::string more = "SCALARS v short 1\nLOOKUP_TABLE t\n" + numbers +
                           "8\nLOOKUP_TABLE t 2\n0 0.5 0 1\n1 1 1 1\n"
                           "FIELD FieldData 1\n3d 1 8 float\n" +
                           numbers + "8.5\n";
  EXPECT_EQ(value_at(read_volume(write("c.vtk", image_of(more))), 1, 1, 1), 8);
  std::string mesh = test::small_structured_vtk();
  mesh.replace(mesh.find("5 6\n"), 4, "5 6000000000\n");
  EXPECT_TRUE(contains(refused_text("m.vtk", mesh), "\"c\" has the number 6000000000"));
}

TEST_F(VtkContradictions, RoundedNumbersAreTold) {
  const std::string values = xml_array("Int64", "v", "9007199254740993 2 3 4 5 6 7 8");
  components(write("a.vti", image(values)));
  EXPECT_TRUE(is_noted("of \"v\" 1 of 8 whole numbers of 64 bits")) << notes();
  std::string mesh = test::small_vtu();
  mesh.replace(mesh.find("\"Int32\" Name=\"id\""), 17, "\"Int64\" Name=\"id\"");
  mesh.replace(mesh.find("7 8 9<"), 5, "7 -9007199254740993 9007199254740994");
  const std::vector<std::string> told = read_mesh(write("a.vtu", mesh)).notes;
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(contains(told[0], "1 of the whole numbers of \"id\" do not fit")) << told[0];
  components(write("b.vti", image(xml_array("Int64", "v", "9007199254740992 2 3 4 5 6 7 8"))));
  EXPECT_EQ(notes(), "");
}

}  // namespace
}  // namespace pellucid::test_vtk_contradictions

#endif
