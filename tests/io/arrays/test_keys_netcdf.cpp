// SPDX-License-Identifier: Apache-2.0
//
// Keys of NetCDF, HDF5 and Zarr: each with a small file that has it.
#ifdef PELLUCID_HAVE_NETCDF
#include <netcdf.h>
#endif

#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/io/described_keys.h"
#ifdef PELLUCID_HAVE_HDF5
#include "hdf5_files.h"
#endif
#include "net_cdf_files.h"
#include "pellucid/io/read_volume.h"
#include "zarr_files.h"

namespace pellucid::test_keys_netcdf {
namespace {

namespace fs = std::filesystem;

using test::bytes_of;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::value_at;
using test::world_of;
using test::ZarrStore;

/// A volume and the notes of its reading.
struct Told {
  Volume volume;
  std::vector<std::string> notes;
};
Told read_telling(const fs::path& file, const std::string& array = "v") {
  std::vector<std::string> notes;
  ReadOptions options;
  if (!array.empty()) options.array = array;
  options.note = [&](const std::string& note) { notes.push_back(note); };
  Volume volume = read_volume(file, options);
  return {std::move(volume), notes};
}

// -------------------------------------------------------------------------------------- NetCDF

using Attributes = std::vector<test::ClassicAttribute>;

/// A file of v on p, q, r of 3, 4, 5, with attributes of v and of the coordinate p.
std::string net_cdf(const Attributes& of_v, const Attributes& of_a = {}, char type = 'h',
                    const std::vector<std::string>& axes = {"p", "q", "r"}) {
  test::ClassicFile file;
  file.axes = {{axes[0], 3}, {axes[1], 4}, {axes[2], 5}};
  if (!of_a.empty()) file.variables.push_back({axes[0], 'd', {axes[0]}, {0, 1, 2}, of_a});
  file.variables.push_back({"crs", 'i', {}, {1}, {{"grid_mapping_name", "mercator"}}});
  file.variables.push_back({"lat", 'd', {axes[1], axes[2]}, std::vector<double>(20, 1)});
  file.variables.push_back({"v", type, axes, counting<double>(), of_v});
  return file.bytes();
}

#ifdef PELLUCID_HAVE_NETCDF
#define NETCDF_KEY(name, key, treatment) \
  PELLUCID_DESCRIBED_KEY(netcdf_##name, "NetCDF", key, treatment)
#define NETCDF_AXIS(name, key, value)                                    \
  NETCDF_KEY(name, key, honored) {                                       \
    const auto file = write("a.nc", net_cdf({}, {{key, value}}));        \
    EXPECT_EQ(read_telling(file).volume.description().dimensions[0], 3); \
  }
NETCDF_AXIS(axis, "axis", "X")
NETCDF_AXIS(cartesian_axis, "cartesian_axis", "X")
NETCDF_AXIS(coordinate_type, "_CoordinateAxisType", "Lon")
NETCDF_AXIS(standard_name, "standard_name", "longitude")
NETCDF_AXIS(units, "units", "degrees_east")

NETCDF_KEY(truth, "dtype bool", honored) {
  const auto file = write("a.nc", net_cdf({{"dtype", "bool"}}, {}, 'b'));
  EXPECT_EQ(type_name(read_telling(file).volume.data()), "u8");
}
NETCDF_KEY(unwritten, "unwritten bytes", told) {
  test::ClassicFile classic;
  classic.axes = {{"z", 3}, {"y", 4}, {"x", 5}};
  classic.variables = {{"v", 'b', {"z", "y", "x"}, std::vector<double>(60, -127)}};
  expect_told(read_telling(write("a.nc", classic.bytes())).notes,
              "1 of 1 chunk of \"v\" hold nothing but -127");
  classic.variables[0].values[59] = 1;
  EXPECT_TRUE(read_telling(write("a.nc", classic.bytes())).notes.empty());
  // Two chunks of four are written.
  const auto write_chunks = [&](bool has_fill) {
    int file = 0, axes[3] = {}, v = 0;
    const std::size_t chunk[] = {1, 4, 3}, begin[] = {0, 0, 0}, count[] = {1, 4, 5};
    ASSERT_EQ(nc_create(path("b.nc").c_str(), NC_CLOBBER | NC_NETCDF4, &file), NC_NOERR);
    nc_def_dim(file, "z", 2, &axes[0]);
    nc_def_dim(file, "y", 4, &axes[1]);
    nc_def_dim(file, "x", 5, &axes[2]);
    nc_def_var(file, "v", NC_UBYTE, 3, axes, &v);
    nc_def_var_chunking(file, v, NC_CHUNKED, chunk);
    const std::uint8_t fill = 255;
    if (has_fill) nc_def_var_fill(file, v, NC_FILL, &fill);
    const std::vector<std::uint8_t> values(20, 9);
    EXPECT_EQ(nc_put_vara_uchar(file, v, begin, count, values.data()), NC_NOERR);
    EXPECT_EQ(nc_close(file), NC_NOERR);
  };
  write_chunks(false);
  expect_told(read_telling(path("b.nc")).notes, "2 of 4 chunks of \"v\" hold nothing but 255");
  write_chunks(true);
  EXPECT_EQ(read_telling(path("b.nc")).volume.statistics().nan, 20u);
}

NETCDF_KEY(positive, "positive", honored) {
  const auto file = write("a.nc", net_cdf({}, {{"positive", "down"}}));
  EXPECT_EQ(world_of(read_telling(file).volume, 0, 0, 2).z, -2);
}
NETCDF_KEY(scale_factor, "scale_factor", honored) {
  const auto file = write("a.nc", net_cdf({{"scale_factor", 'd', {0.5}}}));
  EXPECT_EQ(value_at(read_telling(file).volume, 1, 0, 0), 0.5);
}
NETCDF_KEY(add_offset, "add_offset", honored) {
  const auto file = write("a.nc", net_cdf({{"add_offset", 'd', {100}}}));
  EXPECT_EQ(value_at(read_telling(file).volume, 1, 0, 0), 101);
}
#define NETCDF_MISSING(name, key, count, ...)                                  \
  NETCDF_KEY(name, key, honored) {                                             \
    const auto file = write("a.nc", net_cdf({{key, 'h', __VA_ARGS__}}));       \
    EXPECT_EQ(read_telling(file).volume.statistics().nan, std::size_t{count}); \
  }
NETCDF_MISSING(fill_value, "_FillValue", 1, {7})
NETCDF_MISSING(missing_value, "missing_value", 2, {7, 8})
NETCDF_MISSING(valid_range, "valid_range", 58, {7, 8})
NETCDF_MISSING(valid_min, "valid_min", 7, {7})
NETCDF_MISSING(valid_max, "valid_max", 52, {7})

NETCDF_KEY(unsigned, "_Unsigned", honored) {
  test::ClassicFile file;
  file.axes = {{"z", 3}, {"y", 4}, {"x", 5}};
  file.variables = {
      {"v", 'b', {"z", "y", "x"}, std::vector<double>(60, -56), {{"_Unsigned", "true"}}}};
  EXPECT_EQ(value_at(read_telling(write("a.nc", file.bytes())).volume, 0, 0, 0), 200);
}
NETCDF_KEY(beside, "variables spacing, affine", told) {
  for (const char* name : {"spacing", "affine", "voxel_size", "origin"}) {
    test::ClassicFile file;
    file.axes = {{"z", 3}, {"y", 4}, {"x", 5}, {"n", 3}};
    file.variables = {{name, 'd', {"n"}, {1, 2, 3}},
                      {"v", 'h', {"z", "y", "x"}, counting<double>()}};
    expect_told(read_telling(write("a.nc", file.bytes())).notes,
                std::string("its arrays ") + name + " may place or scale it");
  }
}
#define NETCDF_BOUNDS(name, key)                                   \
  NETCDF_KEY(name, key, honored) {                                 \
    const auto file = write("a.nc", net_cdf({}, {{key, "v"}}));    \
    expect_refused([&] { read_volume(file); }, "bounds of cells"); \
  }
NETCDF_BOUNDS(bounds, "bounds")
NETCDF_BOUNDS(climatology, "climatology")

NETCDF_KEY(coordinates, "coordinates", told) {
  expect_told(read_telling(write("a.nc", net_cdf({{"coordinates", "lat"}}))).notes,
              "coordinates lat");
}
NETCDF_KEY(grid_mapping, "grid_mapping", told) {
  expect_told(read_telling(write("a.nc", net_cdf({{"grid_mapping", "crs"}}))).notes,
              "grid_mapping: mercator");
}
NETCDF_KEY(flag_values, "flag_values", told) {
  expect_told(read_telling(write("a.nc", net_cdf({{"flag_values", 'h', {1, 2}}}))).notes,
              "flag_values");
}
NETCDF_KEY(flag_meanings, "flag_meanings", told) {
  expect_told(read_telling(write("a.nc", net_cdf({{"flag_meanings", "land sea"}}))).notes,
              "land sea");
}
NETCDF_KEY(flag_masks, "flag_masks", told) {
  expect_told(read_telling(write("a.nc", net_cdf({{"flag_masks", 'h', {1, 2}}}))).notes, "labels");
}
#endif

// -------------------------------------------------------------------------------- HDF5 arrays

#ifdef PELLUCID_HAVE_HDF5
using test::Hdf5Writer;

/// Writes v with more.
template <class More>
fs::path hdf5(const fs::path& path, const More& more) {
  const Hdf5Writer file(path);
  file.add("v", H5T_STD_I16LE, {3, 4, 5}, counting<double>());
  more(file);
  return path;
}
fs::path hdf5_with(const fs::path& path, const std::string& key,
                   const std::vector<double>& numbers) {
  return hdf5(path, [&](const Hdf5Writer& file) { file.attach("v", key, numbers); });
}

#define HDF5_KEY(name, key, treatment) \
  PELLUCID_DESCRIBED_KEY(hdf5_##name, "HDF5 arrays", key, treatment)
HDF5_KEY(scale_factor, "scale_factor", honored) {
  const auto file = hdf5_with(path("a.h5"), "scale_factor", {0.5});
  EXPECT_EQ(value_at(read_telling(file).volume, 1, 0, 0), 0.5);
}
HDF5_KEY(add_offset, "add_offset", honored) {
  const auto file = hdf5_with(path("a.h5"), "add_offset", {100});
  EXPECT_EQ(value_at(read_telling(file).volume, 1, 0, 0), 101);
}
#define HDF5_MISSING(name, key, count, ...)                                    \
  HDF5_KEY(name, key, honored) {                                               \
    const auto file = hdf5_with(path("a.h5"), key, __VA_ARGS__);               \
    EXPECT_EQ(read_telling(file).volume.statistics().nan, std::size_t{count}); \
  }
HDF5_MISSING(fill_value, "_FillValue", 1, {7})
HDF5_MISSING(missing_value, "missing_value", 2, {7, 8})
HDF5_MISSING(valid_range, "valid_range", 58, {7, 8})
HDF5_MISSING(valid_min, "valid_min", 7, {7})
HDF5_MISSING(valid_max, "valid_max", 52, {7})

HDF5_KEY(axistags, "axistags", honored) {
  const auto file = hdf5(path("a.h5"), [](const Hdf5Writer& to) {
    to.attach_text("v", "axistags",
                   "{\"axes\": [{\"key\": \"x\"}, {\"key\": \"y\"}, {\"key\": \"z\"}]}");
  });
  EXPECT_EQ(read_telling(file).volume.description().dimensions[0], 3);
}
HDF5_KEY(labels, "DIMENSION_LABELS", honored) {
  const auto file = hdf5(path("a.h5"), [](const Hdf5Writer& to) {
    to.attach_labels("v", {"x", "y", "z"});
  });
  EXPECT_EQ(read_telling(file).volume.description().dimensions[0], 3);
}
HDF5_KEY(scales, "DIMENSION_LIST", honored) {
  const auto file = hdf5(path("a.h5"), [](const Hdf5Writer& to) {
    to.add("z", H5T_IEEE_F64LE, {3}, {0, 2, 4});
    to.attach_scales("v", {"z", "", ""});
  });
  EXPECT_EQ(world_of(read_telling(file).volume, 0, 0, 2).z, 4);
}
HDF5_KEY(element_size, "element_size_um", honored) {
  const auto file = hdf5_with(path("a.h5"), "element_size_um", {3, 2, 1});
  EXPECT_EQ(world_of(read_telling(file).volume, 0, 0, 2).z, 6);
}
#define HDF5_TOLD(name, key)                                   \
  HDF5_KEY(name, key, told) {                                  \
    const auto file = hdf5_with(path("a.h5"), key, {3, 2, 1}); \
    expect_told(read_telling(file).notes, key);                \
  }
HDF5_TOLD(flag_values, "flag_values")
HDF5_TOLD(scale, "ScaleFactor")
HDF5_TOLD(slope, "slope")
HDF5_TOLD(intercept, "intercept")
HDF5_TOLD(other_missing, "MissingValue")
HDF5_TOLD(nodata, "nodata")
HDF5_TOLD(spacing, "spacing")
HDF5_TOLD(origin, "origin")
HDF5_TOLD(voxel_size, "voxel_size")
HDF5_TOLD(resolution, "resolution")
HDF5_TOLD(affine, "affine")
HDF5_TOLD(translation, "translation")
HDF5_TOLD(missing, "missing")
HDF5_TOLD(fill, "fill")
HDF5_TOLD(bias, "bias")
HDF5_TOLD(calibration, "calibration")
HDF5_TOLD(multiplier, "multiplier")
HDF5_TOLD(orientation, "orientation")
HDF5_TOLD(dx, "dx")
HDF5_TOLD(dy, "dy")
HDF5_TOLD(dz, "dz")
HDF5_TOLD(resolution_unit, "resolution_unit")
HDF5_KEY(other_letters, "names in other letters", told) {
  for (const char* key : {"SCALE_FACTOR", "SPACING", "MISSING_VALUE", "Add_Offset", "VoxelSize",
                          "voxel-size", "Valid_Range", "FILLVALUE", "Element_Size_UM"}) {
    const auto file = hdf5_with(path("a.h5"), key, {3, 2, 1});
    expect_told(read_telling(file).notes, std::string("(") + key + ")");
  }
}
HDF5_KEY(unusable_size, "element_size_um of other than three distances", told) {
  for (const std::vector<double>& size :
       {std::vector<double>{3, 2}, {3, 2, 0}, {3, -2, 1}, {NAN, 2, 1}, {1, 3, 2, 1}}) {
    const auto file = hdf5_with(path("a.h5"), "element_size_um", size);
    const Told told = read_telling(file);
    expect_told(told.notes, "the element_size_um of \"/v\" is not three distances above 0");
    EXPECT_EQ(world_of(told.volume, 0, 0, 2).z, 2);
  }
  const auto file = hdf5(
      path("a.h5"), [](const Hdf5Writer& to) { to.attach_text("v", "element_size_um", "3 2 1"); });
  expect_told(read_telling(file).notes, "is not three distances above 0");
}
HDF5_KEY(of_groups, "attributes of groups", told) {
  const std::pair<const char*, const char*> keys[] = {
      {"/", "voxel_size"},  {"/", "spacing"}, {"/g", "affine"}, {"/", "scale_factor"},
      {"/g", "Resolution"}, {"/g", "gain"},   {"/", "dims"},    {"/g", "element_size_um"}};
  for (const auto& [group, key] : keys) {
    {
      const Hdf5Writer file(path("a.h5"));
      file.add_group("/g");
      file.add("/g/v", H5T_STD_I16LE, {3, 4, 5}, counting<double>());
      file.attach(group, key, {1, 2, 3});
    }
    expect_told(read_telling(path("a.h5"), "/g/v").notes, std::string("(") + key + ")");
  }
  const auto plain = hdf5(
      path("a.h5"), [](const Hdf5Writer& file) { file.attach_text("/", "Conventions", "CF-1.8"); });
  EXPECT_TRUE(read_telling(plain).notes.empty());
}
/// A file of /g/v and of datasets by their names.
fs::path hdf5_beside(const fs::path& path,
                     const std::vector<std::pair<std::string, std::vector<double>>>& beside) {
  const Hdf5Writer file(path);
  file.add_group("/g");
  file.add("/g/v", H5T_STD_I16LE, {3, 4, 5}, counting<double>());
  for (const auto& [name, numbers] : beside) {
    std::vector<hsize_t> sides{numbers.size()};
    if (numbers.size() == 16) sides = {4, 4};
    if (numbers.size() == 1) sides = {};
    file.add(name, H5T_IEEE_F64LE, sides, numbers);
  }
  return path;
}
HDF5_KEY(spacing_beside, "dataset spacing", honored) {
  const auto file = hdf5_beside(path("a.h5"), {{"/spacing", {2, 3, 2}}});
  const Told told = read_telling(file, "/g/v");
  test::expect_near(told.volume.description().placement.spacing, {2, 3, 2});
  expect_told(told.notes, "\"/g/v\": its arrays spacing place it; its axes are z, y, x");
  // That of the own group goes before that of the root, and a unit is that of the positions.
  {
    const Hdf5Writer writer(path("b.h5"));
    writer.add_group("/g");
    writer.add("/g/v", H5T_STD_I16LE, {3, 4, 5}, counting<double>());
    writer.add("/g/voxel_size", H5T_IEEE_F32LE, {}, {0.5});
    writer.add("/voxel_size", H5T_IEEE_F32LE, {}, {7});
  }
  test::expect_near(read_telling(path("b.h5"), "/g/v").volume.description().placement.spacing,
                    {0.5, 0.5, 0.5});
  expect_told(read_telling(hdf5_beside(path("a.h5"), {{"/spacing", {1, 2, 3}}}), "/g/v").notes,
              "spacing (1, 2, 3) does not say whether it begins with x or with z");
}
HDF5_KEY(origin_beside, "dataset origin", honored) {
  const auto file = hdf5_beside(path("a.h5"), {{"/g/origin", {5, 6, 5}}, {"/g/dz", {3}}});
  test::expect_near(world_of(read_telling(file, "/g/v").volume, 0, 0, 1), {5, 6, 8});
}
HDF5_KEY(affine_beside, "dataset affine", honored) {
  const auto file =
      hdf5_beside(path("a.h5"), {{"/affine", {2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30, 0, 0, 0, 1}}});
  const Told told = read_telling(file, "/g/v");
  EXPECT_EQ(told.volume.description().dimensions, (std::array<int, 3>{3, 4, 5}));
  EXPECT_EQ(value_at(told.volume, 1, 2, 3), 20 * 1 + 5 * 2 + 3);
  test::expect_near(world_of(told.volume, 1, 2, 3), {-12, -26, 42});
  expect_told(told.notes, "affine places it, as nibabel does");
}
HDF5_KEY(coordinates_beside, "datasets x, y, z", honored) {
  const auto file = hdf5_beside(
      path("a.h5"), {{"/g/z", {0, 1, 2, 3, 9}}, {"/g/y", {0, 1, 2, 3}}, {"/g/x", {0, 5, 10}}});
  const Told told = read_telling(file, "/g/v");
  EXPECT_EQ(told.volume.description().dimensions, (std::array<int, 3>{3, 4, 5}));
  EXPECT_EQ(told.volume.description().coordinates[2], (std::vector<double>{0, 1, 2, 3, 9}));
  EXPECT_EQ(world_of(told.volume, 1, 0, 0).x, 5);
  // Steps in time.
  {
    const Hdf5Writer writer(path("b.h5"));
    writer.add("/v", H5T_STD_I16LE, {2, 3, 4, 5}, std::vector<double>(120, 1));
    writer.add("/time", H5T_IEEE_F64LE, {2}, {0, 0.5});
  }
  ReadOptions options;
  options.time = 0.4;
  std::string notes;
  options.note = [&](const std::string& note) { notes += note; };
  read_volume(path("b.h5"), options);
  EXPECT_TRUE(test::contains(notes, "0.5")) << notes;
}
HDF5_KEY(others_beside, "datasets direction, transform, x of several axes", told) {
  for (const char* name : {"/direction", "/g/transform", "/g/pixel_offset"}) {
    const auto file = hdf5_beside(path("a.h5"), {{name, {1, 2, 3}}});
    expect_told(read_telling(file, "/g/v").notes, "may place or scale it and are not applied");
  }
  const auto file = hdf5(path("a.h5"), [](const Hdf5Writer& writer) {
    writer.add("X", H5T_IEEE_F64LE, {3, 4, 5}, counting<double>());
    writer.attach("v", "element_size_um", {3, 2, 1});
    writer.add("spacing", H5T_IEEE_F64LE, {}, {7});
  });
  const Told told = read_telling(file, "v");
  expect_told(told.notes, "coordinates X, which change along several axes");
  // What the array says itself goes before.
  expect_told(told.notes, "arrays spacing may place or scale it");
  EXPECT_EQ(world_of(told.volume, 1, 0, 0).x, 1);
  // Beside arrays of other sides it is of none alone.
  const auto several = hdf5(path("b.h5"), [](const Hdf5Writer& writer) {
    writer.add("w", H5T_IEEE_F64LE, {5, 4, 3}, counting<double>());
    writer.add("spacing", H5T_IEEE_F64LE, {}, {7});
  });
  expect_told(read_telling(several, "v").notes, "arrays spacing may place or scale it");
}

HDF5_KEY(imaris, "ExtMin0, ExtMax0, ImageSizeX of Imaris", honored) {
  for (const bool has_plain_texts : {false, true}) {
    for (const char* name : {"a.h5", "a.ims", "a.hdf5"}) {
      test::ImarisFile file;
      file.has_plain_texts = has_plain_texts;
      file.write(path(name));
      std::vector<std::string> notes;
      ReadOptions options;
      options.note = [&](const std::string& note) { notes.push_back(note); };
      const std::vector<Volume> components = read_components(path(name), options);
      ASSERT_EQ(components.size(), 4u);
      EXPECT_EQ(components[0].description().dimensions, (std::array<int, 3>{5, 4, 3}));
      for (int i = 0; i < 60; ++i) {
        for (int c = 0; c < 4; ++c) {
          ASSERT_EQ(value_at(components[static_cast<std::size_t>(c)], i % 5, i / 5 % 4, i / 20),
                    i + 100 * (c % 2) + 50 * (c / 2));
        }
      }
      // The borders are those of the image, and the values are in the middle.
      test::expect_near(world_of(components[0], 0, 0, 0), {11, 11.25, 10 + 10 / 6.});
      test::expect_near(components[0].description().placement.spacing, {2, 2.5, 10 / 3.});
      expect_told(notes, "2 levels of resolution; the finest is read");
      expect_told(notes, "times");
    }
  }
  ReadOptions options;
  options.array = "/DataSet/ResolutionLevel 1";
  options.component = 1;
  options.time = 1;
  const Volume coarse = read_volume(path("a.h5"), options);
  test::expect_near(coarse.description().placement.spacing, {5, 5, 5});
  EXPECT_EQ(value_at(coarse, 1, 1, 1), 1 + 5 + 20 + 100 + 50);
  EXPECT_EQ(list_arrays(path("a.h5")).size(), 2u);
  ReadOptions letters;
  letters.axes = "xyz";
  expect_refused([&] { read_components(path("a.h5"), letters); }, "leave the axes out");
}
HDF5_KEY(imaris_faults, "ImageSizeX of Imaris that cannot be", refused) {
  test::ImarisFile file;
  for (const char* size : {"9", "0", "2.5"}) {
    file.size_x = size;
    file.write(path("a.h5"));
    expect_refused([&] { read_volume(path("a.h5")); }, "its ImageSizeX is not from 1 to the 8");
  }
  file = {};
  file.lacks_channel = true;
  file.write(path("a.h5"));
  expect_refused([&] { read_volume(path("a.h5")); }, "TimePoint 1/Channel 1/Data\" is missing");
}
HDF5_KEY(imaris_extent, "ExtMax0 of Imaris below ExtMin0", told) {
  test::ImarisFile file;
  file.extent_max = "10.000";
  file.write(path("a.h5"));
  std::vector<std::string> notes;
  ReadOptions options;
  options.note = [&](const std::string& note) { notes.push_back(note); };
  const Volume volume = read_components(path("a.h5"), options).front();
  test::expect_near(volume.description().placement.spacing, {1, 1, 1});
  expect_told(notes, "its ExtMin and ExtMax (DataSetInfo/Image) are no borders");
}
HDF5_KEY(external_links, "external links", told) {
  const auto file =
      hdf5(path("a.h5"), [](const Hdf5Writer& writer) { writer.link("w", "b.h5", "/x"); });
  const std::vector<VolumeArray> arrays = list_arrays(file);
  ASSERT_EQ(arrays.size(), 2u);
  EXPECT_TRUE(test::contains(arrays[1].unreadable_reason, "a link to \"/x\" of \"b.h5\""))
      << arrays[1].unreadable_reason;
  expect_refused([&] { read_telling(file, "w"); }, "give that file");
  { Hdf5Writer(path("c.h5")).link("w", "b.h5", "/x"); }
  expect_refused([&] { read_volume(path("c.h5")); }, "which is not followed");
}
HDF5_KEY(truth, "dtype bool", honored) {
  const auto file = hdf5(path("a.h5"), [](const Hdf5Writer& writer) {
    writer.add("w", H5T_STD_I8LE, {3, 4, 5}, std::vector<double>(60, 1));
    writer.attach_text("w", "dtype", "bool");
  });
  EXPECT_EQ(type_name(read_telling(file, "w").volume.data()), "u8");
}
#endif

// -------------------------------------------------------------------------------- Zarr stores

/// A store of v, whose attributes are those of xarray and more.
fs::path zarr(const fs::path& folder, const std::string& more,
              const std::function<void(ZarrStore&)>& change = {}) {
  ZarrStore store;
  store.type = "<i2";
  store.fill = "null";
  if (change) change(store);
  store.write_2(folder / "v", bytes_of(counting<std::int16_t>()), 2);
  std::ofstream(folder / ".zgroup") << "{\"zarr_format\": 2}";
  std::ofstream(folder / "v/.zattrs") << "{\"_ARRAY_DIMENSIONS\": [\"z\", \"y\", \"x\"]"
                                      << (more.empty() ? "" : ", ") << more << "}";
  return folder;
}
Told read_zarr(const fs::path& folder) {
  return read_telling(folder);
}

#define ZARR_KEY(name, key, treatment) \
  PELLUCID_DESCRIBED_KEY(zarr_##name, "Zarr stores", key, treatment)
ZARR_KEY(dimensions, "_ARRAY_DIMENSIONS", honored) {
  zarr(path("a.zarr"), {});
  write("a.zarr/v/.zattrs", "{\"_ARRAY_DIMENSIONS\": [\"x\", \"y\", \"z\"]}");
  EXPECT_EQ(read_zarr(path("a.zarr")).volume.description().dimensions[0], 3);
}
ZARR_KEY(scale_factor, "scale_factor", honored) {
  const Told told = read_zarr(zarr(path("a.zarr"), "\"scale_factor\": 0.5"));
  EXPECT_EQ(value_at(told.volume, 1, 0, 0), 0.5);
}
ZARR_KEY(add_offset, "add_offset", honored) {
  const Told told = read_zarr(zarr(path("a.zarr"), "\"add_offset\": 100"));
  EXPECT_EQ(value_at(told.volume, 1, 0, 0), 101);
}
#define ZARR_MISSING(name, key, count, value)                                 \
  ZARR_KEY(name, key, honored) {                                              \
    const Told told = read_zarr(zarr(path("a.zarr"), "\"" key "\": " value)); \
    EXPECT_EQ(told.volume.statistics().nan, std::size_t{count});              \
  }
ZARR_MISSING(fill_value, "_FillValue", 1, "7")
ZARR_MISSING(missing_value, "missing_value", 2, "[7, 8]")
ZARR_MISSING(valid_range, "valid_range", 58, "[7, 8]")
ZARR_MISSING(valid_min, "valid_min", 7, "7")
ZARR_MISSING(valid_max, "valid_max", 52, "7")

ZARR_KEY(fill, "fill_value", honored) {
  const Told told = read_zarr(zarr(path("a.zarr"), {}, [](ZarrStore& s) { s.fill = "7"; }));
  EXPECT_EQ(told.volume.statistics().nan, 1u);
}
ZARR_KEY(unsigned, "_Unsigned", honored) {
  ZarrStore store;
  zarr(path("a.zarr"), "\"_Unsigned\": \"true\"");
  store.type = "<i2";
  store.fill = "null";
  store.write_2(path("a.zarr/v"), bytes_of(std::vector<std::int16_t>(60, -1)), 2);
  EXPECT_EQ(value_at(read_zarr(path("a.zarr")).volume, 0, 0, 0), 65535);
}
ZARR_KEY(separator, "dimension_separator", honored) {
  const Told told = read_zarr(zarr(path("a.zarr"), {}, [](ZarrStore& s) { s.separator = "/"; }));
  expect_counting(told.volume, "i16");
}
ZARR_KEY(positive, "positive", honored) {
  zarr(path("a.zarr"), {});
  ZarrStore line;
  line.type = "<f8";
  line.shape = line.chunk = {3};
  line.fill = "null";
  line.write_2(path("a.zarr/z"), bytes_of(std::vector<double>{0, 1, 2}), 8);
  write("a.zarr/z/.zattrs", "{\"_ARRAY_DIMENSIONS\": [\"z\"], \"positive\": \"down\"}");
  EXPECT_EQ(world_of(read_zarr(path("a.zarr")).volume, 0, 0, 2).z, -2);
}
ZARR_KEY(consolidated, "metadata", honored) {
  zarr(path("a.zarr"), {});
  const std::string array = read(path("a.zarr/v/.zarray"));
  fs::remove(path("a.zarr/v/.zarray"));
  write("a.zarr/.zmetadata",
        "{\"metadata\": {\".zgroup\": {\"zarr_format\": 2}, \"v/.zarray\": " + array + "}}");
  expect_counting(read_zarr(path("a.zarr")).volume, "i16");
}
ZARR_KEY(flags, "flag_values", told) {
  expect_told(read_zarr(zarr(path("a.zarr"), "\"flag_values\": [1, 2]")).notes, "flag_values");
}
ZARR_KEY(grid_mapping, "grid_mapping", told) {
  expect_told(read_zarr(zarr(path("a.zarr"), "\"grid_mapping\": \"crs\"")).notes, "grid_mapping");
}
/// Without names of axes, too, and in version 3.
void write_plain(const fs::path& folder, const std::string& of_array, const std::string& of_group,
                 int version) {
  ZarrStore store;
  store.type = "<i2";
  store.fill = version == 2 ? "null" : "0";
  if (version == 2) {
    store.write_2(folder / "v", bytes_of(counting<std::int16_t>()), 2);
    std::ofstream(folder / ".zgroup") << "{\"zarr_format\": 2}";
    std::ofstream(folder / ".zattrs") << "{" << of_group << "}";
    std::ofstream(folder / "v/.zattrs") << "{" << of_array << "}";
    return;
  }
  fs::create_directories(folder / "v");
  store.more = ", \"attributes\": {" + of_array + "}";
  std::ofstream(folder / "v/zarr.json")
      << store.array_3("int16",
                       "[{\"name\": \"bytes\", \"configuration\": {\"endian\": "
                       "\"little\"}}]",
                       "{\"name\": \"default\"}");
  std::ofstream(folder / "zarr.json")
      << "{\"zarr_format\": 3, \"node_type\": \"group\", \"attributes\": {" << of_group << "}}";
}
#define ZARR_TOLD(name, key, value)                                                          \
  ZARR_KEY(name, key, told) {                                                                \
    const std::string said = "\"" key "\": " value;                                          \
    const std::string list = std::string("not applied (") + key + ")";                       \
    expect_told(read_zarr(zarr(path("named.zarr"), said)).notes, list);                      \
    for (const int version : {2, 3}) {                                                       \
      const auto array = path("a" + std::to_string(version) + ".zarr");                      \
      write_plain(array, said, {}, version);                                                 \
      expect_told(read_zarr(array).notes, list);                                             \
      const auto group = path("g" + std::to_string(version) + ".zarr");                      \
      write_plain(group, {}, said, version);                                                 \
      expect_told(read_zarr(group).notes, "is in the group \"" + group.filename().string()); \
      expect_told(read_zarr(group).notes, list);                                             \
    }                                                                                        \
  }
ZARR_TOLD(spacing, "spacing", "[3, 2, 1]")
ZARR_TOLD(offset, "offset", "[1, 2, 3]")
ZARR_TOLD(resolution, "resolution", "[4, 4, 40]")
ZARR_TOLD(voxel_size, "voxel_size", "[4, 4, 40]")
ZARR_TOLD(scale, "scale", "2")
ZARR_TOLD(slope, "slope", "2")
ZARR_TOLD(intercept, "intercept", "1")
ZARR_TOLD(nodata, "nodata", "0")
ZARR_TOLD(transform, "transform", "{\"scale\": [3, 2, 1]}")
ZARR_TOLD(pixel_resolution, "pixelResolution", "{\"dimensions\": [4, 4, 40]}")
ZARR_TOLD(axis_names, "axis_names", "[\"x\", \"y\", \"z\"]")
ZARR_TOLD(element_size, "element_size_um", "[3, 2, 1]")
ZARR_KEY(beside, "arrays spacing, affine, x", told) {
  const std::pair<const char*, std::vector<int>> arrays[] = {
      {"spacing", {3}}, {"affine", {4, 4}}, {"x", {5}}, {"voxel_size", {}}, {"z", {3, 4, 5}}};
  for (const auto& [name, shape] : arrays) {
    const auto folder = path(std::string(name) + ".zarr");
    write_plain(folder, {}, {}, 2);
    ZarrStore store;
    store.shape = store.chunk = shape;
    fs::create_directories(folder / name);
    std::ofstream(folder / name / ".zarray") << store.array_2();
    expect_told(read_telling(folder).notes,
                std::string("its ") + (shape.size() == 3 ? "coordinates " : "arrays ") + name);
  }
  // Coordinates of axes with names are read.
  zarr(path("named.zarr"), {});
  ZarrStore store;
  store.shape = store.chunk = {5};
  store.write_2(path("named.zarr") / "x", bytes_of(std::vector<float>{0, 1, 2, 3, 4}), 4);
  EXPECT_TRUE(read_zarr(path("named.zarr")).notes.empty());
}
ZARR_KEY(transformers, "storage_transformers", refused) {
  ZarrStore store;
  store.more = ", \"storage_transformers\": [{\"name\": \"other\"}]";
  fs::create_directories(path("a.zarr"));
  write("a.zarr/zarr.json", store.array_3("float32", "[\"bytes\"]", "{\"name\": \"default\"}"));
  expect_refused([&] { read_volume(path("a.zarr")); }, "storage_transformers");
}
ZARR_KEY(extensions, "must_understand", refused) {
  const auto with = [&](const std::string& more) {
    ZarrStore store;
    store.more = more;
    fs::create_directories(path("a.zarr"));
    write("a.zarr/zarr.json", store.array_3("float32", "[\"bytes\"]", "{\"name\": \"default\"}"));
  };
  for (const char* more : {", \"turned\": {\"by\": 90}", ", \"turned\": 90",
                           ", \"turned\": {\"must_understand\": true}"}) {
    with(more);
    expect_refused([&] { read_volume(path("a.zarr")); }, "extension \"turned\"");
  }
  with(", \"turned\": {\"must_understand\": false}, \"consolidated_metadata\": null");
  EXPECT_EQ(outline_volume(path("a.zarr")).description.dimensions[0], 5);
}
ZARR_KEY(other_length, "_ARRAY_DIMENSIONS of another length", told) {
  zarr(path("a.zarr"), {});
  write("a.zarr/v/.zattrs", "{\"_ARRAY_DIMENSIONS\": [\"y\", \"x\"]}");
  expect_told(read_zarr(path("a.zarr")).notes, "(_ARRAY_DIMENSIONS) are of 2 axes, but it has 3");
}
ZARR_KEY(truth, "dtype bool", honored) {
  ZarrStore store;
  store.type = "|i1";
  store.write_2(path("a.zarr/v"), bytes_of(std::vector<std::int8_t>(60, 1)), 1);
  std::ofstream(path("a.zarr/.zgroup")) << "{\"zarr_format\": 2}";
  std::ofstream(path("a.zarr/v/.zattrs"))
      << R"({"_ARRAY_DIMENSIONS": ["z", "y", "x"], "dtype": "bool"})";
  EXPECT_EQ(type_name(read_zarr(path("a.zarr")).volume.data()), "u8");
}
ZARR_KEY(dimension_names, "dimension_names", honored) {
  ZarrStore store;
  store.more = ", \"dimension_names\": [\"x\", \"y\", \"z\"]";
  fs::create_directories(path("a.zarr"));
  write("a.zarr/zarr.json", store.array_3("float32", "[\"bytes\"]", "{\"name\": \"default\"}"));
  EXPECT_EQ(outline_volume(path("a.zarr")).description.dimensions[0], 3);
}

}  // namespace
}  // namespace pellucid::test_keys_netcdf
