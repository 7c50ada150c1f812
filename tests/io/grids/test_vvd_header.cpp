// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_vvd_header {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::value_at;
using test::world_of;

class VvdTest : public test::ScratchFolder {
 protected:
  static std::string item(const std::string& name, const std::string& type,
                          const std::string& value) {
    return "<MetaItem name=\"" + name + "\" type=\"" + type + "MetaData\">" + value +
           "</MetaItem>\n";
  }
  static std::string raw(const std::string& format) {
    return "<RawData filename=\"v.raw\" format=\"" + format + "\" x=\"5\" y=\"4\" z=\"3\" />";
  }
  std::filesystem::path header(const std::string& data, const std::string& items = "") const {
    return write("a.vvd",
                 "<?xml version=\"1.0\" ?>\n<VoreenData version=\"1\">\n<Volumes>\n"
                 "<Volume>\n" +
                     data + "\n<MetaData>\n" + items +
                     "</MetaData>\n<DerivedData>\n<DerivedItem type=\"VolumeMinMax\" "
                     "min=\"0\" max=\"1\" />\n</DerivedData>\n</Volume>\n</Volumes>\n"
                     "</VoreenData>\n");
  }
  Volume read(const std::string& data, const std::string& items = "",
              const ReadOptions& options = {}) const {
    return read_volume(header(data, items), options);
  }
  std::string error(const std::string& data, const std::string& items = "") const {
    return error_of([&] { read(data, items); });
  }
};

TEST_F(VvdTest, OffsetAndSpacing) {
  write("v.raw", bytes_of(counting<std::uint16_t>()));
  const Volume volume =
      read(raw("uint16"), item("Offset", "Vec3", "<value x=\"-1\" y=\"-2\" z=\"-3\" />") +
                              item("Spacing", "Vec3", "<value x=\"0.5\" y=\"1\" z=\"2\" />") +
                              item("RealWorldMapping", "RealWorldMapping",
                                   "<value scale=\"1\" offset=\"0\" unit=\"\" />"));
  expect_counting(volume, "u16");
  expect_near(world_of(volume, 0, 0, 0), {-1, -2, -3});
  expect_near(world_of(volume, 4, 3, 2), {1, 1, 1});
  ReadOptions options;
  options.spacing = Vec3<double>{7, 7, 7};
  EXPECT_EQ(read(raw("uint16"), "", options).description().placement.spacing.x, 7);
}

TEST_F(VvdTest, TransformationTurnsAll) {
  write("v.raw", bytes_of(counting()));
  const Volume volume = read(
      raw("float"),
      item("Offset", "Vec3", "<value x=\"1\" y=\"0\" z=\"0\" />") +
          item("Spacing", "Vec3", "<value x=\"2\" y=\"1\" z=\"1\" />") +
          item("Transformation", "Mat4",
               "<value.row0 x=\"0\" y=\"-1\" z=\"0\" w=\"5\" /><value.row1 x=\"3\" y=\"0\" z=\"0\" "
               "w=\"6\" /><value.row2 x=\"0\" y=\"0\" z=\"1\" w=\"7\" /><value.row3 x=\"0\" "
               "y=\"0\" z=\"0\" w=\"1\" />"));
  expect_counting(volume, "f32");
  expect_near(world_of(volume, 0, 0, 0), {5, 9, 7});
  expect_near(world_of(volume, 1, 0, 0), {5, 15, 7});
  expect_near(world_of(volume, 0, 1, 1), {4, 9, 8});
  EXPECT_TRUE(contains(error(raw("float"), item("Transformation", "Mat4",
                                                "<value.row3 x=\"0\" y=\"0\" z=\"1\" w=\"1\" />")),
                       "is no affine map"));
}

// Real values are the share of the type's range, times the scale, plus the offset.
TEST_F(VvdTest, RealValues) {
  const auto mapping = [](const std::string& scale, const std::string& offset) {
    return item("RealWorldMapping", "RealWorldMapping",
                "<value scale=\"" + scale + "\" offset=\"" + offset + "\" unit=\"HU\" />");
  };
  write("v.raw", bytes_of(counting<std::uint16_t>()));
  expect_counting(read(raw("uint16"), mapping("65535", "0")), "u16");
  const Volume real = read(raw("uint16"), mapping("131070", "-1024"));
  EXPECT_EQ(type_name(real.data()), "f32");
  EXPECT_FLOAT_EQ(static_cast<float>(value_at(real, 4, 3, 2)), 2 * 59 - 1024);
  write("v.raw", bytes_of(counting()));
  EXPECT_EQ(value_at(read(raw("float"), mapping("2", "1")), 4, 3, 2), 119);
}

TEST_F(VvdTest, PathsOfVersion5AndVectors) {
  std::vector<float> values;
  for (int i = 0; i < 60; ++i) {
    for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(i + 100 * c));
  }
  write("v.raw", bytes_of(values));
  header(
      "<RawData format=\"Vector3(float)\" x=\"5\" y=\"4\" z=\"3\"><Paths noPathSet=\"false\">"
      "<paths><item value=\"not/there.raw\" /><item value=\"v.raw\" /></paths></Paths></RawData>");
  const std::vector<Volume> all = read_components(path("a.vvd"));
  ASSERT_EQ(all.size(), 3u);
  expect_counting(all[0], "f32");
  EXPECT_EQ(value_at(all[2], 4, 3, 2), 259);
}

TEST_F(VvdTest, RefusesWhatItCannotRead) {
  write("v.raw", bytes_of(counting()));
  EXPECT_TRUE(contains(error(""), "has no RawData"));
  EXPECT_TRUE(contains(error(raw("float") + raw("float")), "holds 2 volumes"));
  EXPECT_TRUE(contains(error(raw("Tensor2(float)")), "of format \"Tensor2(float)\" are not read"));
  EXPECT_TRUE(contains(error(raw("double")), "the file has 240 bytes"));
  EXPECT_TRUE(contains(error("<RawDataNoExternalFile format=\"float\" />"), "is not read"));
  EXPECT_TRUE(contains(error("<RawData format=\"float\" x=\"5\" y=\"4\" z=\"3\" />"),
                       "names no file of values"));
  EXPECT_TRUE(contains(error("<RawData filename=\"v.raw\" format=\"float\" x=\"-5\" y=\"4\" "
                             "z=\"3\" />"),
                       "whole numbers from 1"));
  EXPECT_TRUE(contains(error("<RawData filename=\"none.raw\" format=\"float\" x=\"5\" y=\"4\" "
                             "z=\"3\" />"),
                       "none.raw"));
  EXPECT_TRUE(
      contains(error(raw("float"), item("Spacing", "Vec3", "<value x=\"0\" y=\"1\" z=\"1\" />")),
               "leaves no distance along x"));
  write("a.vvd", "<VoreenData");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.vvd")); }), "a tag does not end"));
}

}  // namespace
}  // namespace pellucid::test_vvd_header
