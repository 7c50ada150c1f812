// SPDX-License-Identifier: Apache-2.0
#include "exodus_files.h"

#include <cmath>
#include <string>
#include <vector>

#include "mesh_files.h"
#include "pellucid/io/read_mesh.h"
#include "tests/io/scratch_folder.h"

#if defined(PELLUCID_HAVE_VTK) && defined(PELLUCID_HAVE_NETCDF)

namespace pellucid::test_exodus {
namespace {

using test::contains;
using test::error_of;
using test::SmallExodus;

class Exodus : public test::ScratchFolder {
 protected:
  MeshFile read_mesh_of(const SmallExodus& of, std::optional<double> time = {}) const {
    of.write(path("a.e"));
    return read_mesh(path("a.e"), {time, {}, {}});
  }
  /// The values of an array; none where there is no such array.
  static std::vector<double> values(const MeshFile& file, const std::string& name) {
    std::vector<double> list;
    for (const MeshArray& array : file.grid.arrays) {
      if (array.name != name) continue;
      std::visit([&](const auto& data) { list.assign(data.begin(), data.end()); }, array.values);
    }
    return list;
  }
  static std::string notes(const MeshFile& file) {
    std::string all;
    for (const std::string& note : file.notes) {
      EXPECT_FALSE(contains(note, "\n")) << note;
      all += note + "\n";
    }
    return all;
  }
};

TEST_F(Exodus, ReadsValuesOfNodesAndElements) {
  SmallExodus of;
  of.nodal = {"T", "p"};
  of.of_elements = {"e"};
  of.steps = of.written_steps = 2;
  const MeshFile file = read_mesh_of(of, 0.5);
  EXPECT_EQ(values(file, "T"), (std::vector<double>{100, 101, 102, 103, 104, 105, 106, 107}));
  EXPECT_EQ(values(file, "p")[7], 117);
  EXPECT_EQ(values(file, "e"), std::vector<double>{1000});
  EXPECT_EQ(notes(file), "");
}

// VTK takes what lies in memory behind the last node.
TEST_F(Exodus, NodesThatAreNotThereAreRefused) {
  for (const int corner : {9, 1000000, 2147483647}) {
    SmallExodus of;
    of.last_corner = corner;
    const std::string error = error_of([&] { read_mesh_of(of); });
    EXPECT_TRUE(contains(error, "has the node " + std::to_string(corner) + ", but there are 8"))
        << error;
  }
}

// meshio writes such files: their values are in arrays that the library does not look for.
TEST_F(Exodus, LeavesOutVariablesWithoutValuesAndSaysSo) {
  SmallExodus of;
  of.has_file_size = of.has_axes = false;
  of.of_elements = {"e"};
  const MeshFile file = read_mesh_of(of);
  EXPECT_TRUE(values(file, "T").empty());
  EXPECT_EQ(values(file, "e"), std::vector<double>{1000});
  EXPECT_TRUE(contains(notes(file), "\"T\"") && contains(notes(file), "file_size")) << notes(file);
  // Vectors, whose components have names of their own, and several of them.
  of.nodal = {"V_x", "V_y", "V_z", "T", "U_x", "U_y", "U_z"};
  of.of_elements = {};
  const MeshFile vectors = read_mesh_of(of);
  EXPECT_TRUE(vectors.grid.arrays.empty());
  EXPECT_TRUE(contains(notes(vectors), "7 variables")) << notes(vectors);
  // In floats, and a step that is not the first.
  of.nodal = {"T"};
  of.in_floats = true;
  of.steps = of.written_steps = 3;
  EXPECT_TRUE(values(read_mesh_of(of, 1.0), "T").empty());
  // Nor are places found in arrays of their own.
  of.has_axes = true;
  const std::string error = test::error_of([&] { read_mesh_of(of); });
  EXPECT_TRUE(contains(error, "places of its nodes") && contains(error, "file_size")) << error;
}

TEST_F(Exodus, ValuesThatWereNeverWrittenAreMissing) {
  for (const bool in_floats : {false, true}) {
    SmallExodus of;
    of.in_floats = in_floats;
    of.of_elements = {"e"};
    of.steps = 2;
    of.written_steps = 1;
    const MeshFile first = read_mesh_of(of, 0.0);
    EXPECT_EQ(values(first, "T")[7], 7);
    EXPECT_EQ(notes(first), "");
    const MeshFile last = read_mesh_of(of, 0.5);
    for (const double value : values(last, "T")) EXPECT_TRUE(std::isnan(value));
    EXPECT_TRUE(std::isnan(values(last, "e").at(0)));
    EXPECT_TRUE(contains(notes(last), "9 values of this step were never written")) << notes(last);
    EXPECT_TRUE(contains(notes(last), "\"T\"")) << notes(last);
  }
}

TEST_F(Exodus, DisplacementsThatWereNeverWrittenMoveNothing) {
  SmallExodus of;
  of.nodal = {"DISPLX", "DISPLY", "DISPLZ", "T"};
  of.steps = 2;
  of.written_steps = 1;
  EXPECT_EQ(read_mesh_of(of, 0.0).grid.points[1].x, 2);  // 1 beside the displacement 1
  const MeshFile last = read_mesh_of(of, 0.5);
  EXPECT_EQ(last.grid.points[1].x, 1);
  EXPECT_EQ(last.grid.shapes.size(), 1U);
  EXPECT_TRUE(contains(notes(last), "the points are not displaced")) << notes(last);
  EXPECT_EQ(last.notes.size(), 1U);
}

TEST_F(Exodus, StepsWithoutATimeAreNotRead) {
  SmallExodus of;
  of.steps = 3;
  of.written_steps = 2;
  of.has_last_time = false;
  const MeshFile file = read_mesh_of(of, 100.0);
  EXPECT_EQ(file.times, (std::vector<double>{0, 0.5}));
  EXPECT_EQ(file.time, 0.5);
  EXPECT_EQ(values(file, "T")[0], 100);
  EXPECT_TRUE(contains(notes(file), "1 of 3 steps have no time")) << notes(file);
  of.steps = 1;
  of.written_steps = 0;
  EXPECT_TRUE(contains(test::error_of([&] { read_mesh_of(of); }), "none of its steps"));
}

}  // namespace
}  // namespace pellucid::test_exodus

#endif
