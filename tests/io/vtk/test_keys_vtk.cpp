// SPDX-License-Identifier: Apache-2.0
//
// The rows of the table of keys for VTK's files and Exodus II.
#include <cmath>
#include <string>
#include <vector>

#include "exodus_files.h"
#include "mesh_files.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/described_keys.h"

namespace pellucid::test_keys_vtk {
namespace {

#ifdef PELLUCID_HAVE_VTK
constexpr bool has_vtk = true;
#else
constexpr bool has_vtk = false;
#endif

using test::value_at;
using test::world_of;
using test::xml_array;

/// 2 x 2 x 2 points with the values 0 to 7.
std::string image(const std::string& attributes, const std::string& more = "",
                  const std::string& in_point_data = "", const std::string& whole = "0 1 0 1 0 1") {
  return test::xml_file("ImageData", "<ImageData WholeExtent=\"" + whole + "\" " + attributes +
                                         "><Piece Extent=\"0 1 0 1 0 1\"><PointData" +
                                         in_point_data + ">" +
                                         xml_array("Float32", "v", "0 1 2 3 4 5 6 7") + more +
                                         "</PointData></Piece></ImageData>\n");
}

std::string legacy(const std::string& head) {
  return "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET STRUCTURED_POINTS\n" + head +
         "POINT_DATA 8\nSCALARS v float 1\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7\n";
}

PELLUCID_DESCRIBED_KEY(vtk_whole_extent, "VTK files", "WholeExtent", refused) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  expect_refused(
      [&] { read_volume(write("a.vti", image("Origin=\"0 0 0\"", "", "", "0 1 0 1 0 2"))); },
      "extent 0 1 0 1 0 2");
}

PELLUCID_DESCRIBED_KEY(vtk_extent, "VTK files", "Extent", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  std::string text = image("Origin=\"0 0 0\" Spacing=\"1 1 1\"");
  for (std::size_t at = 0; (at = text.find("0 1 0 1 0 1", at)) != text.npos;) {
    text.replace(at, 11, "5 6 0 1 0 1");
  }
  EXPECT_EQ(world_of(read_volume(write("a.vti", text)), 0, 0, 0).x, 5);
}

PELLUCID_DESCRIBED_KEY(vtk_origin, "VTK files", "Origin", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const Volume volume = read_volume(write("a.vti", image("Origin=\"4 5 6\" Spacing=\"1 1 1\"")));
  EXPECT_EQ(world_of(volume, 0, 0, 0).z, 6);
}

PELLUCID_DESCRIBED_KEY(vtk_spacing, "VTK files", "Spacing", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const Volume volume = read_volume(write("a.vti", image("Origin=\"0 0 0\" Spacing=\"1 2 3\"")));
  EXPECT_EQ(world_of(volume, 1, 1, 1).y, 2);
}

PELLUCID_DESCRIBED_KEY(vtk_direction, "VTK files", "Direction", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const Volume volume = read_volume(
      write("a.vti", image("Origin=\"0 0 0\" Spacing=\"1 1 1\" Direction=\"0 -1 0 1 0 0 0 0 1\"")));
  EXPECT_EQ(world_of(volume, 1, 0, 0).y, 1);
}

PELLUCID_DESCRIBED_KEY(vtk_scalars, "VTK files", "Scalars", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const std::string second = xml_array("Float32", "w", "9 9 9 9 9 9 9 9");
  const Volume volume =
      read_volume(write("a.vti", image("Origin=\"0 0 0\"", second, " Scalars=\"w\"")));
  EXPECT_EQ(value_at(volume, 0, 0, 0), 9);
}

PELLUCID_DESCRIBED_KEY(vtk_ghost_type, "VTK files", "vtkGhostType", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const Volume volume = read_volume(write(
      "a.vti", image("Origin=\"0 0 0\"", xml_array("UInt8", "vtkGhostType", "0 2 0 0 0 0 0 0"))));
  EXPECT_TRUE(std::isnan(value_at(volume, 1, 0, 0)));
}

PELLUCID_DESCRIBED_KEY(vtk_ghost_levels, "VTK files", "vtkGhostLevels", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  test::SmallVtu of;
  of.more = xml_array("UInt8", "vtkGhostLevels", "1 0 0");
  EXPECT_EQ(read_mesh(write("a.vtu", test::small_vtu(of))).grid.shapes.size(), 1U);
}

PELLUCID_DESCRIBED_KEY(vtk_degrees, "VTK files", "HIGHER_ORDER_DEGREES", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  // A hexahedron of the orders 2, 1 and 1, whose 12 points no other orders have.
  test::AnyVtu of;
  of.points = "0 0 0 2 0 0 2 1 0 0 1 0 0 0 1 2 0 1 2 1 1 0 1 1 1 0 0 1 1 0 1 0 1 1 1 1";
  of.connectivity = "0 1 2 3 4 5 6 7 8 9 10 11";
  of.point_count = 12;
  of.cell_count = 1;
  of.offsets = "12";
  of.types = "72";
  of.cell_data =
      "<CellData>" + xml_array("Float64", "HIGHER_ORDER_DEGREES", "2 1 1", 3) + "</CellData>";
  const MeshFile file = read_mesh(write("a.vtu", of.text()));
  EXPECT_EQ(file.grid.layouts, (std::vector<std::int32_t>{12, 2, 1, 1}));
}

PELLUCID_DESCRIBED_KEY(vtk_legacy_dimensions, "VTK files", "DIMENSIONS", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const Volume volume =
      read_volume(write("a.vtk", legacy("DIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n")));
  EXPECT_EQ(value_at(volume, 1, 1, 1), 7);
}

PELLUCID_DESCRIBED_KEY(vtk_legacy_spacing, "VTK files", "SPACING", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const Volume volume =
      read_volume(write("a.vtk", legacy("DIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 2 3\n")));
  EXPECT_EQ(world_of(volume, 1, 1, 1).z, 3);
}

PELLUCID_DESCRIBED_KEY(vtk_legacy_aspect, "VTK files", "ASPECT_RATIO", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const Volume volume =
      read_volume(write("a.vtk", legacy("DIMENSIONS 2 2 2\nORIGIN 0 0 0\nASPECT_RATIO 1 2 3\n")));
  EXPECT_EQ(world_of(volume, 1, 1, 1).z, 3);
}

PELLUCID_DESCRIBED_KEY(vtk_legacy_origin, "VTK files", "ORIGIN", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  const Volume volume =
      read_volume(write("a.vtk", legacy("DIMENSIONS 2 2 2\nORIGIN 4 5 6\nSPACING 1 1 1\n")));
  EXPECT_EQ(world_of(volume, 0, 0, 0).x, 4);
}

PELLUCID_DESCRIBED_KEY(vtk_time_step, "VTK files", "timestep", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  write("a.vtu", test::small_vtu());
  test::SmallVtu later;
  later.values = "5 6 7 8 9";
  write("b.vtu", test::small_vtu(later));
  const auto list =
      write("a.pvd", test::xml_file("Collection",
                                    "<Collection><DataSet timestep=\"0\" file=\"a.vtu\"/><DataSet "
                                    "timestep=\"2\" file=\"b.vtu\"/></Collection>\n"));
  EXPECT_EQ(read_mesh(list, {2.0, {}, {}}).time, 2);
}

PELLUCID_DESCRIBED_KEY(vtk_header_type, "VTK files", "header_type", refused) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  // A header of 64 bits, where none is said, and which means 32.
  std::string text = image("Origin=\"0 0 0\"");
  const std::string values = xml_array("Float32", "v", "0 1 2 3 4 5 6 7");
  text.replace(text.find(values), values.size(),
               "<DataArray type=\"UInt8\" Name=\"v\" "
               "format=\"binary\">CAAAAAAAAAAAAQIDBAUGBw==</DataArray>");
  expect_refused([&] { read_volume(write("a.vti", text)); }, "header_type=\"UInt64\"");
}

PELLUCID_DESCRIBED_KEY(vtk_offset, "VTK files", "offset", refused) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  std::string text = image("Origin=\"0 0 0\"");
  const std::string values = xml_array("Float32", "v", "0 1 2 3 4 5 6 7");
  text.replace(text.find(values), values.size(),
               "<DataArray type=\"Float32\" Name=\"v\" format=\"appended\" offset=\"-4\"/>");
  text.insert(text.find("</VTKFile>"), "<AppendedData encoding=\"raw\">_12345678</AppendedData>");
  expect_refused([&] { read_volume(write("a.vti", text)); }, "the offset \"-4\"");
}

/// An image of two steps in time: 0 to 7 at the time 1, and 9 at the time 4.
std::string image_of_steps() {
  std::string text = image("TimeValues=\"1 4\"", xml_array("Float32", "v", "9 9 9 9 9 9 9 9"));
  const std::size_t first = text.find("Name=\"v\"");
  text.insert(text.find("Name=\"v\"", first + 1), "TimeStep=\"1\" ");
  text.insert(first, "TimeStep=\"0\" ");
  return text;
}

PELLUCID_DESCRIBED_KEY(vtk_time_values, "VTK files", "TimeValues", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  ReadOptions options;
  options.time = 3.9;
  EXPECT_EQ(value_at(read_volume(write("a.vti", image_of_steps()), options), 0, 0, 0), 9);
}

PELLUCID_DESCRIBED_KEY(vtk_time_steps, "VTK files", "TimeStep", honored) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  EXPECT_EQ(value_at(read_volume(write("a.vti", image_of_steps())), 1, 1, 1), 7);
}

PELLUCID_DESCRIBED_KEY(vtk_pieces, "VTK files", "Piece", told) {
  if (!has_vtk) GTEST_SKIP() << "this build does not read VTK files";
  write("a.vti", image("Origin=\"0 0 0\""));
  std::string other = image("Origin=\"0 0 0\"");
  other.replace(other.find("6 7"), 3, "6 5");
  write("b.vti", other);
  const auto list = write(
      "a.pvti",
      test::xml_file("PImageData",
                     "<PImageData WholeExtent=\"0 1 0 1 0 1\"><PPointData><PDataArray "
                     "type=\"Float32\" Name=\"v\"/></PPointData><Piece Extent=\"0 1 0 1 0 1\" "
                     "Source=\"a.vti\"/><Piece Extent=\"0 1 0 1 0 1\" Source=\"b.vti\"/>"
                     "</PImageData>\n"));
  std::vector<std::string> notes;
  ReadOptions options;
  options.note = [&](const std::string& note) { notes.push_back(note); };
  read_volume(list, options);
  expect_told(notes, "disagree about 1 value");
}

std::vector<std::string> notes_of(const test::SmallExodus& of, const std::filesystem::path& path,
                                  double time = 0) {
  of.write(path);
  return read_mesh(path, {time, {}, {}}).notes;
}

PELLUCID_DESCRIBED_KEY(exodus_file_size, "Exodus II", "file_size", told) {
  if (!test::has_exodus) GTEST_SKIP() << "this build does not read Exodus files";
  test::SmallExodus of;
  of.has_file_size = of.has_axes = false;
  expect_told(notes_of(of, path("a.e")), "file_size");
}

PELLUCID_DESCRIBED_KEY(exodus_names, "Exodus II", "name_nod_var", honored) {
  if (!test::has_exodus) GTEST_SKIP() << "this build does not read Exodus files";
  test::SmallExodus of;
  of.nodal = {"pressure"};
  of.write(path("a.e"));
  EXPECT_EQ(read_mesh(path("a.e")).grid.arrays.at(0).name, "pressure");
}

PELLUCID_DESCRIBED_KEY(exodus_displacement, "Exodus II", "DISPL", honored) {
  if (!test::has_exodus) GTEST_SKIP() << "this build does not read Exodus files";
  test::SmallExodus of;
  of.nodal = {"DISPLX", "DISPLY", "DISPLZ"};
  of.write(path("a.e"));
  EXPECT_EQ(read_mesh(path("a.e")).grid.points[1].x, 2);
}

PELLUCID_DESCRIBED_KEY(exodus_time, "Exodus II", "time_whole", honored) {
  if (!test::has_exodus) GTEST_SKIP() << "this build does not read Exodus files";
  test::SmallExodus of;
  of.steps = of.written_steps = 3;
  of.write(path("a.e"));
  EXPECT_EQ(read_mesh(path("a.e"), {1.0, {}, {}}).time, 1);
}

PELLUCID_DESCRIBED_KEY(exodus_fill, "Exodus II", "vals_nod_var1", told) {
  if (!test::has_exodus) GTEST_SKIP() << "this build does not read Exodus files";
  test::SmallExodus of;
  of.steps = 2;
  of.written_steps = 1;
  expect_told(notes_of(of, path("a.e"), 0.5), "never written");
}

}  // namespace
}  // namespace pellucid::test_keys_vtk
