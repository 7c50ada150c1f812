// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/pyramid.h"
#include "pellucid/io/read_volume.h"
#include "zarr_files.h"

namespace pellucid::test_ome_zarr {
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

constexpr const char* micrometer_axes =
    "[{\"name\": \"z\", \"type\": \"space\", \"unit\": \"micrometer\"}, {\"name\": \"y\", "
    "\"type\": \"space\", \"unit\": \"micrometer\"}, {\"name\": \"x\", \"type\": \"space\", "
    "\"unit\": \"micrometer\"}]";

std::string dataset(const std::string& path, const std::string& scale,
                    const std::string& translation = "") {
  return "{\"path\": \"" + path +
         "\", \"coordinateTransformations\": [{\"type\": \"scale\", \"scale\": " + scale + "}" +
         (translation.empty()
              ? ""
              : ", {\"type\": \"translation\", \"translation\": " + translation + "}") +
         "]}";
}

class OmeZarrTest : public test::ScratchFolder {
 protected:
  void write_text(const std::string& name, const std::string& text) const {
    fs::create_directories(path(name).parent_path());
    write(name, text);
  }
  /// A group of version 2 with these attributes.
  void group(const std::string& name, const std::string& attributes) const {
    write_text(name + "/.zgroup", "{\"zarr_format\": 2}");
    write_text(name + "/.zattrs", attributes);
  }
  void image(const std::string& name, const std::string& axes, const std::string& datasets,
             const std::string& more = "", const std::string& beside = "") const {
    group(name, "{\"multiscales\": [{\"version\": \"0.4\", \"axes\": " + axes +
                    ", \"datasets\": [" + datasets + "]" + more + "}]" + beside + "}");
  }
  void array(const std::string& name) const {
    ZarrStore().write_2(path(name), bytes_of(counting()), 4);
  }
  /// Half of the sides, all 7.
  void coarse_array(const std::string& name) const {
    ZarrStore store;
    store.shape = {2, 2, 3};
    store.write_2(path(name), bytes_of(std::vector<float>(12, 7)), 4);
  }
  ReadOptions noting() {
    ReadOptions options;
    options.note = [this](const std::string& line) { notes_ += line + "\n"; };
    return options;
  }
  std::string error(const std::string& name, const ReadOptions& options = {}) const {
    return error_of([&] { read_volume(path(name), options); });
  }
  std::string notes_;
};

TEST_F(OmeZarrTest, AxesThatTheArrayNamesOtherwise) {
  image("a.zarr", micrometer_axes, dataset("0", "[3, 2, 1]"));
  array("a.zarr/0");
  const auto named = [&](const std::string& names) {
    notes_.clear();
    write_text("a.zarr/0/.zattrs", "{\"_ARRAY_DIMENSIONS\": " + names + "}");
    read_volume(path("a.zarr"), noting());
    return notes_;
  };
  EXPECT_FALSE(contains(named(R"(["z", "y", "x"])"), "names the axes"));
  EXPECT_FALSE(contains(named(R"(["Z", null, "X"])"), "names the axes"));
  EXPECT_TRUE(contains(named(R"(["x", "y", "z"])"),
                       "its image names the axes z, y, x, but its array x, y, z"));
  EXPECT_TRUE(contains(named(R"(["t", "y", "x"])"), "the image's are taken"));
  EXPECT_TRUE(contains(named(R"(["y", "x"])"), "of 2 axes, but it has 3"));
}

TEST_F(OmeZarrTest, LevelsScalesAndTranslations) {
  image("a.zarr", micrometer_axes,
        dataset("0", "[3, 2, 0.5]", "[30, 20, 10]") + ", " + dataset("1", "[6, 4, 1]"),
        ", \"coordinateTransformations\": [{\"type\": \"scale\", \"scale\": [10, 10, 10]}, "
        "{\"type\": \"translation\", \"translation\": [1, 1, 1]}]");
  array("a.zarr/0");
  coarse_array("a.zarr/1");
  const Volume finest = read_volume(path("a.zarr"), noting());
  expect_counting(finest, "f32");
  expect_near(world_of(finest, 0, 0, 0), {101, 201, 301});
  expect_near(world_of(finest, 1, 1, 1), {106, 221, 331});
  EXPECT_TRUE(contains(notes_, "level 0 of 2 (--level); the spacing is the file's, in micrometer"))
      << notes_;
  ReadOptions options;
  options.level = 1;
  const Volume coarse = read_volume(path("a.zarr"), options);
  EXPECT_EQ(coarse.description().dimensions, (std::array<int, 3>{3, 2, 2}));
  EXPECT_EQ(value_at(coarse, 0, 0, 0), 7);
  expect_near(coarse.description().placement.spacing, {10, 40, 60});
  options.level = 2;
  EXPECT_TRUE(contains(error("a.zarr", options), "there is no level 2; it has levels 0 to 1"));
  options.level = 1;
  options.spacing = Vec3<double>{9, 9, 9};
  EXPECT_EQ(read_volume(path("a.zarr"), options).description().placement.spacing.x, 9);
  // A level's own folder knows where it is.
  expect_near(read_volume(path("a.zarr/1")).description().placement.spacing, {10, 40, 60});

  const auto pyramid = describe_pyramid(path("a.zarr"));
  ASSERT_TRUE(pyramid);
  EXPECT_EQ(pyramid->axes, "z y x");
  EXPECT_EQ(pyramid->unit, "micrometer");
  ASSERT_EQ(pyramid->levels.size(), 2u);
  EXPECT_EQ(pyramid->levels[1].dimensions, (std::vector<std::int64_t>{3, 2, 2}));
  expect_near(pyramid->levels[1].spacing, {10, 40, 60});
  EXPECT_FALSE(describe_pyramid(path("a.zarr/1/.zarray")).has_value() &&
               describe_pyramid(path("a.zarr/1/.zarray"))->levels.empty());
  EXPECT_TRUE(list_arrays(path("a.zarr")).empty());
}

TEST_F(OmeZarrTest, UnitsBecomeOne) {
  const auto axes = [](const std::string& z, const std::string& x) {
    return "[{\"name\": \"z\", \"type\": \"space\"" + z +
           "}, {\"name\": \"y\", \"type\": \"space\", \"unit\": \"nanometer\"}, {\"name\": \"x\", "
           "\"type\": \"space\"" +
           x + "}]";
  };
  const std::string micrometer = ", \"unit\": \"micrometer\"",
                    nanometer = ", \"unit\": \"nanometer\"";
  image("a.zarr", axes(micrometer, nanometer), dataset("0", "[0.5, 90, 80]", "[1, 0, 0]"));
  array("a.zarr/0");
  const Volume volume = read_volume(path("a.zarr"), noting());
  expect_near(volume.description().placement.spacing, {80, 90, 500});
  expect_near(volume.description().placement.origin, {0, 0, 1000});
  EXPECT_TRUE(contains(notes_, "several units; lengths are turned into nanometer")) << notes_;
  notes_.clear();
  image("a.zarr", axes(", \"unit\": \"cubit\"", nanometer), dataset("0", "[0.5, 90, 80]"));
  expect_near(read_volume(path("a.zarr"), noting()).description().placement.spacing, {80, 90, 0.5});
  EXPECT_TRUE(contains(notes_, "are not all known")) << notes_;
}

TEST_F(OmeZarrTest, ChannelsAndTimesAreComponents) {
  std::vector<std::uint16_t> values;
  for (int step = 0; step < 4; ++step) {
    for (int i = 0; i < 60; ++i) values.push_back(static_cast<std::uint16_t>(i + 100 * step));
  }
  image("a.zarr",
        "[{\"name\": \"t\", \"type\": \"time\", \"unit\": \"second\"}, {\"name\": \"c\", \"type\": "
        "\"channel\"}, {\"name\": \"z\", \"type\": \"space\"}, {\"name\": \"y\", \"type\": "
        "\"space\"}, {\"name\": \"x\", \"type\": \"space\"}]",
        dataset("0", "[5, 1, 3, 2, 1]", "[10, 0, 0, 0, 0]"), "",
        ", \"omero\": {\"channels\": [{\"label\": \"DAPI\"}, {\"label\": \"GFP\"}]}");
  ZarrStore store;
  store.type = "<u2";
  store.shape = {2, 2, 3, 4, 5};
  store.chunk = {1, 1, 2, 2, 2};
  store.write_2(path("a.zarr/0"), bytes_of(values), 2);
  EXPECT_TRUE(contains(error("a.zarr"), "holds 2 times of 2 channels (DAPI, GFP)"));
  EXPECT_EQ(component_count(path("a.zarr")), 4);
  ReadOptions options;
  options.component = 3;
  EXPECT_EQ(value_at(read_volume(path("a.zarr"), options), 0, 0, 0), 300);
  options.component.reset();
  options.time = 14;
  EXPECT_EQ(component_count(path("a.zarr"), options), 2);
  const std::vector<Volume> both = read_components(path("a.zarr"), options);
  EXPECT_EQ(value_at(both[0], 0, 0, 0), 200);
  EXPECT_EQ(value_at(both[1], 4, 3, 2), 359);
  options.component_name = "GFP";
  EXPECT_EQ(value_at(read_volume(path("a.zarr"), options), 0, 0, 0), 300);
  options.component_name.reset();
  options.time = -1e30;
  EXPECT_EQ(value_at(read_components(path("a.zarr"), options)[0], 0, 0, 0), 0);
  expect_near(both[0].description().placement.spacing, {1, 2, 3});
  EXPECT_EQ(describe_pyramid(path("a.zarr"))->channels, (std::vector<std::string>{"DAPI", "GFP"}));
}

// Axes in any order, a scale below 0, version 0.5 of the metadata in version 3 of Zarr.
TEST_F(OmeZarrTest, Version05) {
  write_text("a.zarr/zarr.json",
             "{\"zarr_format\": 3, \"node_type\": \"group\", \"attributes\": {\"ome\": "
             "{\"version\": \"0.5\", \"multiscales\": [{\"axes\": [{\"name\": \"x\", \"type\": "
             "\"space\"}, {\"name\": \"y\", \"type\": \"space\"}, {\"name\": \"z\", \"type\": "
             "\"space\"}], \"datasets\": [" +
                 dataset("s0", "[1, -2, 4]") + "]}]}}}");
  ZarrStore store;
  store.shape = {5, 4, 3};
  store.chunk = {5, 4, 3};
  store.separator = "/";
  write_text("a.zarr/s0/zarr.json",
             store.array_3("float32",
                           "[{\"name\": \"bytes\", \"configuration\": {\"endian\": \"little\"}}]",
                           "{\"name\": \"default\"}"));
  std::vector<float> turned;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 3; ++k) turned.push_back(static_cast<float>(i + 5 * (j + 4 * k)));
    }
  }
  store.write_chunks(path("a.zarr/s0"), bytes_of(turned), 4, "c");
  const Volume volume = read_volume(path("a.zarr"), noting());
  expect_counting(volume, "f32");
  expect_near(world_of(volume, 1, 1, 1), {1, -2, 4});
  EXPECT_TRUE(contains(notes_, "whose unit is not stated")) << notes_;
}

TEST_F(OmeZarrTest, BeforeVersion04) {
  group("a.zarr",
        "{\"multiscales\": [{\"version\": \"0.1\", \"datasets\": [{\"path\": \"0\"}, {\"path\": "
        "\"1\"}]}]}");
  ZarrStore store;
  store.shape = {1, 1, 3, 4, 5};
  store.chunk = {1, 1, 3, 4, 5};
  store.write_2(path("a.zarr/0"), bytes_of(counting()), 4);
  store.shape = {1, 1, 3, 2, 5};
  store.write_2(path("a.zarr/1"), bytes_of(std::vector<float>(30, 1)), 4);
  expect_counting(read_volume(path("a.zarr"), noting()), "f32");
  EXPECT_TRUE(contains(notes_, "says nothing of distances")) << notes_;
  ReadOptions options;
  options.level = 1;
  expect_near(read_volume(path("a.zarr"), options).description().placement.spacing, {1, 2, 1});
  group("b.zarr",
        "{\"multiscales\": [{\"version\": \"0.3\", \"axes\": [\"z\", \"y\", \"x\"], \"datasets\": "
        "[{\"path\": \"0\"}]}]}");
  array("b.zarr/0");
  expect_counting(read_volume(path("b.zarr")), "f32");
}

TEST_F(OmeZarrTest, SeriesOfBioformats2raw) {
  group("a.zarr", "{\"bioformats2raw.layout\": 3}");
  group("a.zarr/OME", "{\"series\": [\"0\", \"1\"]}");
  for (const char* series : {"0", "1", "10"}) {
    image("a.zarr/" + std::string(series), micrometer_axes, dataset("0", "[3, 2, 1]"));
    array("a.zarr/" + std::string(series) + "/0");
  }
  const Volume volume = read_volume(path("a.zarr"), noting());
  expect_counting(volume, "f32");
  expect_near(volume.description().placement.spacing, {1, 2, 3});
  EXPECT_TRUE(contains(notes_, "holds 3 arrays or images (0, 1, 10); read is 0")) << notes_;
  ReadOptions options;
  options.array = "10";
  expect_counting(read_volume(path("a.zarr"), options), "f32");
  EXPECT_EQ(describe_pyramid(path("a.zarr"), options)->array, "10");
  EXPECT_EQ(list_arrays(path("a.zarr")).size(), 3u);
}

TEST_F(OmeZarrTest, Labels) {
  image("a.zarr", micrometer_axes, dataset("0", "[3, 2, 1]"));
  array("a.zarr/0");
  group("a.zarr/labels", "{\"labels\": [\"cells\"]}");
  image("a.zarr/labels/cells", micrometer_axes, dataset("0", "[3, 2, 1]"));
  coarse_array("a.zarr/labels/cells/0");
  EXPECT_EQ(describe_pyramid(path("a.zarr"))->labels, std::vector<std::string>{"labels/cells"});
  ReadOptions options;
  options.array = "labels/cells";
  EXPECT_EQ(value_at(read_volume(path("a.zarr"), options), 0, 0, 0), 7);
}

TEST_F(OmeZarrTest, RefusesMetadataThatLie) {
  array("a.zarr/0");
  array("b.zarr");
  const auto with = [&](const std::string& datasets, const std::string& more = "") {
    image("a.zarr", micrometer_axes, datasets, more);
    return error("a.zarr");
  };
  EXPECT_TRUE(contains(with(dataset("../b.zarr", "[1, 1, 1]")), "leaves the folder"));
  EXPECT_TRUE(contains(with(dataset("/etc", "[1, 1, 1]")), "is an absolute path"));
  EXPECT_TRUE(contains(with(dataset("0/../../b.zarr", "[1, 1, 1]")), "leaves the folder"));
  EXPECT_TRUE(contains(with(dataset("7", "[1, 1, 1]")), "has neither .zarray"));
  EXPECT_TRUE(contains(with(dataset("0", "[1, 1]")), "has 2 numbers, but there are 3 axes"));
  EXPECT_TRUE(contains(with(dataset("0", "[1, 1, 0]")), "the scale along x is no usable number"));
  EXPECT_TRUE(contains(with(dataset("0", "[1, 1, \"a\"]")), "must be a number"));
  EXPECT_TRUE(contains(with(""), "lists no level"));
  EXPECT_TRUE(contains(
      with(dataset("0", "[1, 1, 1]"), ", \"coordinateTransformations\": [{\"type\": \"affine\"}]"),
      "\"affine\" is not read"));
  image("a.zarr", "[{\"name\": \"y\"}, {\"name\": \"x\"}]", dataset("0", "[1, 1]"));
  EXPECT_TRUE(contains(error("a.zarr"), "lists 2 axes, but its array 0 has 3"));
  image("a.zarr", "[{\"name\": \"x\"}, {\"name\": \"x\"}, {\"name\": \"x\"}]",
        dataset("0", "[1, 1, 1]"));
  EXPECT_TRUE(contains(error("a.zarr"), "its axes are not x, y and z"));
  group("a.zarr", "{\"multiscales\": []}");
  EXPECT_TRUE(contains(error("a.zarr"), "lists no image"));
  group("a.zarr", "{\"multiscales\": 7}");
  EXPECT_TRUE(contains(error("a.zarr"), "must be an array"));
  group("a.zarr", "{\"plate\": {}}");
  EXPECT_TRUE(contains(error("a.zarr"), "is a plate of many images"));
}

TEST_F(OmeZarrTest, AxesAreGivenWhereItsOwnSayNothing) {
  array("a.zarr/0");
  ReadOptions options;
  options.axes = "zyx";
  image("a.zarr", micrometer_axes, dataset("0", "[3, 2, 1]"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr"), options); }),
                       "the store says which axes are x, y and z; leave the axes out"));
  image("a.zarr", "[{\"name\": \"i\"}, {\"name\": \"x\"}, {\"name\": \"x\"}]",
        dataset("0", "[3, 2, 1]"));
  EXPECT_TRUE(contains(error("a.zarr"), "say which they are, as in --array-axes czyx"));
  const Volume volume = read_volume(path("a.zarr"), options);
  EXPECT_EQ(value_at(volume, 4, 3, 2), 59);
  EXPECT_EQ(volume.description().placement.spacing.z, 3);
}

TEST_F(OmeZarrTest, TooLargeForTheMachine) {
  image("a.zarr", micrometer_axes, dataset("0", "[1, 1, 1]") + ", " + dataset("1", "[2, 2, 2]"));
  ZarrStore store;
  store.shape = {100000, 100000, 100000};
  store.chunk = {1000, 1000, 1000};
  write_text("a.zarr/0/.zarray", store.array_2());
  array("a.zarr/1");
  EXPECT_TRUE(contains(error("a.zarr"), "or choose a coarser level (--level 1)"));
}

}  // namespace
}  // namespace pellucid::test_ome_zarr
