// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_vtk_js {
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

std::string array_text(const std::string& name, const std::string& type, const std::string& id,
                       int components = 1, int size = 60, const std::string& more = "") {
  return "{\"data\": {\"vtkClass\": \"vtkDataArray\", \"name\": \"" + name +
         "\", \"numberOfComponents\": " + std::to_string(components) + ", \"dataType\": \"" + type +
         "\", \"ref\": {\"encode\": \"LittleEndian\", \"basepath\": \"data\", \"id\": \"" + id +
         "\"" + more + "}, \"size\": " + std::to_string(size) + "}}";
}

class VtkJsTest : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    fs::create_directories(path("head.vti/data"));
    write("head.vti/data/f", bytes_of(counting()));
  }
  void index(const std::string& arrays, const std::string& more = "",
             const std::string& extent = "[0, 4, 0, 3, 0, 2]",
             const std::string& kind = "vtkImageData") const {
    write("head.vti/index.json", "{\"vtkClass\": \"" + kind +
                                     "\", \"spacing\": [1, 2, 3], \"origin\": [10, 20, 30], "
                                     "\"extent\": " +
                                     extent + more +
                                     ", \"pointData\": {\"vtkClass\": "
                                     "\"vtkDataSetAttributes\", \"arrays\": [" +
                                     arrays + "]}}");
  }
  Volume read(const ReadOptions& options = {}) const {
    return read_volume(path("head.vti"), options);
  }
  std::string error(const ReadOptions& options = {}) const {
    return error_of([&] { read(options); });
  }
};

TEST_F(VtkJsTest, FolderAndItsIndex) {
  index(array_text("f", "Float32Array", "f"));
  expect_counting(read(), "f32");
  expect_counting(read_volume(path("head.vti/index.json")), "f32");
  expect_near(world_of(read(), 4, 3, 2), {14, 26, 36});
  EXPECT_EQ(read().description().name, path("head.vti").string());
}

TEST_F(VtkJsTest, CompressedValuesAndOtherTypes) {
  index(array_text("z", "Uint16Array", "z"));
  write("head.vti/data/z.gz", test::gzipped(bytes_of(counting<std::uint16_t>())));
  expect_counting(read(), "u16");
  index(array_text("b", "BigInt64Array", "b"));
  write("head.vti/data/b", bytes_of(counting<std::int64_t>()));
  expect_counting(read(), "u8");
  index(array_text("v", "Uint8Array", "v", 2, 120));
  std::vector<std::uint8_t> pairs;
  for (int i = 0; i < 60; ++i) {
    pairs.push_back(static_cast<std::uint8_t>(i));
    pairs.push_back(static_cast<std::uint8_t>(i + 100));
  }
  write("head.vti/data/v", bytes_of(pairs));
  const std::vector<Volume> both = read_components(path("head.vti"));
  ASSERT_EQ(both.size(), 2u);
  expect_counting(both[0], "u8");
  EXPECT_EQ(value_at(both[1], 4, 3, 2), 159);
}

TEST_F(VtkJsTest, WholeNumbersOf64Bits) {
  index(array_text("w", "BigInt64Array", "w", 2, 120));
  const auto write_pairs = [&](std::int64_t last) {
    std::vector<std::int64_t> pairs;
    for (int i = 0; i < 60; ++i) {
      pairs.push_back(i);
      pairs.push_back(-i);
    }
    pairs.back() = last;
    write("head.vti/data/w", bytes_of(pairs));
  };
  std::string notes;
  ReadOptions options;
  options.note = [&](const std::string& line) { notes += line; };
  write_pairs(-300);
  const std::vector<Volume> both = read_components(path("head.vti"), options);
  ASSERT_EQ(both.size(), 2u);
  expect_counting(both[0], "i16");
  EXPECT_EQ(type_name(both[1].data()), "i16");
  EXPECT_EQ(value_at(both[1], 4, 3, 2), -300);
  EXPECT_EQ(notes, "");
  write_pairs((std::int64_t{1} << 53) + 1);
  expect_counting(read_components(path("head.vti"), options).at(0), "f64");
  EXPECT_TRUE(contains(notes, "1 of 120 whole numbers of 64 bits does not fit double")) << notes;
}

// Axis by axis, as the matrices of WebGL; the origin is that of index 0.
TEST_F(VtkJsTest, DirectionAndExtent) {
  index(array_text("f", "Float32Array", "f"), ", \"direction\": [0, 1, 0, -1, 0, 0, 0, 0, 1]",
        "[2, 6, 1, 4, 0, 2]");
  const Volume volume = read();
  expect_near(world_of(volume, 0, 0, 0), {10 - 2, 20 + 2, 30});
  expect_near(world_of(volume, 1, 0, 0), {10 - 2, 20 + 3, 30});
  expect_near(world_of(volume, 0, 1, 0), {10 - 4, 20 + 2, 30});
}

TEST_F(VtkJsTest, ArraysByName) {
  index(array_text("vectors", "Float32Array", "g", 3, 180) + ", " +
        array_text("f", "Float32Array", "f") + ", " +
        array_text("active", "Uint8Array", "u", 1, 60, ", \"registration\": \"setScalars\""));
  write("head.vti/data/u", std::string(60, '\5'));
  EXPECT_EQ(value_at(read(), 0, 0, 0), 5);
  ReadOptions options;
  options.array = "f";
  expect_counting(read(options), "f32");
  options.array = "none";
  EXPECT_TRUE(contains(error(options), "it has vectors, f, active"));
  const std::vector<VolumeArray> arrays = list_arrays(path("head.vti"));
  ASSERT_EQ(arrays.size(), 3u);
  EXPECT_TRUE(contains(arrays[0].unreadable_reason, "data/g"));
  EXPECT_EQ(arrays[1].components.at(0).maximum, 59);
  EXPECT_TRUE(arrays[2].is_default);
}

TEST_F(VtkJsTest, ArraysOfCells) {
  write("head.vti/index.json",
        "{\"vtkClass\": \"vtkImageData\", \"spacing\": [1, 2, 3], \"origin\": [0, 0, 0], "
        "\"extent\": [0, 5, 0, 4, 0, 3], \"cellData\": {\"arrays\": [" +
            array_text("f", "Float32Array", "f") + "]}}");
  expect_counting(read(), "f32");
  EXPECT_EQ(read().description().centering, Centering::cell);
  expect_near(world_of(read(), 0, 0, 0), {0.5, 1, 1.5});
}

TEST_F(VtkJsTest, RefusesWhatItCannotRead) {
  const std::string f = array_text("f", "Float32Array", "f");
  index(array_text("f", "Float32Array", "../../f"));
  EXPECT_TRUE(contains(error(), "leaves the folder"));
  index(array_text("f", "Float32Array", "/etc/passwd"));
  EXPECT_TRUE(contains(error(), "is an absolute path"));
  index(array_text("f", "Strings", "f"));
  EXPECT_TRUE(contains(error(), "is no type of numbers"));
  index(array_text("f", "Float32Array", "f", 1, 59));
  EXPECT_TRUE(contains(error(), "has 59 values, but the image needs 60"));
  index(f, "", "[0, 4, 0, 3, 0, 1]");
  EXPECT_TRUE(contains(error(), "has 60 values, but the image needs 40"));
  index(f, "", "[0, 4, 0, 3, 2, 0]");
  EXPECT_TRUE(contains(error(), "the image is empty"));
  index(array_text("f", "Float32Array", "f", 1, 0), "",
        "[0, 2000000000, 0, 2000000000, 0, 2000000000]");
  EXPECT_TRUE(contains(error(), "too large"));
  index(f, "", "[0, 4]");
  EXPECT_TRUE(contains(error(), "must have 6 numbers"));
  index(f, "", "[0, 4, 0, 3, 0, 2]", "vtkPolyData");
  EXPECT_TRUE(contains(error(), "is a vtkPolyData of vtk.js"));
  index("");
  EXPECT_TRUE(contains(error(), "has no array of points or cells"));
  write("head.vti/index.json", "{\"scene\": []}");
  EXPECT_TRUE(contains(error(), "is a scene of vtk.js"));
  index(f);
  write("head.vti/data/f", std::string(239, 'x'));
  EXPECT_TRUE(contains(error(), "holds 239 bytes of values, but the image needs 240"));
  fs::remove(path("head.vti/data/f"));
  EXPECT_TRUE(contains(error(), "data/f"));
}

}  // namespace
}  // namespace pellucid::test_vtk_js
