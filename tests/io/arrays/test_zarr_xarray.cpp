// SPDX-License-Identifier: Apache-2.0
//
// Stores as xarray writes them follow the rules of NetCDF.
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "zarr_files.h"

namespace pellucid::test_zarr_xarray {
namespace {

namespace fs = std::filesystem;

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::value_at;
using test::world_of;
using test::ZarrStore;

class ZarrXarray : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    write_text("a.zarr/.zgroup", "{\"zarr_format\": 2}");
  }
  void write_text(const std::string& name, const std::string& text) const {
    fs::create_directories(path(name).parent_path());
    write(name, text);
  }
  static std::string attributes_of(const std::vector<std::string>& axes, const std::string& more) {
    std::string list;
    for (const std::string& axis : axes) list += (list.empty() ? "\"" : ", \"") + axis + "\"";
    return "{\"_ARRAY_DIMENSIONS\": [" + list + "]" + (more.empty() ? "" : ", " + more) + "}";
  }
  /// Writes an array of these axes in one chunk.
  template <class Value>
  void add(const std::string& name, const std::string& type, const std::vector<std::string>& axes,
           const std::vector<int>& shape, const std::vector<Value>& values,
           const std::string& more = {}, const std::string& fill = "null") const {
    ZarrStore store;
    store.type = type;
    store.shape = store.chunk = shape;
    store.fill = fill;
    store.write_2(path("a.zarr/" + name), bytes_of(values), sizeof(Value));
    write_text("a.zarr/" + name + "/.zattrs", attributes_of(axes, more));
  }
  template <class Value>
  void add_counting(const std::string& type, const std::string& more = {},
                    const std::string& fill = "null",
                    const std::vector<std::string>& axes = {"z", "y", "x"}) const {
    add("v", type, axes, {3, 4, 5}, counting<Value>(), more, fill);
  }
  Volume read_store(const ReadOptions& given = {}) {
    notes_.clear();
    ReadOptions options = given;
    options.note = [this](const std::string& note) { notes_ += note + "\n"; };
    return read_volume(path("a.zarr"), options);
  }
  std::size_t missing() { return read_store().statistics().nan; }

  std::string notes_;
};

TEST_F(ZarrXarray, AxesByTheirMeaning) {
  const auto place = [&](const std::vector<std::string>& axes, const std::vector<int>& shape) {
    std::vector<std::int16_t> values;
    std::array<int, 3> index{};
    for (index[0] = 0; index[0] < shape[0]; ++index[0]) {
      for (index[1] = 0; index[1] < shape[1]; ++index[1]) {
        for (index[2] = 0; index[2] < shape[2]; ++index[2]) {
          int value = 0;
          for (std::size_t a = 0; a < 3; ++a) {
            value += index[a] * (shape[a] == 5 ? 1 : shape[a] == 4 ? 5 : 20);
          }
          values.push_back(static_cast<std::int16_t>(value));
        }
      }
    }
    add("v", "<i2", axes, shape, values);
    expect_counting(read_store(), "i16");
  };
  place({"lev", "lat", "lon"}, {3, 4, 5});
  place({"lon", "lat", "lev"}, {5, 4, 3});
  place({"latitude", "depth", "longitude"}, {4, 3, 5});
  place({"a", "b", "c"}, {3, 4, 5});
  // By what the coordinates say.
  add<double>("a", "<f8", {"a"}, {5}, {0, 1, 2, 3, 4}, "\"units\": \"degrees_east\"");
  add<double>("b", "<f8", {"b"}, {3}, {0, 1, 2}, "\"axis\": \"Z\"");
  add<double>("c", "<f8", {"c"}, {4}, {0, 1, 2, 3}, "\"standard_name\": \"latitude\"");
  place({"a", "b", "c"}, {5, 3, 4});
  EXPECT_EQ(list_arrays(path("a.zarr")).size(), 4u);
}

TEST_F(ZarrXarray, TimeIsNoSpace) {
  const std::string hours = "\"units\": \"hours since 1900-01-01\"";
  add_counting<std::int16_t>("<i2", {}, "null", {"time", "lat", "lon"});
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "axis time is time and not z"));
  add_counting<std::int16_t>("<i2", {}, "null", {"a", "lat", "lon"});
  add<double>("a", "<f8", {"a"}, {3}, {0, 6, 12}, hours);
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "axis a is time and not z"));
  add_counting<std::int16_t>("<i2", {}, "null", {"lat", "lon", "time"});
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "time and not z"));
  add_counting<std::int16_t>("<i2", {}, "null", {"number", "lat", "lon"});
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "axis number is members of an ensemble"));
}

TEST_F(ZarrXarray, StepsAndMembers) {
  std::vector<std::int16_t> values;
  for (int c = 0; c < 6; ++c) {
    for (int i = 0; i < 60; ++i) values.push_back(static_cast<std::int16_t>(i + 60 * c));
  }
  add("v", "<i2", {"number", "time", "lev", "lat", "lon"}, {2, 3, 3, 4, 5}, values);
  add<double>("time", "<f8", {"time"}, {3}, {0, 6, 12}, "\"units\": \"hours since 1900-01-01\"");
  const std::string error = error_of([&] { read_store(); });
  EXPECT_TRUE(contains(error, "2 members (axis number) of 3 steps (axis time)")) << error;
  ReadOptions options;
  options.component = 4;
  EXPECT_EQ(value_at(read_store(options), 1, 0, 0), 241);
  // The nearest time, not the number of the step.
  options.time = 7;
  options.component = 1;
  EXPECT_EQ(value_at(read_store(options), 0, 0, 0), 240);
}

TEST_F(ZarrXarray, PackedValuesAndMissingOnes) {
  add_counting<std::int16_t>("<i2", "\"scale_factor\": 0.5, \"add_offset\": 100.0");
  EXPECT_EQ(value_at(read_store(), 4, 3, 2), 129.5);
  EXPECT_EQ(type_name(read_store().data()), "f32");
  add_counting<std::int16_t>("<i2", "\"_FillValue\": 7");
  EXPECT_EQ(missing(), 1u);
  add_counting<float>("<f4", "\"missing_value\": [3.0, 4.0], \"_FillValue\": \"NaN\"");
  EXPECT_EQ(missing(), 2u);
  add_counting<float>("<f4", "\"_FillValue\": NaN");
  EXPECT_EQ(missing(), 0u);
  add_counting<std::int64_t>("<i8", "\"_FillValue\": 5");
  EXPECT_EQ(missing(), 1u);
  add_counting<std::int16_t>("<i2", "\"valid_range\": [10, 19]");
  EXPECT_EQ(missing(), 50u);
  add_counting<std::int16_t>("<i2", "\"scale_factor\": 0.5, \"valid_max\": 4.5");
  EXPECT_EQ(missing(), 50u);
  std::vector<std::int8_t> bytes(60, -56);
  bytes[1] = -1;
  add("v", "|i1", {"z", "y", "x"}, {3, 4, 5}, bytes, "\"_Unsigned\": \"true\", \"_FillValue\": -1");
  EXPECT_EQ(missing(), 1u);
  EXPECT_EQ(value_at(read_store(), 0, 0, 0), 200);
  add_counting<std::int16_t>("<i2", "\"scale_factor\": \"0.5\"");
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "scale_factor"));
}

// Version 2 keeps _FillValue as the fill value of missing chunks.
TEST_F(ZarrXarray, FillValuesOfVersion2) {
  add_counting<std::int16_t>("<i2", {}, "7");
  EXPECT_EQ(missing(), 1u);
  add_counting<float>("<f4", {}, "7.0");
  EXPECT_EQ(missing(), 1u);
  add_counting<std::uint8_t>("|u1", {}, "255");
  EXPECT_EQ(missing(), 0u);
  EXPECT_EQ(type_name(read_store().data()), "u8");
  // Zeros are zeros for most programs.
  add_counting<std::int16_t>("<i2", {}, "0");
  expect_counting(read_store(), "i16");
  EXPECT_TRUE(contains(notes_, "1 of its values are 0, the fill value")) << notes_;
  add_counting<std::int16_t>("<i2", "\"_FillValue\": 0", "0");
  EXPECT_EQ(missing(), 1u);
  EXPECT_EQ(notes_, "");
  // Without names of axes nothing but the chunks is meant.
  add_counting<std::int16_t>("<i2", {}, "7");
  write_text("a.zarr/v/.zattrs", "{}");
  expect_counting(read_store(), "i16");
}

TEST_F(ZarrXarray, PositionsArePackedToo) {
  const auto with_z = [&](const std::string& type, const std::string& more, const std::string& fill,
                          const auto& values) {
    add_counting<float>("<f4");
    add("z", type, {"z"}, {3}, values, more, fill);
  };
  with_z("<f8", "\"scale_factor\": 3.0, \"add_offset\": 100.0", "0", std::vector<double>{0, 1, 2});
  expect_near(world_of(read_store(), 0, 0, 2), {0, 0, 106}, 0);
  EXPECT_EQ(read_store().description().placement.spacing.z, 3);
  with_z("|i1", "\"_Unsigned\": \"true\"", "null", std::vector<std::int8_t>{100, -106, -56});
  expect_near(world_of(read_store(), 0, 0, 2), {0, 0, 200}, 0);
  with_z("<f8", "\"positive\": \"down\"", "null", std::vector<double>{0, 10, 20});
  expect_near(world_of(read_store(), 0, 0, 2), {0, 0, -20}, 0);
  EXPECT_TRUE(contains(notes_, "minus z")) << notes_;
  with_z("<f8", "\"_FillValue\": 2.0", "null", std::vector<double>{0, 1, 2});
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "position along z of number 3"));
  with_z("<f8", "", "-1.0", std::vector<double>{0, -1, 2});
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "position along z of number 2"));
  with_z("<f8", "", "null", std::vector<double>{0, 2, 1});
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "do not go on in one direction"));
}

TEST_F(ZarrXarray, WhatBelongsToOthersIsNotShown) {
  add("bounds_of_z", "<f4", {"z", "y", "x"}, {3, 4, 5}, std::vector<float>(60, 1));
  add("corners", "<f4", {"y", "x", "vertices"}, {4, 5, 4}, std::vector<float>(80, 1));
  add("height", "<f4", {"z", "y", "x"}, {3, 4, 5}, std::vector<float>(60, 1));
  add("rain", "<f4", {"time", "y", "x"}, {3, 4, 5}, std::vector<float>(60, 1));
  add<double>("z", "<f8", {"z"}, {3}, {0, 1, 2}, "\"bounds\": \"bounds_of_z\"");
  add_counting<float>("<f4", "\"coordinates\": \"height\", \"grid_mapping\": \"crs\"");
  add<float>("crs", "<f4", {}, {}, {1}, "\"grid_mapping_name\": \"rotated_latitude_longitude\"");
  expect_counting(read_store(), "f32");
  EXPECT_TRUE(contains(notes_, "read is v")) << notes_;
  EXPECT_TRUE(contains(notes_, "curvilinear grid (coordinates height)")) << notes_;
  EXPECT_TRUE(contains(notes_, "grid_mapping: rotated_latitude_longitude")) << notes_;
}

TEST_F(ZarrXarray, ChunksInNestedFolders) {
  const auto with = [&](const std::string& files, const std::string& said) {
    fs::remove_all(path("a.zarr/v"));
    ZarrStore store;
    store.separator = files;
    store.write_2(path("a.zarr/v"), bytes_of(counting()), 4);
    std::string text = store.array_2();
    const std::string key = ", \"dimension_separator\": \"" + files + "\"";
    text.replace(text.find(key), key.size(),
                 said.empty() ? "" : ", \"dimension_separator\": \"" + said + "\"");
    write_text("a.zarr/v/.zarray", text);
    expect_counting(read_store(), "f32");
  };
  with(".", "");
  EXPECT_EQ(notes_, "");
  with("/", "/");
  EXPECT_EQ(notes_, "");
  with("/", "");
  EXPECT_TRUE(contains(notes_, "its chunks lie in nested folders")) << notes_;
  with("/", ".");
  EXPECT_TRUE(contains(notes_, "its chunks lie in nested folders")) << notes_;
  with(".", "/");
  EXPECT_TRUE(contains(notes_, "files with dots in their names")) << notes_;
}

TEST_F(ZarrXarray, MissingChunksAreCounted) {
  ZarrStore store;
  store.write_2(path("a.zarr/v"), bytes_of(counting()), 4);
  for (const auto& entry : fs::directory_iterator(path("a.zarr/v"))) {
    if (entry.path().filename() != ".zarray") fs::remove(entry.path());
  }
  read_store();
  EXPECT_TRUE(contains(notes_, "12 of 12 chunks are not there")) << notes_;
}

TEST_F(ZarrXarray, MetadataOfTheRootAlone) {
  add_counting<float>("<f4", "\"units\": \"K\"");
  add<double>("z", "<f8", {"z"}, {3}, {0, 3, 6});
  const std::string all =
      "{\"zarr_consolidated_format\": 1, \"metadata\": {\".zgroup\": {\"zarr_format\": 2}, "
      "\"v/.zarray\": " +
      read(path("a.zarr/v/.zarray")) + ", \"v/.zattrs\": " + read(path("a.zarr/v/.zattrs")) +
      ", \"z/.zarray\": " + read(path("a.zarr/z/.zarray")) +
      ", \"z/.zattrs\": " + read(path("a.zarr/z/.zattrs")) + "}}";
  for (const char* file : {".zgroup", "v/.zarray", "v/.zattrs", "z/.zarray", "z/.zattrs"}) {
    fs::remove(path("a.zarr") / file);
  }
  write_text("a.zarr/.zmetadata", all);
  const Volume volume = read_store();
  expect_counting(volume, "f32");
  EXPECT_EQ(volume.description().placement.spacing.z, 3);
  ReadOptions options;
  options.array = "v";
  expect_counting(read_store(options), "f32");
  write_text("a.zarr/.zmetadata", "{\"metadata\": 3}");
  EXPECT_TRUE(contains(error_of([&] { read_store(); }), "has neither .zarray"));
}

class ZarrXarray3 : public test::ScratchFolder {
 protected:
  void add(const std::string& name, const std::vector<int>& shape, const std::string& type,
           const std::string& bytes, std::size_t size, const std::string& more) const {
    ZarrStore store;
    store.shape = store.chunk = shape;
    store.separator = "/";
    store.more = more;
    fs::create_directories(path("a.zarr/" + name));
    write(
        "a.zarr/" + name + "/zarr.json",
        store.array_3(type, "[{\"name\": \"bytes\", \"configuration\": {\"endian\": \"little\"}}]",
                      "{\"name\": \"default\"}"));
    store.write_chunks(path("a.zarr/" + name), bytes, size, "c");
  }
};

TEST_F(ZarrXarray3, FillValuesAndAxes) {
  fs::create_directories(path("a.zarr"));
  write("a.zarr/zarr.json", "{\"zarr_format\": 3, \"node_type\": \"group\"}");
  const auto read_with = [&](const std::string& attributes) {
    add("v", {3, 4, 5}, "float32", bytes_of(counting()), 4,
        ", \"dimension_names\": [\"lev\", \"lat\", \"lon\"], \"attributes\": {" + attributes + "}");
    return read_volume(path("a.zarr"));
  };
  // The bytes of a double in base 64: 7, and a NaN.
  EXPECT_EQ(read_with("\"_FillValue\": \"AAAAAAAAHEA=\"").statistics().nan, 1u);
  EXPECT_EQ(read_with("\"_FillValue\": \"AAAAAAAA+H8=\"").statistics().nan, 0u);
  EXPECT_EQ(read_with("\"_FillValue\": 7").statistics().nan, 1u);
  // The fill value, 0 here, is that of missing chunks alone.
  expect_counting(read_with(""), "f32");
  add("lev", {3}, "float64", bytes_of(std::vector<double>{0, 2, 4}), 8,
      ", \"dimension_names\": [\"lev\"], \"attributes\": {\"scale_factor\": 2}");
  EXPECT_EQ(read_with("").description().placement.spacing.z, 4);
  add("lev", {3}, "float64", bytes_of(std::vector<double>{0, 2, 4}), 8,
      ", \"dimension_names\": [\"lev\"], \"attributes\": {\"units\": \"days since 2000-1-1\"}");
  EXPECT_TRUE(contains(error_of([&] { read_with(""); }), "axis lev is time"));
}

TEST_F(ZarrXarray3, MetadataOfTheRootAlone) {
  add("v", {3, 4, 5}, "float32", bytes_of(counting()), 4,
      ", \"dimension_names\": [\"z\", \"y\", \"x\"]");
  const std::string v = read(path("a.zarr/v/zarr.json"));
  fs::remove(path("a.zarr/v/zarr.json"));
  write("a.zarr/zarr.json",
        "{\"zarr_format\": 3, \"node_type\": \"group\", \"consolidated_metadata\": "
        "{\"kind\": \"inline\", \"metadata\": {\"v\": " +
            v + "}}}");
  expect_counting(read_volume(path("a.zarr")), "f32");
}

}  // namespace
}  // namespace pellucid::test_zarr_xarray
