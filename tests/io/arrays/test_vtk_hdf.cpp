// SPDX-License-Identifier: Apache-2.0
#ifdef PELLUCID_HAVE_HDF5

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pellucid/io/mesh_source.h"
#include "pellucid/io/read_mesh.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/io/time_steps.h"
#include "tests/io/scratch_folder.h"
#include "vtk_hdf_files.h"

namespace pellucid::test_vtk_hdf {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::error_of;
using test::VtkHdfWriter;
using Text = VtkHdfWriter::Text;

class VtkHdf : public test::ScratchFolder {};

std::vector<double> numbers(const VolumeData& data) {
  std::vector<double> list;
  std::visit([&](const auto& values) { list.assign(values.begin(), values.end()); }, data);
  return list;
}

std::vector<float> counting(std::size_t count) {
  std::vector<float> list;
  for (std::size_t i = 0; i < count; ++i) list.push_back(static_cast<float>(i));
  return list;
}

/// 3 x 4 x 5 points.
struct ImageFile {
  std::vector<std::int64_t> version{1, 0}, extent{2, 4, 0, 3, 0, 4};
  std::vector<double> direction{0, -1, 0, 1, 0, 0, 0, 0, 1};
  Text text = Text::fixed;
  bool latest = false;
  std::string type = "ImageData";

  void write(const fs::path& path) const {
    VtkHdfWriter file(path, type, text, latest);
    if (!version.empty()) file.attribute("Version", version);
    if (!extent.empty()) file.attribute("WholeExtent", extent);
    file.attribute<double>("Origin", {10, 20, 30});
    file.attribute<double>("Spacing", {0.5, 1, 2});
    file.attribute("Direction", direction);
    file.array("PointData", "a", {5, 4, 3}, std::vector<std::int16_t>(60, 7));
    file.array("PointData", "p", {5, 4, 3}, counting(60), true);
    file.array("PointData", "v", {5, 4, 3, 2}, counting(120));
    file.array("PointData", "tensor", {5, 4, 3, 9}, counting(540));
    file.array("PointData", "odd", {5, 4, 4}, counting(80));
    file.array("CellData", "p", {4, 3, 2}, counting(24));
    file.mark("PointData", "Scalars", "p");
  }
};

TEST_F(VtkHdf, ReadsImages) {
  for (const Text text : {Text::fixed, Text::variable, Text::padded}) {
    for (const bool latest : {false, true}) {
      for (const char* const name : {"a.vtkhdf", "a.hdf", "a.h5", "a.any"}) {
        ImageFile of;
        of.text = text;
        of.latest = latest;
        of.write(path(name));
        EXPECT_FALSE(is_mesh_file(path(name)));
        const Volume volume = read_volume(path(name));
        EXPECT_EQ(volume.description().dimensions, (std::array{3, 4, 5}));
        EXPECT_EQ(type_name(volume.data()), "f32");
        EXPECT_EQ(numbers(volume.data())[59], 59);
        // x runs along the world's y, and begins at the second point.
        const Vec3<double> first = volume.world_from_grid().point({0, 0, 0});
        EXPECT_EQ(first.x, 10);
        EXPECT_EQ(first.y, 21);
        EXPECT_EQ(first.z, 30);
        const Vec3<double> last = volume.world_from_grid().point({2, 3, 4});
        EXPECT_EQ(last.x, 10 - 3);
        EXPECT_EQ(last.y, 22);
        EXPECT_EQ(last.z, 38);
      }
    }
  }
}

TEST_F(VtkHdf, ReadsArraysOfImagesByName) {
  ImageFile().write(path("a.vtkhdf"));
  ReadOptions options;
  options.array = "v";
  EXPECT_EQ(component_count(path("a.vtkhdf"), options), 2);
  options.component = 1;
  EXPECT_EQ(numbers(read_volume(path("a.vtkhdf"), options).data())[3], 7);
  options.array = "tensor";
  options.component = 8;
  EXPECT_EQ(numbers(read_volume(path("a.vtkhdf"), options).data())[1], 17);
  options.component.reset();
  options.array = "p_cell";
  const Volume cells = read_volume(path("a.vtkhdf"), options);
  EXPECT_EQ(cells.description().centering, Centering::cell);
  EXPECT_EQ(cells.description().dimensions, (std::array{2, 3, 4}));
  EXPECT_EQ(cells.world_from_grid().point({0, 0, 0}).y, 21.25);
  EXPECT_EQ(cells.world_from_grid().point({0, 0, 0}).z, 31);
  options.array = "none";
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.vtkhdf"), options); }), "p_cell"));
  options.array = "odd";
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.vtkhdf"), options); }), "4 x 4 x 5"));
  const std::vector<VolumeArray> list = list_arrays(path("a.vtkhdf"));
  ASSERT_EQ(list.size(), 6U);
  EXPECT_TRUE(list[1].is_default);
  EXPECT_EQ(list[1].name, "p");
  EXPECT_EQ(list[2].components.size(), 9U);
  EXPECT_EQ(list[4].name, "p_cell");
  EXPECT_EQ(list[4].components[0].maximum, 23);
  EXPECT_FALSE(list[5].unreadable_reason.empty());
}

TEST_F(VtkHdf, SaysWhatItDoesNotRead) {
  const auto error = [&](const ImageFile& of) {
    of.write(path("a.vtkhdf"));
    return error_of([&] { read_volume(path("a.vtkhdf")); });
  };
  ImageFile of;
  of.type = "PolyData";
  EXPECT_TRUE(contains(error(of), "holds PolyData of VTKHDF; read are ImageData and Unstr"));
  of.type = "OverlappingAMR";
  EXPECT_TRUE(contains(error(of), "holds OverlappingAMR"));
  of.type = "";
  EXPECT_TRUE(contains(error(of), "Type"));
  of = {};
  of.version = {3, 1};
  EXPECT_TRUE(contains(error(of), "of version 3"));
  for (const std::vector<std::int64_t>& known : {std::vector<std::int64_t>{2, 3}, {}}) {
    of.version = known;
    of.write(path("a.vtkhdf"));
    EXPECT_EQ(numbers(read_volume(path("a.vtkhdf")).data())[1], 1);
  }
  of = {};
  of.extent = {0, 0, 0, 3, 0, 4};
  EXPECT_TRUE(contains(error(of), "flat along x"));
  of.extent = {0, -4, 0, 3, 0, 4};
  EXPECT_TRUE(contains(error(of), "WholeExtent"));
  of.extent = {0, 1LL << 40, 0, 3, 0, 4};
  EXPECT_TRUE(contains(error(of), "WholeExtent"));
  of.extent = {0, 7, 0, 3, 0, 4};
  EXPECT_TRUE(contains(error(of), "which is not what its WholeExtent says"));
  of.extent = {};
  EXPECT_TRUE(contains(error(of), "WholeExtent"));
  write("b.vtkhdf", "no such file at all");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("b.vtkhdf")); }), "no VTKHDF file"));
  EXPECT_TRUE(contains(error_of([&] { read_mesh(path("b.vtkhdf")); }), "no VTKHDF file"));
}

/// Two pieces: a hexahedron and a triangle, and a tetrahedron beside it of which a copy is a ghost.
struct MeshFileOf {
  std::vector<std::int64_t> connectivity{0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 0, 1, 2, 3, 0, 1, 2, 3};
  std::vector<std::int64_t> offsets{0, 8, 11, 0, 4, 8};
  std::vector<std::uint8_t> types{12, 5, 10, 10};
  std::vector<std::int64_t> cells{2, 2};
  std::vector<double> points{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1,
                             1, 1, 1, 0, 1, 1, 1, 0, 0, 1, 1, 0, 1, 1, 1, 2, 0, 0};
  std::vector<std::int64_t> points_per_piece{8, 4};
  std::vector<std::uint8_t> cell_flags{0, 0, 0, 1}, point_flags;
  bool without_types = false;

  void write(const fs::path& path) const {
    VtkHdfWriter file(path, "UnstructuredGrid", Text::variable);
    file.attribute<std::int64_t>("Version", {1, 0});
    file.array("", "NumberOfPoints", {points_per_piece.size()}, points_per_piece);
    file.array("", "NumberOfCells", {cells.size()}, cells);
    file.array<std::int64_t>("", "NumberOfConnectivityIds", {2}, {11, 8});
    file.array("", "Points", {points.size() / 3, 3}, points);
    file.array("", "Connectivity", {connectivity.size()}, connectivity);
    file.array("", "Offsets", {offsets.size()}, offsets);
    if (!without_types) file.array("", "Types", {types.size()}, types);
    file.array("PointData", "p", {12}, std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7, 1, 2, 6, 9},
               true);
    file.array("PointData", "v", {12, 3}, counting(36));
    file.array<std::int32_t>("CellData", "id", {4}, {7, 8, 9, 10});
    file.array("CellData", "vtkGhostType", {4}, cell_flags);
    if (!point_flags.empty()) file.array("PointData", "vtkGhostType", {12}, point_flags);
    file.array("FieldData", "time", {1}, std::vector<double>{3});
  }
};

TEST_F(VtkHdf, RefinedCellsAndHiddenPointsHideCells) {
  MeshFileOf of;
  of.cell_flags = {8, 0, 0, 1};
  of.write(path("a.vtkhdf"));
  EXPECT_EQ(read_mesh(path("a.vtkhdf")).grid.shapes, std::vector{CellShape::tetrahedron});
  of.cell_flags = {0, 0, 0, 1};
  of.point_flags = std::vector<std::uint8_t>(12);
  of.point_flags[11] = 2;  // of the second piece, whose points count from 0 again
  of.write(path("a.vtkhdf"));
  EXPECT_EQ(read_mesh(path("a.vtkhdf")).grid.shapes, std::vector{CellShape::hexahedron});
  EXPECT_EQ(read_mesh(path("a.vtkhdf")).ghost_cells, 2U);
}

TEST_F(VtkHdf, ReadsMeshes) {
  for (const char* const name : {"a.vtkhdf", "a.hdf", "a.h5", "a"}) {
    MeshFileOf().write(path(name));
    EXPECT_TRUE(is_mesh_file(path(name))) << name;
    const MeshFile file = read_mesh(path(name));
    EXPECT_EQ(file.format, "VTKHDF");
    EXPECT_EQ(file.blocks, 2);
    EXPECT_EQ(file.grid.shapes, (std::vector{CellShape::hexahedron, CellShape::tetrahedron}));
    EXPECT_EQ(file.flat_cells, 1U);
    EXPECT_EQ(file.ghost_cells, 1U);
    EXPECT_EQ(file.grid.cell_numbers, (std::vector<std::int32_t>{0, 2}));
    EXPECT_EQ(file.discontinuous_points, 3U);  // the vectors differ
    ASSERT_EQ(file.grid.arrays.size(), 3U);
    EXPECT_EQ(file.grid.arrays[0].name, "p");
    EXPECT_EQ(numbers(file.grid.arrays[0].values),
              (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 1, 2, 6, 9}));
    EXPECT_EQ(file.grid.arrays[1].components, 3);
    EXPECT_EQ(numbers(file.grid.arrays[2].values), (std::vector<double>{7, 9}));
    EXPECT_DOUBLE_EQ(load_mesh({path(name), {}, {}}).mesh->mesh().statistics().volume, 1 + 1.0 / 6);
    EXPECT_TRUE(contains(error_of([&] { read_volume(path(name)); }), "is a mesh"));
  }
}

TEST_F(VtkHdf, RefusesMeshesThatContradictThemselves) {
  const auto error = [&](void (*spoil)(MeshFileOf&)) {
    MeshFileOf of;
    spoil(of);
    of.write(path("a.vtkhdf"));
    const std::string text = error_of([&] { load_mesh({path("a.vtkhdf"), {}, {}}); });
    EXPECT_TRUE(text.starts_with(path("a.vtkhdf").string() + ": ")) << text;
    return text;
  };
  EXPECT_TRUE(contains(error([](auto& of) { of.connectivity[3] = 8; }), "has the point 8"));
  EXPECT_TRUE(contains(error([](auto& of) { of.connectivity[3] = -1; }), "has the point -1"));
  EXPECT_TRUE(contains(error([](auto& of) { of.connectivity.resize(15); }), "Connectivity"));
  EXPECT_TRUE(contains(error([](auto& of) { of.offsets[1] = 80; }), "offset"));
  EXPECT_TRUE(contains(error([](auto& of) { of.offsets[1] = -8; }), "offset"));
  EXPECT_TRUE(contains(error([](auto& of) { of.offsets.resize(4); }), "Offsets"));
  EXPECT_TRUE(contains(error([](auto& of) { of.types.resize(3); }), "there are 3 cells"));
  EXPECT_TRUE(contains(error([](auto& of) { of.types[0] = 99; }), "number 99"));
  EXPECT_TRUE(contains(error([](auto& of) { of.types[0] = 42; }), "without its faces"));
  EXPECT_TRUE(contains(error([](auto& of) { of.types[0] = 25; }), "has 8 points"));
  EXPECT_TRUE(contains(error([](auto& of) { of.without_types = true; }), "no array Types"));
  EXPECT_TRUE(contains(error([](auto& of) { of.points_per_piece = {8, 5}; }), "Points"));
  EXPECT_TRUE(contains(error([](auto& of) { of.points_per_piece = {8, -4}; }), "Points"));
  EXPECT_TRUE(contains(error([](auto& of) { of.cells = {2, 2, 0}; }), "pieces"));
  EXPECT_TRUE(contains(error([](auto& of) { of.cells = {2, 1LL << 60}; }), "whole number"));
  EXPECT_TRUE(contains(error([](auto& of) { of.cells = {2, 1LL << 50}; }), "Types"));
  EXPECT_TRUE(contains(error([](auto& of) { of.points.resize(33); }), "there are 11 points"));
}

TEST_F(VtkHdf, SurvivesFilesThatAreCutOffOrSpoiled) {
  MeshFileOf().write(path("mesh.vtkhdf"));
  ImageFile().write(path("image.vtkhdf"));
  unsigned state = 1;
  const auto random = [&] { return state = state * 1664525 + 1013904223; };
  for (const char* const name : {"mesh.vtkhdf", "image.vtkhdf"}) {
    const std::string whole = read(path(name));
    constexpr int cuts = 6, rounds = 20;  // each takes a process or two
    for (int round = 0; round < rounds; ++round) {
      std::string bytes = whole;
      if (round < cuts) {
        bytes.resize(whole.size() * static_cast<std::size_t>(round) / cuts);
      } else {
        for (int i = 0; i < 8; ++i) {
          bytes[random() / 7 % bytes.size()] = static_cast<char>(random() >> 24);
        }
      }
      const fs::path file = write("a.vtkhdf", bytes);
      try {
        if (name[0] == 'm') {
          load_mesh({file, {}, {}});
        } else {
          read_volume(file);
        }
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
}

/// A file of three steps, 3, 1 and 2, with a group Steps.
void write_steps(VtkHdfWriter& file, const std::string& list = "",
                 const std::vector<std::int64_t>& offsets = {}) {
  file.attribute<std::int64_t>("NSteps", {3}, "Steps");
  file.array<double>("Steps", "Values", {3}, {3, 1, 2});
  if (!list.empty())
    file.array("Steps/" + list.substr(0, list.find('/')), list.substr(list.find('/') + 1), {3},
               offsets);
}

TEST_F(VtkHdf, StepsOfImagesAreFoundByTheirTimes) {
  for (const bool has_offsets : {false, true}) {
    {
      VtkHdfWriter file(path("t.vtkhdf"), "ImageData");
      file.attribute<std::int64_t>("Version", {2, 0});
      file.attribute<std::int64_t>("WholeExtent", {0, 3, 0, 2, 0, 1});
      std::vector<float> p(72);
      for (std::size_t i = 0; i < 72; ++i) p[i] = static_cast<float>(i);
      file.array("PointData", "p", {3, 2, 3, 4}, p);
      file.array("PointData", "v", {3, 2, 3, 4, 2}, counting(144));
      file.mark("PointData", "Scalars", "p");
      if (has_offsets) {
        write_steps(file, "PointDataOffsets/p", {2, 0, 1});
      } else {
        write_steps(file);
      }
    }
    EXPECT_FALSE(is_mesh_file(path("t.vtkhdf")));
    FieldSource source;
    source.file = path("t.vtkhdf");
    EXPECT_EQ(source_times(source), (std::vector<double>{1, 2, 3}));
    // The places of the times 1, 2 and 3.
    const std::vector<double> places =
        has_offsets ? std::vector<double>{0, 1, 2} : std::vector<double>{1, 2, 0};
    for (std::size_t i = 0; i < 3; ++i) {
      ReadOptions options;
      options.time = static_cast<double>(i + 1);
      EXPECT_EQ(numbers(read_volume(path("t.vtkhdf"), options).data())[5], 24 * places[i] + 5);
      options.array = "v";
      EXPECT_EQ(read_components(path("t.vtkhdf"), options).size(), 2U);
      EXPECT_EQ(numbers(read_components(path("t.vtkhdf"), options)[1].data())[5],
                48 * (has_offsets ? std::vector<double>{1, 2, 0} : places)[i] + 11);
    }
    ReadOptions between;
    between.time = 1.25;
    between.time_between = TimeBetween::linear;
    EXPECT_EQ(numbers(read_volume(path("t.vtkhdf"), between).data())[5],
              0.75 * (24 * places[0] + 5) + 0.25 * (24 * places[1] + 5));
    EXPECT_EQ(list_arrays(path("t.vtkhdf")).size(), 2U);
  }
  VtkHdfWriter file(path("cut.vtkhdf"), "ImageData");
  file.attribute<std::int64_t>("WholeExtent", {0, 3, 0, 2, 0, 1});
  file.array("PointData", "p", {2, 2, 3, 4}, counting(48));
  write_steps(file);
  file.close();
  ReadOptions last;
  last.time = 2;
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("cut.vtkhdf"), last); }), "ends before"));
}

/// Two tetrahedra in two parts at 3 and 2, one at 1; the points at 2 are those of 3.
void write_mesh_steps(const fs::path& path) {
  VtkHdfWriter file(path, "UnstructuredGrid");
  file.attribute<std::int64_t>("Version", {2, 0});
  write_steps(file);
  file.array<std::int64_t>("Steps", "PartOffsets", {3}, {0, 2, 0});
  file.array<std::int64_t>("Steps", "NumberOfParts", {3}, {2, 1, 2});
  file.array<std::int64_t>("Steps", "PointOffsets", {3}, {0, 8, 0});
  file.array<std::int64_t>("Steps", "CellOffsets", {3, 1}, {0, 2, 0});
  file.array<std::int64_t>("Steps", "ConnectivityIdOffsets", {3, 1}, {0, 8, 0});
  file.array<std::int64_t>("Steps/PointDataOffsets", "p", {3}, {0, 8, 12});
  file.array<std::int64_t>("Steps/CellDataOffsets", "c", {3}, {0, 2, 3});
  file.array<std::int64_t>("", "NumberOfPoints", {3}, {4, 4, 4});
  file.array<std::int64_t>("", "NumberOfCells", {3}, {1, 1, 1});
  file.array<std::int64_t>("", "NumberOfConnectivityIds", {3}, {4, 4, 4});
  std::vector<double> points;
  for (const double x : {0.0, 5.0, 9.0}) {
    for (const std::array<double, 3>& p :
         {std::array{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}) {
      points.insert(points.end(), {x + p[0], p[1], p[2]});
    }
  }
  file.array("", "Points", {12, 3}, points);
  file.array<std::int64_t>("", "Connectivity", {12}, {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3});
  file.array<std::int64_t>("", "Offsets", {6}, {0, 4, 0, 4, 0, 4});
  file.array<std::uint8_t>("", "Types", {3}, {10, 10, 10});
  file.array("PointData", "p", {20}, counting(20));
  file.array<std::int32_t>("CellData", "c", {5}, {30, 31, 10, 20, 21});
}

TEST_F(VtkHdf, StepsOfMeshesAreFoundByTheirTimes) {
  write_mesh_steps(path("m.vtkhdf"));
  MeshSource source;
  source.file = path("m.vtkhdf");
  EXPECT_EQ(source_times(source), (std::vector<double>{1, 2, 3}));
  const auto at = [&](std::optional<double> time) {
    MeshReadOptions options;
    options.time = time;
    return read_mesh(path("m.vtkhdf"), options);
  };
  const MeshFile one = at(1), two = at(2), three = at(3);
  EXPECT_EQ(at(std::nullopt).time, 3);  // the first of the file
  EXPECT_EQ(one.times, (std::vector<double>{1, 2, 3}));
  ASSERT_EQ(one.grid.points.size(), 4U);
  EXPECT_EQ(one.grid.points[1].x, 10);
  EXPECT_EQ(numbers(one.grid.arrays[0].values), (std::vector<double>{8, 9, 10, 11}));
  EXPECT_EQ(numbers(one.grid.arrays[1].values), std::vector<double>{10});
  ASSERT_EQ(two.grid.points.size(), 8U);
  EXPECT_EQ(two.grid.points[5].x, 6);
  EXPECT_EQ(numbers(two.grid.arrays[0].values)[7], 19);
  EXPECT_EQ(numbers(two.grid.arrays[1].values), (std::vector<double>{20, 21}));
  EXPECT_EQ(numbers(three.grid.arrays[0].values)[7], 7);
  EXPECT_EQ(numbers(three.grid.arrays[1].values), (std::vector<double>{30, 31}));
  // Linear between 2 and 3, which have one mesh; not between 1 and 2.
  MeshReadOptions between;
  between.time_between = TimeBetween::linear;
  between.time = 2.25;
  const MeshFile mixed = read_mesh(path("m.vtkhdf"), between);
  EXPECT_EQ(mixed.time, 2.25);
  EXPECT_EQ(numbers(mixed.grid.arrays[0].values)[7], 0.75 * 19 + 0.25 * 7);
  EXPECT_EQ(numbers(mixed.grid.arrays[1].values), (std::vector<double>{22.5, 23.5}));
  between.time = 1.5;
  EXPECT_TRUE(contains(error_of([&] { read_mesh(path("m.vtkhdf"), between); }),
                       "different points or cells"));
}

}  // namespace
}  // namespace pellucid::test_vtk_hdf

#endif
