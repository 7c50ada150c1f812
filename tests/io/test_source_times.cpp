// SPDX-License-Identifier: Apache-2.0

// Times of a source without its values.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "image_files.h"
#include "pellucid/io/time_steps.h"
#include "tests/io/arrays/hdf5_files.h"
#include "tests/io/arrays/net_cdf_files.h"
#include "tests/io/arrays/zarr_files.h"
#include "tests/io/vtk/exodus_files.h"
#include "tests/io/vtk/mesh_files.h"

namespace pellucid::test_source_times {
namespace {

namespace fs = std::filesystem;

using test::bytes_of;
using test::contains;
using test::described_tiff;
using test::error_of;
using Times = std::vector<double>;

class SourceTimes : public test::ScratchFolder {
 protected:
  static Times field(const fs::path& file, const ReadOptions& options = {}) {
    FieldSource source;
    source.file = file;
    source.options = options;
    return source_times(source);
  }
  /// Expects that each of the steps 3, 1 and 2, in this order in the file, has ten times its time.
  static void expect_steps(const fs::path& file) {
    EXPECT_EQ(field(file), (Times{1, 2, 3})) << file;
    for (const double time : {1.0, 2.0, 3.0, 1.2, 1.5, 2.5, 2.6, -9.0, 99.0, -1e17, 1e17}) {
      ReadOptions options;
      options.time = time;
      const double nearest = std::min(std::max(std::ceil(time - 0.5), 1.0), 3.0);
      EXPECT_EQ(test::value_at(read_volume(file, options), 1, 0, 1), 10 * nearest) << file << time;
    }
    ReadOptions between;
    between.time = 2.25;
    between.time_between = TimeBetween::linear;
    EXPECT_EQ(test::value_at(read_volume(file, between), 1, 0, 1), 22.5) << file;
  }
  /// Returns values of these steps, eight each.
  template <class Value>
  static std::vector<Value> values() {
    std::vector<Value> list;
    for (const int value : {30, 10, 20}) list.insert(list.end(), 8, static_cast<Value>(value));
    return list;
  }
  static Times mesh(const fs::path& file) {
    MeshSource source;
    source.file = file;
    return source_times(source);
  }
};

TEST_F(SourceTimes, FilesWithoutSteps) {
  EXPECT_EQ(source_times(parse_field_source("builtin:ramp:8")), Times{});
  EXPECT_EQ(field(write("a.tif", described_tiff(2, "ImageJ=1.53t\nimages=2\nslices=2\n"))),
            Times{});
  EXPECT_TRUE(contains(error_of([&] { field(path("none.nc")); }), "none.nc"));
  EXPECT_TRUE(contains(error_of([&] { mesh(path("none.pvd")); }), "none.pvd"));
}

TEST_F(SourceTimes, Tiff) {
  const auto file = write(
      "a.tif", described_tiff(6, "ImageJ=1.53t\nimages=6\nslices=2\nframes=3\nfinterval=2.5\n"));
  EXPECT_EQ(field(file), (Times{0, 2.5, 5}));
  ReadOptions options;
  options.time = 5;
  int notes = 0;
  options.note = [&](const std::string&) { ++notes; };
  EXPECT_EQ(field(file, options), (Times{0, 2.5, 5}));
  EXPECT_EQ(notes, 0);
}

#ifdef PELLUCID_HAVE_NETCDF
TEST_F(SourceTimes, NetCdf) {
  test::ClassicFile classic;
  classic.axes = {{"time", 4}, {"z", 2}, {"y", 2}, {"x", 2}};
  classic.variables = {{"v", 'f', {"time", "z", "y", "x"}, std::vector<double>(32, 1)},
                       {"time", 'd', {"time"}, {3, 1, 2, 1}}};
  EXPECT_EQ(field(write("a.nc", classic.bytes())), (Times{1, 2, 3}));
  classic.axes[0].second = 3;
  classic.variables[0].values = values<double>();
  classic.variables[1].values = {3, 1, 2};
  expect_steps(write("a.nc", classic.bytes()));
  // In any place among the axes, and with the unit of CF in the notes.
  test::ClassicFile last;
  last.axes = {{"z", 2}, {"y", 2}, {"x", 2}, {"time", 3}};
  std::vector<double> turned;
  for (int i = 0; i < 8; ++i) turned.insert(turned.end(), {30, 10, 20});
  last.variables = {{"v", 'f', {"z", "y", "x", "time"}, turned},
                    {"time", 'd', {"time"}, {3, 1, 2}}};
  last.variables[1].attributes = {{"units", "hours since 2000-01-01"}};
  expect_steps(write("b.nc", last.bytes()));
  std::string notes;
  ReadOptions telling;
  telling.note = [&](const std::string& text) { notes += text; };
  telling.time = 2;
  read_volume(path("b.nc"), telling);
  EXPECT_TRUE(contains(notes, "time 2 hours since 2000-01-01")) << notes;
  const double none = std::numeric_limits<double>::quiet_NaN();
  classic.axes[0].second = 4;
  classic.variables[0].values = std::vector<double>(32, 1);
  classic.variables[1].values = {none, none, 7, none};
  EXPECT_EQ(field(write("a.nc", classic.bytes())), Times{7});
  classic.variables[1].values = {none, none, none, none};
  EXPECT_EQ(field(write("a.nc", classic.bytes())), Times{});
  telling.time = 7;
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.nc"), telling); }),
                       "their times are missing (NaN)"));
}
#endif

#ifdef PELLUCID_HAVE_HDF5
TEST_F(SourceTimes, Hdf5) {
  {
    const test::Hdf5Writer file(path("a.h5"));
    file.add("v", H5T_NATIVE_FLOAT, {3, 2, 2, 2}, values<double>());
    file.attach_labels("v", {"time", "z", "y", "x"});
    file.add("time", H5T_NATIVE_DOUBLE, {3}, {3, 1, 2});
    file.attach_scales("v", {"time", "", "", ""});
  }
  expect_steps(path("a.h5"));
}
#endif

TEST_F(SourceTimes, Zarr) {
  test::ZarrStore store;
  store.shape = store.chunk = {3, 2, 2, 2};
  store.write_2(path("a.zarr/v"), bytes_of(values<float>()), 4);
  store.shape = store.chunk = {3};
  store.write_2(path("a.zarr/time"), bytes_of(std::vector<float>{3, 1, 2}), 4);
  std::ofstream(path("a.zarr/.zgroup")) << "{\"zarr_format\": 2}";
  std::ofstream(path("a.zarr/time/.zattrs")) << R"({"_ARRAY_DIMENSIONS": ["time"]})";
  std::ofstream(path("a.zarr/v/.zattrs")) << R"({"_ARRAY_DIMENSIONS": ["time", "z", "y", "x"]})";
  expect_steps(path("a.zarr"));
}

#ifdef PELLUCID_HAVE_VTK
std::string image_of_steps() {
  std::string image =
      "<ImageData WholeExtent=\"0 1 0 1 0 1\" TimeValues=\"3 1 2\">"
      "<Piece Extent=\"0 1 0 1 0 1\"><PointData Scalars=\"v\">";
  for (int step = 0; step < 3; ++step) {
    image += "<DataArray type=\"Float32\" Name=\"v\" TimeStep=\"" + std::to_string(step) +
             "\" format=\"ascii\">";
    const std::string value = step == 0 ? "30 " : step == 1 ? "10 " : "20 ";
    for (int i = 0; i < 8; ++i) image += value;
    image += "</DataArray>";
  }
  return test::xml_file("ImageData", image + "</PointData></Piece></ImageData>");
}

TEST_F(SourceTimes, VtkXml) {
  expect_steps(write("a.vti", image_of_steps()));
  std::string grid = test::small_vtu();
  grid.replace(grid.find("<UnstructuredGrid>"), 18, "<UnstructuredGrid TimeValues=\"3 1 2\">");
  EXPECT_EQ(mesh(write("a.vtu", grid)), (Times{1, 2, 3}));
  EXPECT_EQ(mesh(write("b.vtu", test::small_vtu())), Times{});
}

TEST_F(SourceTimes, Collections) {
  write("m.vtu", test::small_vtu());
  const auto list = [&](const std::string& name, const std::vector<std::string>& times) {
    std::string inside = "<Collection>";
    for (const std::string& time : times) {
      inside += "<DataSet timestep=\"" + time + "\" file=\"m.vtu\"/>";
    }
    return write(name, test::xml_file("Collection", inside + "</Collection>\n"));
  };
  EXPECT_EQ(mesh(list("a.pvd", {"3", "1", "2e0", "1"})), (Times{1, 2, 3}));
  EXPECT_TRUE(contains(error_of([&] {
                         mesh(list("b.pvd", {"1", "x"}));
                       }),
                       "the timestep of m.vtu is no number"));
  EXPECT_TRUE(contains(error_of([&] { mesh(list("c.pvd", {})); }), "names no file"));
}

TEST_F(SourceTimes, Exodus) {
  if (!test::has_exodus) GTEST_SKIP() << "this build does not read Exodus files";
  test::SmallExodus of;
  of.steps = of.written_steps = 3;
  of.write(path("a.e"));
  EXPECT_EQ(mesh(path("a.e")), (Times{0, 0.5, 1}));
  // Out of order: VTK looks for times among ascending ones.
  of.step_times = {3, 1, 2};
  of.write(path("c.e"));
  EXPECT_EQ(mesh(path("c.e")), (Times{1, 2, 3}));
  for (const double time : {1.0, 2.0, 3.0}) {
    const MeshFile file = read_mesh(path("c.e"), {time, {}, {}});
    const double step = time == 3 ? 0 : time;
    EXPECT_EQ(file.time, time);
    EXPECT_EQ(file.times, (Times{1, 2, 3}));
    EXPECT_EQ(std::get<DataArray<double>>(file.grid.arrays.at(0).values)[5], 100 * step + 5);
  }
  of.step_times.clear();
  of.has_last_time = false;
  of.write(path("b.e"));
  EXPECT_EQ(mesh(path("b.e")), (Times{0, 0.5}));
}
#endif

}  // namespace
}  // namespace pellucid::test_source_times
