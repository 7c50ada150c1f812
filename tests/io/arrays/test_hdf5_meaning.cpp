// SPDX-License-Identifier: Apache-2.0
//
// What attributes, labels and scales say of datasets of HDF5, and what was never written.
#ifdef PELLUCID_HAVE_HDF5

#include <string>
#include <vector>

#include "hdf5_files.h"
#include "pellucid/io/read_volume.h"

namespace pellucid::test_hdf5_meaning {
namespace {

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::Hdf5Writer;
using test::value_at;
using test::world_of;

class Hdf5Meaning : public test::ScratchFolder {
 protected:
  template <class Fill>
  void write_file(const Fill& fill) const {
    const Hdf5Writer file(path("a.h5"));
    fill(file);
  }
  /// Writes v of 3 × 4 × 5 values, 0 to 59, with more.
  template <class More>
  void write_counting(hid_t type, const More& more) const {
    write_file([&](const Hdf5Writer& file) {
      file.add("v", type, {3, 4, 5}, counting<double>());
      more(file);
    });
  }
  Volume read_file(const ReadOptions& given = {}) {
    notes_.clear();
    ReadOptions options = given;
    options.array = "v";
    options.note = [this](const std::string& note) { notes_ += note + "\n"; };
    return read_volume(path("a.h5"), options);
  }
  std::size_t missing() { return read_file().statistics().nan; }

  std::string notes_;
};

TEST_F(Hdf5Meaning, ScaledAndMissingValues) {
  write_counting(H5T_STD_I16LE, [](const Hdf5Writer& file) {
    file.attach("v", "scale_factor", {0.5});
    file.attach("v", "add_offset", {100});
    file.attach("v", "_FillValue", {7});
  });
  EXPECT_EQ(missing(), 1u);
  EXPECT_EQ(value_at(read_file(), 4, 3, 2), 129.5);
  EXPECT_EQ(type_name(read_file().data()), "f32");
  write_counting(H5T_IEEE_F64LE, [](const Hdf5Writer& file) {
    file.attach("v", "missing_value", {3, 4});
    file.attach("v", "valid_range", {2, 1000});
  });
  EXPECT_EQ(missing(), 4u);
  for (const hid_t type : {H5T_STD_I64LE, H5T_STD_U64BE, H5T_STD_U8LE, H5T_STD_I32LE}) {
    write_counting(type, [](const Hdf5Writer& file) { file.attach("v", "_FillValue", {59}); });
    EXPECT_EQ(missing(), 1u);
    EXPECT_EQ(value_at(read_file(), 3, 3, 2), 58);
  }
  // None is missing: the type stays.
  write_counting(H5T_STD_U8LE,
                 [](const Hdf5Writer& file) { file.attach("v", "_FillValue", {99}); });
  expect_counting(read_file(), "u8");
  write_counting(H5T_STD_U8LE,
                 [](const Hdf5Writer& file) { file.attach_text("v", "scale_factor", "two"); });
  EXPECT_TRUE(contains(error_of([&] { read_file(); }), "scale_factor of \"/v\""));
  write_counting(H5T_STD_U8LE, [](const Hdf5Writer& file) {
    file.attach_text("v", "flag_meanings", "land sea");
    file.attach("v", "ScaleFactor", {2});
    file.attach("v", "resolution", {2});
  });
  expect_counting(read_file(), "u8");
  EXPECT_TRUE(contains(notes_, "labels (flag_values: land sea)")) << notes_;
  EXPECT_TRUE(contains(notes_, "not applied (ScaleFactor, resolution)")) << notes_;
}

TEST_F(Hdf5Meaning, NumbersThatAreMeantWithoutASign) {
  std::vector<double> values = counting<double>();
  values[1] = -1;
  values[2] = -56;
  write_file([&](const Hdf5Writer& file) {
    file.add("v", H5T_STD_I8LE, {3, 4, 5}, values);
    file.attach_text("v", "_Unsigned", "true");
    file.attach("v", "_FillValue", {-1});
    file.add("z", H5T_STD_I16LE, {3}, {30000, 32000, -31536});
    file.attach_text("z", "_Unsigned", "true");
    file.attach_scales("v", {"z", "", ""});
  });
  const Volume volume = read_file();
  EXPECT_EQ(volume.statistics().nan, 1u);
  EXPECT_EQ(value_at(volume, 2, 0, 0), 200);
  EXPECT_EQ(world_of(volume, 0, 0, 2).z, 34000);
}

TEST_F(Hdf5Meaning, WhatWasNeverWritten) {
  const auto with = [&](const Hdf5Writer::Storage& storage, const std::vector<double>& values) {
    write_file([&](const Hdf5Writer& file) {
      file.add("v", H5T_STD_I16LE, {3, 4, 5}, values, storage);
    });
    return read_file();
  };
  with({{1, 2, 5}, -9, {2, 4, 5}}, std::vector<double>(40, 1));
  EXPECT_TRUE(contains(notes_, "2 of 6 chunks of \"/v\" were never written; the values are -9"))
      << notes_;
  EXPECT_TRUE(contains(notes_, "20 values of \"/v\" are the fill value")) << notes_;
  with({{1, 2, 5}, {}, {1, 4, 5}}, std::vector<double>(20, 1));
  EXPECT_TRUE(contains(notes_, "4 of 6 chunks of \"/v\" were never written; the values are 0"));
  // Without chunks, all of it or nothing.
  with({}, {});
  EXPECT_TRUE(contains(notes_, "\"/v\" was never written; the values are 0")) << notes_;
  with({{}, 5.0, {}}, {});
  EXPECT_TRUE(contains(notes_, "\"/v\" was never written; the values are 5")) << notes_;
  // A part of a chunk.
  with({{3, 4, 5}, -9, {2, 4, 5}}, std::vector<double>(40, 1));
  EXPECT_EQ(notes_.find("never written"), std::string::npos) << notes_;
  EXPECT_TRUE(contains(notes_, "20 values of \"/v\" are the fill value")) << notes_;
  with({{1, 2, 5}, -9, {}}, counting<double>());
  EXPECT_EQ(notes_, "");
  with({}, counting<double>());
  EXPECT_EQ(notes_, "");
}

std::string tags(const std::string& keys, double resolution = 0) {
  std::string json;
  for (const char key : keys) {
    json += (json.empty() ? "" : ", ") + std::string("{\"key\": \"") + key +
            "\", \"typeFlags\": 2, \"resolution\": " + std::to_string(resolution) +
            ", \"description\": \"\"}";
  }
  return "{\"axes\": [" + json + "]}";
}

TEST_F(Hdf5Meaning, AxisTagsOfIlastik) {
  const auto with = [&](const std::string& json, bool is_fixed = false) {
    write_counting(H5T_STD_U8LE, [&](const Hdf5Writer& file) {
      file.attach_text("v", "axistags", json, is_fixed);
    });
  };
  with(tags("zyx"));
  expect_counting(read_file(), "u8");
  with(tags("xyz"), true);
  const Volume turned = read_file();
  EXPECT_EQ(turned.description().dimensions, (std::array<int, 3>{3, 4, 5}));
  EXPECT_EQ(value_at(turned, 1, 0, 0), 20);
  with(tags("zyx", 0.5));
  EXPECT_EQ(read_file().description().placement.spacing.z, 0.5);
  with(tags("tyx"));
  EXPECT_TRUE(contains(error_of([&] { read_file(); }), "axis t is time and not z"));
  with(tags("zyxc"));
  expect_counting(read_file(), "u8");
  EXPECT_TRUE(contains(notes_, "axistags of \"/v\" are of 4 axes")) << notes_;
  // Letters that the user gives come first.
  with(tags("zyx"));
  ReadOptions options;
  options.axes = "xyz";
  EXPECT_EQ(read_file(options).description().dimensions, (std::array<int, 3>{3, 4, 5}));
  // Five axes, as ilastik writes them.
  std::vector<double> values;
  for (int i = 0; i < 60; ++i) values.insert(values.end(), {i + 0.0, i + 100.0});
  write_file([&](const Hdf5Writer& file) {
    file.add("v", H5T_STD_U8LE, {1, 3, 4, 5, 2}, values);
    file.attach_text("v", "axistags", tags("tzyxc"), false);
  });
  options = {};
  EXPECT_TRUE(contains(error_of([&] { read_file(); }), "2 channels (axis c)"));
  options.component = 0;
  expect_counting(read_file(options), "u8");
  options.component = 1;
  EXPECT_EQ(value_at(read_file(options), 4, 3, 2), 159);
}

TEST_F(Hdf5Meaning, LabelsAndScalesOfTheAxes) {
  write_counting(H5T_STD_U8LE, [](const Hdf5Writer& file) {
    file.attach_labels("v", {"x", "y", "z"});
  });
  EXPECT_EQ(read_file().description().dimensions, (std::array<int, 3>{3, 4, 5}));
  // As NetCDF-4 does under another name.
  write_counting(H5T_STD_U8LE, [](const Hdf5Writer& file) {
    file.add("lev", H5T_IEEE_F64LE, {3}, {0, 10, 30});
    file.attach_text("lev", "positive", "down");
    file.add("lon", H5T_STD_I16LE, {5}, {0, 1, 2, 3, 4});
    file.attach("lon", "scale_factor", {0.5});
    file.add("lat", H5T_IEEE_F32LE, {4}, {0, 0, 0, 0});
    file.attach_text("lat", "NAME",
                     "This is a netCDF dimension but not a netCDF variable.         4");
    file.attach_scales("v", {"lev", "lat", "lon"});
  });
  const Volume placed = read_file();
  expect_counting(placed, "u8");
  EXPECT_EQ(placed.description().placement.spacing.x, 0.5);
  EXPECT_EQ(placed.description().placement.spacing.y, 1);
  EXPECT_EQ(placed.description().coordinates[2], (std::vector<double>{0, 10, 30}));
  EXPECT_EQ(placed.description().placement.direction.column[2].z, -1);
  write_counting(H5T_STD_U8LE, [](const Hdf5Writer& file) {
    file.add("a", H5T_IEEE_F64LE, {3}, {0, 10, 20});
    file.attach_text("a", "units", "hours since 1900-01-01", false);
    file.attach_scales("v", {"a", "", ""});
  });
  EXPECT_TRUE(contains(error_of([&] { read_file(); }), "axis a is time and not z"));
  write_counting(H5T_STD_U8LE, [](const Hdf5Writer& file) {
    file.add("lev", H5T_IEEE_F64LE, {3}, {0, 1, -9});
    file.attach("lev", "_FillValue", {-9});
    file.attach_scales("v", {"lev", "", ""});
  });
  EXPECT_TRUE(contains(error_of([&] { read_file(); }), "position along z of number 3"));
}

TEST_F(Hdf5Meaning, StepsInTime) {
  std::vector<double> values(120);
  for (std::size_t i = 0; i < 120; ++i) values[i] = static_cast<double>(i);
  write_file([&](const Hdf5Writer& file) {
    file.add("v", H5T_STD_I16LE, {2, 3, 4, 5}, values);
    file.add("time", H5T_IEEE_F64LE, {2}, {0, 6});
    file.attach_text("time", "units", "hours since 1900-01-01");
    file.attach_scales("v", {"time", "", "", ""});
  });
  ReadOptions options;
  options.time = 5;
  EXPECT_EQ(value_at(read_file(options), 0, 0, 0), 60);
  EXPECT_TRUE(contains(error_of([&] { read_file(); }), "2 steps (axis time)"));
}

TEST_F(Hdf5Meaning, SizesOfElements) {
  write_counting(H5T_STD_U8LE, [](const Hdf5Writer& file) {
    file.attach("v", "element_size_um", {3, 2, 0.5});
  });
  expect_near(world_of(read_file(), 4, 3, 2), {2, 6, 6}, 0);
  ReadOptions options;
  options.spacing = {1, 1, 1};
  expect_near(world_of(read_file(options), 4, 3, 2), {4, 3, 2}, 0);
}

}  // namespace
}  // namespace pellucid::test_hdf5_meaning

#endif
