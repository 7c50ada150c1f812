// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_mesh.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "mesh_files.h"
#include "pellucid/io/mesh_source.h"
#include "tests/io/scratch_folder.h"
#include "tests/support/test_data.h"

namespace pellucid::test_read_mesh {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::error_of;

const MeshArray* find(const MeshFile& file, const std::string& name) {
  for (const MeshArray& array : file.grid.arrays) {
    if (array.name == name) return &array;
  }
  return nullptr;
}

std::vector<double> values(const MeshFile& file, const std::string& name) {
  const MeshArray* const array = find(file, name);
  if (array == nullptr) {
    ADD_FAILURE() << "there is no array " << name;
    return {};
  }
  std::vector<double> list;
  std::visit([&](const auto& data) { list.assign(data.begin(), data.end()); }, array->values);
  return list;
}

class ReadMesh : public test::ScratchFolder {
 protected:
  std::string refused(const std::string& name, const std::string& bytes,
                      const MeshReadOptions& options = {}) const {
    const fs::path file = write(name, bytes);
    const std::string error = error_of([&] { read_mesh(file, options); });
    EXPECT_TRUE(error.starts_with(file.string() + ": ")) << error;
    return error;
  }
};

TEST_F(ReadMesh, KnowsMeshesByNameAndByContent) {
  EXPECT_TRUE(is_mesh_file("a.vtu"));
  EXPECT_TRUE(is_mesh_file("a.EX2"));
  EXPECT_FALSE(is_mesh_file("a.nii.gz"));
  EXPECT_FALSE(is_mesh_file("builtin"));
  EXPECT_TRUE(is_mesh_file(write("nameless", test::small_vtk())));
  EXPECT_TRUE(is_mesh_file(write("xml.dat", test::small_vtu())));
  EXPECT_FALSE(is_mesh_file(write("picture.xml", "<?xml version=\"1.0\"?><svg/>")));
}

TEST_F(ReadMesh, RefusesWhatIsNotThereOrNoMesh) {
  EXPECT_TRUE(contains(error_of([&] { read_mesh(path("none.vtu")); }), "none.vtu"));
  EXPECT_TRUE(contains(refused("a.dat", "nothing known"), "no mesh"));
  EXPECT_TRUE(contains(error_of([&] { read_mesh(folder_); }), folder_.string()));
}

// PLOT3D, which needs no VTK.

struct Plot3d {
  bool big_endian = false, marks = false, several = false, wide = false, blanking = false;
};

class Plot3dWriter {
 public:
  explicit Plot3dWriter(const Plot3d& layout) : layout_(layout) {}

  void record(const std::vector<std::int32_t>& integers, const std::vector<double>& reals,
              const std::vector<std::int32_t>& behind = {}) {
    std::string body = bytes(integers);
    body += layout_.wide ? bytes(reals) : bytes(std::vector<float>(reals.begin(), reals.end()));
    body += bytes(behind);
    const std::string mark = bytes(std::vector{static_cast<std::int32_t>(body.size())});
    text_ += layout_.marks ? mark + body + mark : body;
  }
  const std::string& text() const { return text_; }

 private:
  template <class Value>
  std::string bytes(const std::vector<Value>& list) const {
    return layout_.big_endian ? test::swapped_bytes_of(list) : test::bytes_of(list);
  }

  Plot3d layout_;
  std::string text_;
};

/// Blocks of 3 x 2 x 2 points; each begins where the one before ends.
std::string plot3d_grid(const Plot3d& layout, int blocks) {
  Plot3dWriter writer(layout);
  if (layout.several) writer.record({blocks}, {});
  std::vector<std::int32_t> sides;
  for (int b = 0; b < blocks; ++b) sides.insert(sides.end(), {3, 2, 2});
  writer.record(sides, {});
  for (int b = 0; b < blocks; ++b) {
    std::vector<double> x, y, z;
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < 2; ++j) {
        for (int i = 0; i < 3; ++i) {
          x.push_back(2 * b + i);
          y.push_back(j);
          z.push_back(k);
        }
      }
    }
    x.insert(x.end(), y.begin(), y.end());
    x.insert(x.end(), z.begin(), z.end());
    std::vector<std::int32_t> shown;
    if (layout.blanking) {
      shown.assign(12, 1);
      shown[0] = 0;  // hides the first cell
    }
    writer.record({}, x, shown);
  }
  return writer.text();
}

/// Density 1 + x, momentum (density, 0, 2 density), energy 10: the speed is (1, 0, 2).
std::string plot3d_solution(const Plot3d& layout, int blocks) {
  Plot3dWriter writer(layout);
  if (layout.several) writer.record({blocks}, {});
  std::vector<std::int32_t> sides;
  for (int b = 0; b < blocks; ++b) sides.insert(sides.end(), {3, 2, 2});
  writer.record(sides, {});
  for (int b = 0; b < blocks; ++b) {
    writer.record({}, {0.5, 0, 1e6, 0});
    std::vector<double> q[5];
    for (int p = 0; p < 12; ++p) {
      const double density = 1 + 2 * b + p % 3;
      const double numbers[] = {density, density, 0, 2 * density, 10};
      for (int i = 0; i < 5; ++i) q[i].push_back(numbers[i]);
    }
    for (int i = 1; i < 5; ++i) q[0].insert(q[0].end(), q[i].begin(), q[i].end());
    writer.record({}, q[0]);
  }
  return writer.text();
}

TEST_F(ReadMesh, FindsTheLayoutOfPlot3d) {
  for (unsigned choice = 0; choice < 32; ++choice) {
    SCOPED_TRACE(choice);
    const Plot3d layout{(choice & 1) != 0, (choice & 2) != 0, (choice & 4) != 0, (choice & 8) != 0,
                        (choice & 16) != 0};
    const int blocks = layout.several ? 2 : 1;
    const fs::path grid = write("grid.bin", plot3d_grid(layout, blocks));
    const fs::path q = write("q.bin", plot3d_solution(layout, blocks));
    const MeshFile file = read_mesh(grid, {{}, q});
    EXPECT_EQ(file.format, "PLOT3D");
    EXPECT_EQ(file.blocks, blocks);
    // The blocks share the four points of a face.
    EXPECT_EQ(file.merged_points, layout.several ? 4U : 0U);
    EXPECT_EQ(file.grid.points.size(), layout.several ? 20U : 12U);
    EXPECT_EQ(file.ghost_cells, layout.blanking ? static_cast<std::size_t>(blocks) : 0U);
    EXPECT_EQ(file.grid.shapes.size(),
              static_cast<std::size_t>(layout.blanking ? blocks : 2 * blocks));
    if (choice == 0) {
      EXPECT_EQ(file.grid.corners, (std::vector<std::int32_t>{0, 1, 4, 3, 6, 7, 10, 9,  //
                                                              1, 2, 5, 4, 7, 8, 11, 10}));
    }
    EXPECT_EQ(type_name(find(file, "Density")->values), layout.wide ? "f64" : "f32");
    const std::vector<double> density = values(file, "Density"), speed = values(file, "Velocity"),
                              pressure = values(file, "Pressure"),
                              temperature = values(file, "Temperature");
    for (std::size_t p = 0; p < file.grid.points.size(); ++p) {
      EXPECT_EQ(density[p], 1 + file.grid.points[p].x);
      EXPECT_EQ(speed[3 * p], 1);
      EXPECT_EQ(speed[3 * p + 2], 2);
      EXPECT_NEAR(pressure[p], 0.4 * (10 - 2.5 * density[p]), 1e-6);
      EXPECT_NEAR(temperature[p], pressure[p] / density[p], 1e-6);
    }
  }
}

TEST_F(ReadMesh, RefusesPlot3dThatDoesNotFit) {
  const std::string grid = plot3d_grid({}, 1), q = plot3d_solution({}, 1);
  EXPECT_TRUE(contains(refused("a.xyz", grid.substr(0, grid.size() - 1)), "cut off"));
  EXPECT_TRUE(contains(refused("a.xyz", ""), "PLOT3D"));
  EXPECT_TRUE(contains(refused("a.xyz", grid, {0.5, {}}), "no steps"));
  write("a.xyz", grid);
  const auto with = [&](const std::string& solution) {
    const fs::path file = write("a.q", solution);
    return error_of([&] { read_mesh(path("a.xyz"), {{}, file}); });
  };
  EXPECT_TRUE(contains(with(q.substr(0, 100)), "too few"));
  EXPECT_TRUE(contains(with(plot3d_solution({true}, 1)), "other dimensions"));
  EXPECT_TRUE(contains(error_of([&] { default_array(read_mesh(path("a.xyz"))); }), "solution"));
}

TEST(MeshSource, ReadsArraysAsWritten) {
  const auto expect = [](const char* text, const char* array, std::optional<int> component,
                         const char* name) {
    const MeshArrayChoice choice = parse_mesh_array(text);
    EXPECT_EQ(choice.array, array) << text;
    EXPECT_EQ(choice.component, component) << text;
    EXPECT_EQ(choice.name, name) << text;
  };
  expect("Temp", "Temp", {}, "Temp");
  expect("V:2", "V", 2, "V_2");
  expect("speed=V", "V", {}, "speed");
  expect("u=V:0", "V", 0, "u");
  expect("Nodal Displacement", "Nodal Displacement", {}, "Nodal_Displacement");
  expect("a:b", "a:b", {}, "a_b");
  expect("two words=V", "two words=V", {}, "two_words_V");
  EXPECT_TRUE(contains(error_of([] { parse_mesh_array("t="); }), "ARRAY"));
  EXPECT_TRUE(contains(error_of([] { parse_mesh_array(""); }), "ARRAY"));
}

#ifdef PELLUCID_HAVE_VTK

TEST_F(ReadMesh, ReadsVtu) {
  const MeshFile file = read_mesh(write("a.vtu", test::small_vtu()));
  EXPECT_EQ(file.format, "VTK XML");
  ASSERT_EQ(file.grid.points.size(), 5U);
  EXPECT_EQ(file.grid.points[4].y, 1);
  EXPECT_EQ(file.grid.shapes, std::vector(2, CellShape::tetrahedron));
  EXPECT_EQ(file.grid.corners, (std::vector<std::int32_t>{0, 1, 2, 3, 1, 2, 3, 4}));
  EXPECT_EQ(file.flat_cells, 1U);
  EXPECT_EQ(file.active, "p");
  EXPECT_EQ(default_array(file).name, "p");
  EXPECT_EQ(values(file, "p"), (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(type_name(find(file, "p")->values), "f32");
  // Without that of the triangle.
  EXPECT_EQ(values(file, "id"), (std::vector<double>{7, 8}));
  EXPECT_EQ(type_name(find(file, "id")->values), "i32");
  EXPECT_EQ(find(file, "v")->components, 3);
  EXPECT_TRUE(contains(refused("a.vtu", test::small_vtu(), {1.0, {}}), "no steps"));
}

TEST_F(ReadMesh, MakesAMeshOfTheChosenArrays) {
  const fs::path file = write("a.vtu", test::small_vtu());
  const LoadedMesh shown = load_mesh({file, {}, {}});
  ASSERT_EQ(shown.mesh->count(), 1);
  EXPECT_EQ(shown.channels[0].array, "p");
  EXPECT_EQ((*shown.mesh)[0].name, "value");
  const LoadedMesh chosen =
      load_mesh({file, {}, {parse_mesh_array("v"), parse_mesh_array("c=id")}});
  ASSERT_EQ(chosen.mesh->count(), 2);
  EXPECT_EQ(chosen.mesh->value(0, 0), 5);  // the length of (3, 4, 0)
  EXPECT_EQ(chosen.mesh->value(1, 1), 8);
  EXPECT_TRUE(contains(error_of([&] { load_mesh({file, {}, {parse_mesh_array("none")}}); }), "id"));
}

TEST_F(ReadMesh, TakesNamesWithAColonWhole) {
  test::SmallVtu of;
  of.more = test::xml_array("Float64", "v:1", "20 30 40");
  const fs::path file = write("a.vtu", test::small_vtu(of));
  const LoadedMesh whole = load_mesh({file, {}, {parse_mesh_array("w=v:1")}});
  EXPECT_EQ(whole.mesh->value(0, 1), 30);
  EXPECT_EQ(whole.channels[0].array, "v:1");
  const LoadedMesh component = load_mesh({file, {}, {parse_mesh_array("w=v:0")}});
  EXPECT_EQ(component.channels[0].component, 0);
  EXPECT_EQ(component.mesh->value(0, 0), 3);
}

TEST_F(ReadMesh, LeavesGhostsOut) {
  test::SmallVtu of;
  of.more = test::xml_array("UInt8", "vtkGhostType", "0 1 0");
  const MeshFile file = read_mesh(write("a.vtu", test::small_vtu(of)));
  EXPECT_EQ(file.ghost_cells, 1U);
  EXPECT_EQ(file.grid.shapes.size(), 1U);
  EXPECT_EQ(values(file, "id"), (std::vector<double>{7}));
  EXPECT_EQ(find(file, "vtkGhostType"), nullptr);
}

TEST_F(ReadMesh, JoinsPieces) {
  write("a.vtu", test::small_vtu());
  test::SmallVtu other;  // shares the points 0 and 1 of the first, the second with another value
  other.points = "0 0 0  1 0 0  0 -1 0  0 0 -1  -1 -1 -1";
  other.values = "0 9 9 9 9";
  write("b.vtu", test::small_vtu(other));
  const std::string blocks =
      "<vtkMultiBlockDataSet><DataSet index=\"0\" file=\"a.vtu\"/><DataSet index=\"1\" "
      "file=\"b.vtu\"/></vtkMultiBlockDataSet>\n";
  const MeshFile file = read_mesh(write("all.vtm", test::xml_file("vtkMultiBlockDataSet", blocks)));
  EXPECT_EQ(file.blocks, 2);
  EXPECT_EQ(file.merged_points, 1U);
  EXPECT_EQ(file.discontinuous_points, 1U);
  EXPECT_EQ(file.grid.points.size(), 9U);
  EXPECT_EQ(file.grid.corners,
            (std::vector<std::int32_t>{0, 1, 2, 3, 1, 2, 3, 4, 0, 5, 6, 7, 5, 6, 7, 8}));
  EXPECT_EQ(values(file, "p"), (std::vector<double>{0, 1, 2, 3, 4, 9, 9, 9, 9}));
  EXPECT_EQ(values(file, "id"), (std::vector<double>{7, 8, 7, 8}));
  fs::remove(path("b.vtu"));
  EXPECT_TRUE(contains(error_of([&] { read_mesh(path("all.vtm")); }), "b.vtu"));
}

TEST_F(ReadMesh, FillsWhatABlockLacksWithNaN) {
  write("a.vtu", test::small_vtu());
  std::string other = test::small_vtu();
  while (other.find("\"id\"") != std::string::npos)
    other.replace(other.find("\"id\""), 4, "\"is\"");
  write("b.vtu", other);
  const std::string blocks =
      "<vtkMultiBlockDataSet><DataSet index=\"0\" file=\"a.vtu\"/><DataSet index=\"1\" "
      "file=\"b.vtu\"/></vtkMultiBlockDataSet>\n";
  const MeshFile file = read_mesh(write("all.vtm", test::xml_file("vtkMultiBlockDataSet", blocks)));
  const std::vector<double> id = values(file, "id"), is = values(file, "is");
  ASSERT_EQ(id.size(), 4U);
  ASSERT_EQ(is.size(), 4U);
  EXPECT_EQ(id[1], 8);
  EXPECT_TRUE(std::isnan(id[2]));
  EXPECT_TRUE(std::isnan(is[0]));
  EXPECT_EQ(is[3], 8);
}

TEST_F(ReadMesh, ReadsParallelPieces) {
  write("a.vtu", test::small_vtu());
  const std::string pieces =
      "<PUnstructuredGrid GhostLevel=\"0\"><PPointData Scalars=\"p\"><PDataArray type=\"Float64\" "
      "Name=\"v\" NumberOfComponents=\"3\"/><PDataArray type=\"Float32\" Name=\"p\"/></PPointData>"
      "<PCellData><PDataArray type=\"Int32\" Name=\"id\"/></PCellData><PPoints><PDataArray "
      "type=\"Float64\" NumberOfComponents=\"3\"/></PPoints><Piece Source=\"a.vtu\"/><Piece "
      "Source=\"a.vtu\"/></PUnstructuredGrid>\n";
  const MeshFile file = read_mesh(write("a.pvtu", test::xml_file("PUnstructuredGrid", pieces)));
  EXPECT_EQ(file.grid.shapes.size(), 4U);
  EXPECT_EQ(values(file, "id"), (std::vector<double>{7, 8, 7, 8}));
}

/// Text of a file that lists a.vtu `count` times as pieces.
std::string list_of_pieces(int count) {
  std::string pieces =
      "<PUnstructuredGrid GhostLevel=\"0\"><PPoints><PDataArray type=\"Float64\" "
      "NumberOfComponents=\"3\"/></PPoints>";
  for (int i = 0; i < count; ++i) pieces += "<Piece Source=\"a.vtu\"/>";
  return test::xml_file("PUnstructuredGrid", pieces + "</PUnstructuredGrid>\n");
}

// VTK 9.1 takes the types of cells from memory that it has not filled yet, and makes faces where
// one is a polyhedron's: in 2 of 60 runs with four cells.
TEST_F(ReadMesh, ReadsParallelPiecesWhateverIsInMemory) {
  write("a.vtu", test::small_vtu());
  constexpr int count = 400;
  const MeshFile file = read_mesh(write("a.pvtu", list_of_pieces(count)));
  EXPECT_EQ(file.grid.shapes.size(), 2U * count);
  EXPECT_EQ(file.blocks, count);
  const std::string nested =
      "<vtkMultiBlockDataSet><Block index=\"0\"><DataSet index=\"0\" file=\"a.pvtu\"/>"
      "<DataSet index=\"1\"/></Block><DataSet index=\"1\" file=\"a.vtu\"/>"
      "</vtkMultiBlockDataSet>\n";
  EXPECT_EQ(
      read_mesh(write("a.vtm", test::xml_file("vtkMultiBlockDataSet", nested))).grid.shapes.size(),
      2U * (count + 1));
}

TEST_F(ReadMesh, NamesThePartThatItCannotRead) {
  write("a.vtu", test::small_vtu());
  const auto error = [&](const std::string& part, const std::string& text) {
    if (!text.empty()) write(part, text);
    return refused("all.vtm", test::xml_file("vtkMultiBlockDataSet",
                                             "<vtkMultiBlockDataSet><DataSet index=\"0\" "
                                             "file=\"a.vtu\"/><DataSet index=\"1\" file=\"" +
                                                 part + "\"/></vtkMultiBlockDataSet>\n"));
  };
  EXPECT_TRUE(contains(error("gone.vtu", ""), "names gone.vtu, which is not there"));
  EXPECT_TRUE(contains(error("all.vtm", ""), "all.vtm is a list of blocks itself"));
  EXPECT_TRUE(contains(error("b.vtu", "none\n"), "b.vtu"));
  EXPECT_TRUE(contains(
      refused("e.vtm", test::xml_file("vtkMultiBlockDataSet", "<vtkMultiBlockDataSet/>\n")),
      "names no file"));
  EXPECT_TRUE(contains(refused("e.pvtu", list_of_pieces(0)), "names no file"));
}

TEST_F(ReadMesh, ChoosesAStepOfACollection) {
  test::SmallVtu later;
  later.values = "5 6 7 8 9";
  write("a.vtu", test::small_vtu());
  write("b.vtu", test::small_vtu(later));
  const fs::path steps =
      write("all.pvd",
            test::xml_file("Collection",
                           "<Collection><DataSet timestep=\"2.5\" part=\"0\" file=\"b.vtu\"/>"
                           "<DataSet timestep=\"1\" part=\"0\" file=\"a.vtu\"/></Collection>\n"));
  const auto first_value = [&](std::optional<double> time) {
    const MeshFile file = read_mesh(steps, {time, {}});
    EXPECT_EQ(file.times, (std::vector<double>{1, 2.5}));
    return values(file, "p")[0];
  };
  EXPECT_EQ(first_value({}), 0);
  EXPECT_EQ(first_value(0.0), 0);
  EXPECT_EQ(first_value(1.7), 0);
  EXPECT_EQ(first_value(1.8), 5);
  EXPECT_EQ(first_value(100.0), 5);
  fs::remove(path("b.vtu"));
  EXPECT_TRUE(contains(error_of([&] { read_mesh(steps, {2.5, {}}); }), "not there"));
}

TEST_F(ReadMesh, ReadsLegacyFiles) {
  const MeshFile file = read_mesh(write("a.vtk", test::small_vtk()));
  EXPECT_EQ(file.format, "legacy VTK");
  EXPECT_EQ(file.grid.shapes.size(), 2U);
  EXPECT_EQ(values(file, "p"), (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(values(file, "q"), (std::vector<double>{5, 6, 7, 8, 9}));
  EXPECT_TRUE(file.times.empty());
  const MeshFile bent = read_mesh(write("b.vtk", test::small_structured_vtk()));
  EXPECT_EQ(bent.grid.shapes, std::vector(2, CellShape::hexahedron));
  EXPECT_EQ(bent.grid.corners, (std::vector<std::int32_t>{0, 1, 4, 3, 6, 7, 10, 9,  //
                                                          1, 2, 5, 4, 7, 8, 11, 10}));
  EXPECT_EQ(values(bent, "c"), (std::vector<double>{5, 6}));
  EXPECT_EQ(find(bent, "c")->centering, Centering::cell);
}

TEST_F(ReadMesh, SaysWhatIsNoMesh) {
  const std::string head = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET ";
  EXPECT_TRUE(contains(refused("a.vtk", head + "POLYDATA\nPOINTS 0 float\n"), "a surface"));
  EXPECT_TRUE(
      contains(refused("a.vtk", head + "STRUCTURED_POINTS\n"), "a volume on a regular grid"));
  EXPECT_TRUE(
      contains(refused("a.vtk", head + "RECTILINEAR_GRID\n"), "a volume on a regular grid"));
  EXPECT_TRUE(contains(refused("a.vti", test::xml_file("ImageData", "<ImageData/>\n")),
                       "a volume on a regular grid"));
  EXPECT_TRUE(contains(refused("a.vtu", test::xml_file("PolyData", "<PolyData/>\n")), "a surface"));
}

TEST_F(ReadMesh, NamesCellsThatItCannotRead) {
  const auto error = [&](const std::string& type) {
    test::SmallVtu of;
    of.types = "10 " + type + " 5";
    return refused("a.vtu", test::small_vtu(of));
  };
  EXPECT_TRUE(contains(error("41"), "convex point set"));
  EXPECT_TRUE(contains(error("78"), "Bezier tetrahedron"));
  EXPECT_TRUE(contains(error("33"), "biquadratic-quadratic hexahedron"));
  EXPECT_TRUE(contains(error("74"), "Lagrange pyramid"));
  EXPECT_TRUE(contains(error("16"), "has 4 points, but one of its shape has 12"));
  EXPECT_TRUE(contains(error("72"), "has 4 points, as no Lagrange cell of its shape has"));
  EXPECT_TRUE(contains(error("42"), "a polyhedron, comes without its faces"));
  EXPECT_TRUE(contains(error("200"), "number 200"));
  EXPECT_TRUE(contains(error("12"), "has 4 points, but one of its shape has 8"));
}

/// A unit cube, and what follows it in its list of points; of all types that have eight corners.
test::AnyVtu cubes_with_more_points(const std::string& type, int listed) {
  test::AnyVtu of;
  of.points = "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1";
  for (int i = 0; i < 8; ++i) of.connectivity += std::to_string(i) + " ";
  for (int i = 8; i < listed; ++i) {
    of.points += " 0.5 0.5 0.5";
    of.connectivity += std::to_string(i) + " ";
  }
  of.point_count = listed;
  of.cell_count = 1;
  of.offsets = std::to_string(listed);
  of.types = type;
  return of;
}

TEST_F(ReadMesh, TakesTheCornersOfLinearCellsThatListMorePoints) {
  for (const int listed : {9, 20, 27}) {
    const fs::path file = write("a.vtu", cubes_with_more_points("12", listed).text());
    std::vector<std::string> notes;
    MeshReadOptions options;
    options.note = [&](const std::string& note) { notes.push_back(note); };
    const MeshFile mesh = read_mesh(file, options);
    EXPECT_EQ(mesh.grid.shapes, std::vector{CellShape::hexahedron});
    EXPECT_EQ(mesh.grid.corners, (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(mesh.trimmed_cells, 1U);
    EXPECT_EQ(mesh.first_trimmed_cell, 0);
    EXPECT_EQ(notes, mesh.notes);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_TRUE(contains(notes[0], "1 of 1 cells list more points than their shape has"));
    EXPECT_TRUE(contains(notes[0], "cell 0"));
    EXPECT_DOUBLE_EQ(load_mesh({file, {}, {}}).mesh->mesh().statistics().volume, 1);
  }
  EXPECT_TRUE(read_mesh(write("a.vtu", cubes_with_more_points("12", 8).text())).notes.empty());
  // Of all shapes, legacy files too; fewer than needed are an error as before.
  const std::pair<int, int> shapes[] = {{10, 4},  {11, 8},  {12, 8},  {13, 6},  {14, 5}, {24, 10},
                                        {25, 20}, {26, 15}, {27, 13}, {29, 27}, {32, 18}};
  for (const auto& [type, points] : shapes) {
    for (const int listed : {points - 1, points + 1}) {
      SCOPED_TRACE(std::to_string(type) + " of " + std::to_string(listed));
      std::string text =
          "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
          std::to_string(listed) + " float\n";
      std::string list = std::to_string(listed);
      for (int i = 0; i < listed; ++i) {
        text += std::to_string(i % 3) + " " + std::to_string(i / 3 % 3) + " " +
                std::to_string(i / 9) + "\n";
        list += " " + std::to_string(i);
      }
      text += "CELLS 1 " + std::to_string(listed + 1) + "\n" + list + "\nCELL_TYPES 1\n" +
              std::to_string(type) + "\n";
      if (listed < points) {
        EXPECT_TRUE(contains(refused("a.vtk", text), "but one of its shape has"));
        continue;
      }
      const MeshFile mesh = read_mesh(write("a.vtk", text));
      EXPECT_EQ(mesh.trimmed_cells, 1U);
      EXPECT_EQ(mesh.grid.corners.size(), static_cast<std::size_t>(points));
    }
  }
}

/// A unit cube as one Lagrange hexahedron; each node stands at its place in the lattice, by the
/// rule of VTK 9, or of 8, whose last two upright edges are exchanged.
test::AnyVtu lagrange_vtu(const std::array<int, 3>& orders, bool of_vtk_8 = false) {
  const auto index = [&](int i, int j, int k) {
    const int last[3] = {orders[0], orders[1], orders[2]}, at[3] = {i, j, k};
    bool end[3];
    for (int a = 0; a < 3; ++a) end[a] = at[a] == 0 || at[a] == last[a];
    const int n[3] = {last[0] - 1, last[1] - 1, last[2] - 1};
    const int corner = i > 0 ? (j > 0 ? 2 : 1) : (j > 0 ? 3 : 0);
    const int upright = of_vtk_8 && corner >= 2 ? 5 - corner : corner;
    const int ring = 2 * (n[0] + n[1]);
    if (end[0] && end[1] && end[2]) return corner + (k > 0 ? 4 : 0);
    if (end[1] && end[2]) return 8 + (k > 0 ? ring : 0) + (j > 0 ? n[0] + n[1] : 0) + i - 1;
    if (end[0] && end[2]) return 8 + (k > 0 ? ring : 0) + (i > 0 ? n[0] : ring - n[1]) + j - 1;
    int from = 8 + 2 * ring;
    if (end[0] && end[1]) return from + n[2] * upright + k - 1;
    from += 4 * n[2];
    if (end[0]) return from + (i > 0 ? n[1] * n[2] : 0) + n[1] * (k - 1) + j - 1;
    from += 2 * n[1] * n[2];
    if (end[1]) return from + (j > 0 ? n[0] * n[2] : 0) + n[0] * (k - 1) + i - 1;
    from += 2 * n[0] * n[2];
    if (end[2]) return from + (k > 0 ? n[0] * n[1] : 0) + n[0] * (j - 1) + i - 1;
    return from + 2 * n[0] * n[1] + n[0] * (n[1] * (k - 1) + j - 1) + i - 1;
  };
  test::AnyVtu of;
  of.point_count = (orders[0] + 1) * (orders[1] + 1) * (orders[2] + 1);
  std::vector<std::string> places(static_cast<std::size_t>(of.point_count));
  for (int k = 0; k <= orders[2]; ++k) {
    for (int j = 0; j <= orders[1]; ++j) {
      for (int i = 0; i <= orders[0]; ++i) {
        const auto x = [&](int at, std::size_t axis) {
          return std::to_string(static_cast<double>(at) / orders[axis]) + " ";
        };
        places[static_cast<std::size_t>(index(i, j, k))] = x(i, 0) + x(j, 1) + x(k, 2);
      }
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    of.points += places[i] + " ";
    of.connectivity += std::to_string(i) + " ";
  }
  of.cell_count = 1;
  of.offsets = std::to_string(of.point_count);
  of.types = "72";
  return of;
}

TEST_F(ReadMesh, ReadsLagrangeCells) {
  for (int order = 1; order <= 6; ++order) {
    SCOPED_TRACE(order);
    const fs::path file = write("a.vtu", lagrange_vtu({order, order, order}).text());
    const MeshFile mesh = read_mesh(file);
    EXPECT_EQ(mesh.grid.shapes[0], order == 1   ? CellShape::hexahedron
                                   : order == 2 ? CellShape::triquadratic_hexahedron
                                                : CellShape::lagrange_hexahedron);
    const MeshStatistics s = load_mesh({file, {}, {}}).mesh->mesh().statistics();
    EXPECT_NEAR(s.volume, 1, 1e-5);
    EXPECT_EQ(s.folded_faces, 0U);
    EXPECT_EQ(s.boundary_faces, static_cast<std::size_t>(12 * order * order));
    EXPECT_EQ(s.unused_points, 0U);
  }
  // The orders along the axes as an array of cells, marked and not.
  test::AnyVtu of = lagrange_vtu({3, 1, 2});
  EXPECT_TRUE(contains(refused("a.vtu", of.text()), "HIGHER_ORDER_DEGREES"));
  for (const bool marked : {true, false}) {
    of.cell_data = "<CellData" +
                   std::string(marked ? " HigherOrderDegrees=\"HIGHER_ORDER_DEGREES\"" : "") + ">" +
                   test::xml_array("Float64", "HIGHER_ORDER_DEGREES", "3 1 2", 3) + "</CellData>";
    const fs::path file = write("a.vtu", of.text());
    const MeshStatistics s = load_mesh({file, {}, {}}).mesh->mesh().statistics();
    EXPECT_NEAR(s.volume, 1, 1e-5);
    EXPECT_EQ(s.boundary_faces, static_cast<std::size_t>(4 * (3 + 6 + 2)));
  }
}

// Files that VTK 8 wrote say so by their version.
TEST_F(ReadMesh, KnowsTheOrderOfNodesOfOlderFiles) {
  for (const bool old : {false, true}) {
    test::AnyVtu of = lagrange_vtu({3, 3, 3}, old);
    of.version = old ? "2.0" : "2.1";
    const fs::path file = write("a.vtu", of.text());
    EXPECT_EQ(load_mesh({file, {}, {}}).mesh->mesh().statistics().folded_faces, 0U);
    // The other way round the edges cross, and that is said.
    of.version = old ? "2.1" : "2.0";
    std::vector<std::string> notes;
    MeshSource source{write("a.vtu", of.text()), {}, {}};
    source.options.note = [&](const std::string& note) { notes.push_back(note); };
    EXPECT_GT(load_mesh(source).mesh->mesh().statistics().folded_faces, 0U);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_TRUE(contains(notes[0], "1 of 1 cells overlap themselves or a neighbour"));
    EXPECT_TRUE(contains(notes[0], "the likely cause is the order of the cells' nodes"));
  }
}

TEST_F(ReadMesh, ReadsPolyhedra) {
  const auto expect = [&](const fs::path& file) {
    const MeshFile mesh = read_mesh(file);
    EXPECT_EQ(mesh.grid.shapes, (std::vector{CellShape::polyhedron, CellShape::hexahedron}));
    const MeshStatistics s = load_mesh({file, {}, {}}).mesh->mesh().statistics();
    EXPECT_DOUBLE_EQ(s.volume, 2);
    EXPECT_EQ(s.boundary_faces, 20U);
    EXPECT_EQ(s.points, 13U);
    EXPECT_EQ(s.folded_faces, 0U);
  };
  expect(write("a.vtu", test::polyhedron_vtu().text()));
  expect(write("a.vtk", test::polyhedron_vtk(false)));
  expect(write("b.vtk", test::polyhedron_vtk(true)));
  // Two files of it, joined.
  const std::string blocks =
      "<vtkMultiBlockDataSet><DataSet index=\"0\" file=\"a.vtu\"/><DataSet index=\"1\" "
      "file=\"a.vtu\"/></vtkMultiBlockDataSet>\n";
  const MeshFile two = read_mesh(write("all.vtm", test::xml_file("vtkMultiBlockDataSet", blocks)));
  EXPECT_EQ(two.grid.layouts.size(), 16U);
  EXPECT_EQ(two.grid.shapes.size(), 4U);
}

TEST_F(ReadMesh, ReadsPrismsOfFiveAndSixSides) {
  for (const int sides : {5, 6}) {
    test::AnyVtu of;
    double area = 0;
    for (int k = 0; k < 2; ++k) {
      for (int i = 0; i < sides; ++i) {
        const double angle = 2 * 3.14159265358979 * i / sides;
        of.points += std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " " +
                     std::to_string(k) + " ";
        of.connectivity += std::to_string(k * sides + i) + " ";
      }
      area = sides / 2.0 * std::sin(2 * 3.14159265358979 / sides);
    }
    of.point_count = 2 * sides;
    of.cell_count = 1;
    of.offsets = std::to_string(2 * sides);
    of.types = sides == 5 ? "15" : "16";
    const MeshStatistics s =
        load_mesh({write("a.vtu", of.text()), {}, {}}).mesh->mesh().statistics();
    EXPECT_NEAR(s.volume, area, 1e-5);
    EXPECT_EQ(s.boundary_faces, static_cast<std::size_t>(2 * (sides - 2) + 2 * sides));
  }
}

TEST_F(ReadMesh, RefusesFacesThatContradictThemselves) {
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string text = test::polyhedron_vtu().text();
    text.replace(text.find(from), from.size(), to);
    const fs::path file = write("a.vtu", text);
    return error_of([&] { load_mesh({file, {}, {}}); });
  };
  EXPECT_TRUE(contains(error("4 4 5 6 7", "4 4 5 6 99"), "has the point 99"));
  EXPECT_TRUE(contains(error("4 4 5 6 7", "4 4 5 6 -7"), "has the point -7"));
  EXPECT_TRUE(contains(error("4 3 0 4 7", "4 3 0 4 5"), "do not close"));
  EXPECT_TRUE(contains(error("4 3 0 4 7", "4 3 0 4 5"), "cell 0"));
  error("4 3 0 4 7", "9 3 0 4 7");
  error("4 3 0 4 7", "-4 3 0 4 7");
  error("6 4 0 3 2 1", "7 4 0 3 2 1");
  error("6 4 0 3 2 1", "-6 4 0 3 2 1");
  error("6 4 0 3 2 1", "2147483647 4 0 3 2 1");
  error("31 -1", "99 -1");
  error("31 -1", "-1 -1");
  error("31 -1", "-1 31");
}

TEST_F(ReadMesh, RefusesWhatContradictsItself) {
  const auto error = [&](void (*spoil)(test::SmallVtu&)) {
    test::SmallVtu of;
    spoil(of);
    return refused("a.vtu", test::small_vtu(of));
  };
  EXPECT_TRUE(contains(error([](auto& of) { of.connectivity = "0 1 2 3  1 2 3 5  0 1 2"; }),
                       "has the point 5, but there are 5"));
  EXPECT_TRUE(
      contains(error([](auto& of) { of.connectivity = "0 1 2 -3  1 2 3 4  0 1 2"; }), "-3"));
  error([](auto& of) { of.offsets = "4 8 99999999"; });
  error([](auto& of) { of.offsets = "8 4 11"; });
  error([](auto& of) { of.offsets = "-4 8 11"; });
  error([](auto& of) { of.types = "10 10"; });
  error([](auto& of) { of.points = "0 0 0 1"; });
  error([](auto& of) { of.number_of_points = "99999999999999"; });
  EXPECT_TRUE(contains(error([](auto& of) {
                         of.types = "5 5 5";
                         of.connectivity = "0 1 2 0 1 2 0 1 2";
                         of.offsets = "3 6 9";
                       }),
                       "no cell with a volume, but 3 of surfaces"));
}

TEST_F(ReadMesh, RefusesLegacyListsOfCellsThatAreTooLong) {
  const auto replaced = [](const std::string& from, const std::string& to) {
    std::string text = test::small_vtk();
    return text.replace(text.find(from), from.size(), to);
  };
  for (const auto& [from, to] :
       {std::pair{"4 1 2 3 4", "9 1 2 3 4"}, std::pair{"CELLS 2 10", "CELLS 2 4"},
        std::pair{"CELLS 2 10", "CELLSK2 10"}, std::pair{"CELLS 2 10", "CELLS 3 10"},
        std::pair{"CELLS 2 10", "cells 2 99999999999"}}) {
    EXPECT_TRUE(contains(refused("a.vtk", replaced(from, to)), "CELLS")) << to;
  }
  // Arrays of such names are none.
  const MeshFile file = read_mesh(write(
      "b.vtk", test::small_vtk() + "CELL_DATA 2\nSCALARS cells float 1\nLOOKUP_TABLE default\n5 6\n"
                                   "FIELD more 1\ncells_twice 1 2 float\n7 8\n"));
  EXPECT_EQ(values(file, "cells"), (std::vector<double>{5, 6}));
  EXPECT_EQ(values(file, "cells_twice"), (std::vector<double>{7, 8}));
}

TEST_F(ReadMesh, RefusesFilesThatAreCutOff) {
  for (const auto& [name, whole] :
       {std::pair{"a.vtu", test::small_vtu()}, std::pair{"a.vtk", test::small_vtk()},
        std::pair{"b.vtk", test::small_structured_vtk()}}) {
    for (std::size_t length = 0; length < whole.size(); length += 7) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(length));
      const fs::path file = write(name, whole.substr(0, length));
      try {
        // What is cut behind the cells may miss arrays, or the end of a number.
        const MeshFile mesh = read_mesh(file);
        EXPECT_FALSE(mesh.grid.shapes.empty());
        EXPECT_TRUE(std::string(name).ends_with(".vtk"));
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
    }
  }
}

TEST_F(ReadMesh, SurvivesSpoiledFiles) {
  std::mt19937 random(5);
  for (const auto& [name, whole] :
       {std::pair{"a.vtu", test::small_vtu()}, std::pair{"a.vtk", test::small_vtk()},
        std::pair{"b.vtk", test::small_structured_vtk()}, std::pair{"a.xyz", plot3d_grid({}, 1)},
        std::pair{"b.vtu", test::polyhedron_vtu().text()},
        std::pair{"c.vtk", test::polyhedron_vtk(false)},
        std::pair{"d.vtk", test::polyhedron_vtk(true)}}) {
    // Those of polyhedra take a process each.
    const bool polyhedra = std::string(name) == "b.vtu" || name[0] == 'c' || name[0] == 'd';
    const int rounds = polyhedra ? 12 : 300;
    for (int round = 0; round < rounds; ++round) {
      std::string bytes = whole;
      const int changes = 1 + static_cast<int>(random() % 4);
      for (int i = 0; i < changes; ++i) {
        const std::size_t at = random() % bytes.size();
        switch (random() % 3) {
          case 0:
            bytes[at] = static_cast<char>(random() % 256);
            break;
          case 1:
            bytes[at] = static_cast<char>('0' + random() % 10);
            break;
          default:
            bytes.erase(at, 1 + random() % 5);
            break;
        }
      }
      const fs::path file = write(name, bytes);
      try {
        load_mesh({file, {}, {}});
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
}

// Files of other programs, against the facts that stand in their manifest.

struct Facts {
  const char* file;
  const char* q;
  std::size_t points, cells;
  const char* array;
  double minimum, maximum;
};

class RealMesh : public ::testing::TestWithParam<Facts> {};

TEST_P(RealMesh, IsAsTheManifestSays) {
  const Facts& facts = GetParam();
  const fs::path data = test_data_folder(), path = data / facts.file;
  if (!fs::exists(path)) GTEST_SKIP() << path.string() << " not found";
  MeshReadOptions options;
  if (*facts.q != '\0') options.q = data / facts.q;
  const MeshFile file = read_mesh(path, options);
  EXPECT_EQ(file.grid.points.size(), facts.points);
  EXPECT_EQ(file.grid.shapes.size(), facts.cells);
  double minimum = std::numeric_limits<double>::infinity(), maximum = -minimum;
  for (const double x : values(file, facts.array)) {
    minimum = std::min(minimum, x);
    maximum = std::max(maximum, x);
  }
  EXPECT_NEAR(minimum, facts.minimum, 0.005 * std::abs(facts.maximum - facts.minimum));
  EXPECT_NEAR(maximum, facts.maximum, 0.005 * std::abs(facts.maximum - facts.minimum));
}

INSTANTIATE_TEST_SUITE_P(
    All, RealMesh,
    ::testing::Values(
        Facts{"unstructured/post.vtk", "", 2288, 8750, "Pressure", 0.355, 1.641},
        Facts{"unstructured/output_fem.vtu", "", 21332, 79756, "p", -5.38, 369},
        Facts{"unstructured/output_fem.vtu", "", 21332, 79756, "Umag", 0, 0.522},
        Facts{"unstructured/disk_out_ref.ex2", "", 8499, 7472, "Temp", 293.15, 913.15},
        Facts{"unstructured/disk_out_ref.ex2", "", 8499, 7472, "Pres", 0.0068, 0.0288},
        Facts{"unstructured/can.vtu", "", 6724, 4800, "DISPL", -17.8, 1.18},
        Facts{"unstructured/can.vtu", "", 6724, 4800, "EQPS", 0.0216, 2.894},
        Facts{"unstructured/hexa.vtk", "", 12167, 10648, "scalars", 0.753, 17.32},
        Facts{"unstructured/Tetrahedron.vtu", "", 35, 96, "DistanceToCenter", 0, 1.732},
        Facts{"unstructured/Tetrahedron.vtu", "", 35, 96, "Polynomial", 1, 7},
        Facts{"unstructured/notch_disp.vtu", "", 12717, 2192, "Nodal Displacement", -1.04e-7,
              2.79e-6},
        Facts{"multivariate/kitchen.vtk", "", 11424, 9936, "p1", -0.034, 0.187},
        Facts{"multivariate/kitchen.vtk", "", 11424, 9936, "c12", 1, 8.38e6},
        Facts{"multivariate/plot3d/bluntfinxyz.bin", "multivariate/plot3d/bluntfinq.bin", 40960,
              39 * 31 * 31, "Density", 0.1926, 4.9775},
        Facts{"multivariate/plot3d/combxyz.bin", "multivariate/plot3d/combq.bin", 47025,
              56 * 32 * 24, "Density", 0.1978, 0.7104},
        Facts{"multivariate/plot3d/combxyz.bin", "multivariate/plot3d/combq.bin", 47025,
              56 * 32 * 24, "StagnationEnergy", 0, 0}));

TEST(RealMesh, ExodusKnowsItsTimes) {
  const fs::path path = test_data_folder() / "unstructured/disk_out_ref.ex2";
  if (!fs::exists(path)) GTEST_SKIP() << path.string() << " not found";
  const MeshFile file = read_mesh(path);
  EXPECT_EQ(file.format, "Exodus II");
  EXPECT_EQ(file.times, std::vector<double>{0});
  EXPECT_EQ(file.time, 0);
  EXPECT_EQ(default_array(file).name, "Temp");
  EXPECT_EQ(find(file, "V")->components, 3);
}

class CutExodus : public test::ScratchFolder {};

TEST_F(CutExodus, IsRefused) {
  const fs::path whole = test_data_folder() / "unstructured/disk_out_ref.ex2";
  if (!fs::exists(whole)) GTEST_SKIP() << whole.string() << " not found";
  const std::string bytes = read(whole);
  for (const std::size_t length : {std::size_t{0}, std::size_t{3}, std::size_t{200},
                                   std::size_t{4000}, bytes.size() / 2, bytes.size() - 100}) {
    const fs::path file = write("cut.ex2", bytes.substr(0, length));
    const std::string error = error_of([&] { read_mesh(file); });
    EXPECT_TRUE(error.starts_with(file.string())) << error;
  }
}

#endif

}  // namespace
}  // namespace pellucid::test_read_mesh
