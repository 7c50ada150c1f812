// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_ivf_header {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::world_of;

class IvfTest : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    write("v.raw", bytes_of(counting()));
  }
  static std::string header(const std::string& more, const std::string& format = "FLOAT32",
                            const std::string& sides = "x=\"5\" y=\"4\" z=\"3\"") {
    return "<?xml version=\"1.0\" ?>\n<InviwoVolume version=\"2\">\n<RawFile "
           "content=\"v.raw\"/>\n<Format content=\"" +
           format + "\"/><Dimension " + sides + "/>\n" + more + "</InviwoVolume>\n";
  }
  static std::string matrix(const std::string& name, const std::vector<std::string>& columns) {
    std::string text = "<" + name + ">";
    for (std::size_t c = 0; c < 4; ++c) text += "<col" + std::to_string(c) + columns[c] + "/>";
    return text + "</" + name + ">\n";
  }
  static std::string column(const std::string& x, const std::string& y, const std::string& z,
                            const std::string& w = "0") {
    return " x=\"" + x + "\" y=\"" + y + "\" z=\"" + z + "\" w=\"" + w + "\"";
  }
  Volume parse(const std::string& text) { return read_volume(write("a.ivf", text)); }
  std::string error(const std::string& text) {
    return error_of([&] { parse(text); });
  }
};

TEST_F(IvfTest, TypesAndByteOrders) {
  expect_counting(parse(header("")), "f32");
  write("v.raw", test::swapped_bytes_of(counting<std::int16_t>()));
  expect_counting(parse(header("<ByteOrder content=\"1\"/>", "INT16")), "i16");
  const auto old = [](const std::string& little) {
    return "<MetaDataMap><MetaDataItem type=\"org.inviwo.BoolMetaData\" key=\"LittleEndian\">"
           "<MetaData content=\"" +
           little + "\"/></MetaDataItem></MetaDataMap>";
  };
  expect_counting(parse(header(old("0"), "INT16")), "i16");
  write("v.raw", bytes_of(counting<std::uint64_t>()));
  expect_counting(parse(header(old("1"), "UINT64")), "u8");
}

TEST_F(IvfTest, OffsetAndCompression) {
  write("v.raw", "abc" + bytes_of(counting()));
  expect_counting(parse(header("<ByteOffset content=\"3\"/>")), "f32");
  write("v.raw", test::gzipped(bytes_of(counting())));
  expect_counting(parse(header("<Compression content=\"1\"/>")), "f32");
  write("v.raw", test::gzipped(bytes_of(test::counting_halves())));
  expect_counting(parse(header("<Compression content=\"1\"/>", "FLOAT16")), "f32");
}

// The basis spans the cells, and the world turns and moves it: x to y, y to -x.
TEST_F(IvfTest, PlacedByBasisAndWorld) {
  const std::string basis =
      matrix("BasisAndOffset", {column("10", "0", "0"), column("0", "8", "0"),
                                column("0", "0", "9"), column("1", "2", "3", "1")});
  const Volume plain = parse(header(basis));
  EXPECT_EQ(plain.description().centering, Centering::cell);
  expect_near(world_of(plain, 0, 0, 0), {2, 3, 4.5});
  expect_near(world_of(plain, 4, 3, 2), {10, 9, 10.5});
  const std::string world =
      matrix("WorldTransform", {column("0", "1", "0"), column("-1", "0", "0"),
                                column("0", "0", "1"), column("100", "0", "0", "1")});
  expect_near(world_of(parse(header(basis + world)), 4, 3, 2), {91, 10, 10.5});
  EXPECT_EQ(parse(header("")).description().centering, Centering::point);
}

TEST_F(IvfTest, BadHeadersAreRefused) {
  EXPECT_TRUE(contains(error(header("<RawFile content=\"w.raw\"/>")), "several files"));
  EXPECT_TRUE(contains(error("<InviwoVolume></InviwoVolume>"), "no file"));
  EXPECT_TRUE(contains(error("<InviwoVolume><RawFile content=\"v.raw\"/>"), "no Dimension"));
  EXPECT_TRUE(contains(error(header("", "FLOAT32", "x=\"5\" y=\"4\"")), "has no z"));
  EXPECT_TRUE(contains(error(header("", "FLOAT32", "x=\"5\" y=\"4\" z=\"-3\"")), "whole numbers"));
  EXPECT_TRUE(contains(error(header("", "FLOAT32", "x=\"5\" y=\"4\" z=\"e\"")), "line 4"));
  EXPECT_TRUE(contains(error(header("", "UINT12")), "\"UINT12\" are not read"));
  EXPECT_TRUE(contains(error(header("", "FLOAT64")), "240 bytes"));
  EXPECT_TRUE(contains(error(header("<ByteOffset content=\"-1\"/>")), "ByteOffset"));
  EXPECT_TRUE(contains(error(header("<ByteOffset content=\"1e15\"/>")), "240 bytes"));
  EXPECT_TRUE(contains(
      error(header(matrix("BasisAndOffset", {column("1", "0", "0", "1"), column("0", "1", "0"),
                                             column("0", "0", "1"), column("0", "0", "0", "1")}))),
      "affine"));
  EXPECT_TRUE(contains(error("<InviwoVolume"), "does not end"));
  EXPECT_TRUE(contains(error(""), "no file"));
  error(std::string(100, '<'));
}

}  // namespace
}  // namespace pellucid::test_ivf_header
