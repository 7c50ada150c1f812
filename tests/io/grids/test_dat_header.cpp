// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_dat_header {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::world_of;

class DatTest : public test::ScratchFolder {
 protected:
  void SetUp() override {
    ScratchFolder::SetUp();
    write("v.raw", bytes_of(counting()));
  }
  Volume parse(const std::string& header) { return read_volume(write("a.dat", header)); }
  std::string error(const std::string& header) {
    return error_of([&] { parse(header); });
  }
};

TEST_F(DatTest, OfVoreen) {
  const Volume volume = parse(
      "ObjectFileName:\tv.raw\r\nTaggedFileName: ---\r\nResolution:     5 4 3\r\n"
      "SliceThickness: 1 2 3\r\nFormat:         FLOAT");
  expect_counting(volume, "f32");
  expect_near(world_of(volume, 4, 3, 2), {4, 6, 6});
  EXPECT_EQ(volume.description().name, path("a.dat").string());
}

TEST_F(DatTest, OfInviwo) {
  expect_counting(parse("RawFile: v.raw\nResolution: 5 4 3\nFormat: FLOAT32\n"), "f32");
  write("v.raw", test::swapped_bytes_of(counting<std::int16_t>()));
  expect_counting(parse("RawFile: v.raw\nResolution: 5 4 3\nFormat: INT16\nByteOrder: BigEndian\n"),
                  "i16");
}

TEST_F(DatTest, RefusesWordsThatItDoesNotKnow) {
  const std::string begin = "RawFile: v.raw\nResolution: 5 4 3", end = "\nFormat: FLOAT32\n";
  expect_counting(parse(begin + end + "ByteOrder: littleEndian\n"), "f32");
  EXPECT_TRUE(
      contains(error(begin + end + "ByteOrder: Middle\n"), "\"ByteOrder: Middle\" is neither"));
  EXPECT_TRUE(contains(error(begin + " 2" + end), "are no three numbers"));
}

// The basis spans the cells: values are half a cell inside of it. Inviwo writes the rows of a
// matrix whose columns are the edges.
TEST_F(DatTest, BasisVectorsSpanTheCells) {
  const std::string basis =
      "RawFile: v.raw\nResolution: 5 4 3\nFormat: FLOAT32\nBasisVector1: 10 0 0\n"
      "BasisVector2: 0 0 9\nBasisVector3: 0 4 0\n";
  const Volume placed = parse(basis + "Offset: 100 200 300\n");
  EXPECT_EQ(placed.description().centering, Centering::cell);
  expect_near(world_of(placed, 0, 0, 0), {101, 201.5, 300.5});
  expect_near(world_of(placed, 4, 3, 2), {109, 207.5, 303.5});
  expect_near(placed.world_corners()[0], {100, 200, 300});
  expect_near(parse(basis).world_corners()[7], {5, 4.5, 2});
  const Volume sheared = parse(
      "RawFile: v.raw\nResolution: 5 4 3\nFormat: FLOAT32\nOffset: 0 0 0\n"
      "BasisVector1: 10 4 0\nBasisVector2: 0 8 0\nBasisVector3: 0 0 6\n");
  expect_near(world_of(sheared, 1, 0, 0) - world_of(sheared, 0, 0, 0), {2, 0, 0});
  expect_near(world_of(sheared, 0, 1, 0) - world_of(sheared, 0, 0, 0), {1, 2, 0});
}

TEST_F(DatTest, WorldVectorsAreRowsOfTheMapToTheWorld) {
  const std::string begin = "RawFile: v.raw\nResolution: 5 4 3\nFormat: FLOAT32\n";
  const std::string basis = "BasisVector1: 5 0 0\nBasisVector2: 0 4 0\nBasisVector3: 0 0 3\n";
  // A quarter turn about z, twice the size along z, and a step of (100, 200, 300).
  const std::string world =
      "WorldVector1: 0 -1 0 100\nWorldVector2: 1 0 0 200\nWorldVector3: 0 0 2 300\n"
      "WorldVector4: 0 0 0 1\n";
  const Volume placed = parse(begin + basis + "Offset: 0 0 0\n" + world);
  expect_near(placed.world_corners()[0], {100, 200, 300});
  expect_near(placed.world_corners()[7], {96, 205, 306});
  expect_near(world_of(placed, 1, 0, 0), {99.5, 201.5, 301});
  // Without an offset about the origin; without a basis a cube of side 2.
  expect_near(parse(begin + basis + world).world_corners()[7], {98, 202.5, 303});
  expect_near(parse(begin + world).world_corners()[0], {101, 199, 298});
  expect_near(parse(begin + "Offset: 7 8 9\n").world_corners()[0], {7, 8, 9});
  EXPECT_TRUE(contains(error(begin + "WorldVector4: 0 0 1 1\n"), "affine"));
  EXPECT_TRUE(contains(error(begin + "WorldVector1: 0 0 1\n"), "no four numbers"));
  EXPECT_TRUE(contains(error(begin + "BasisVector1: 1 0 0\n"), "not all of BasisVector1"));
}

TEST_F(DatTest, SpacingOfInviwoSpansCellsAboutTheOrigin) {
  for (const char* sides : {"Resolution", "Dimensions", "Dimension"}) {
    const Volume volume = parse("RawFile: v.raw\n" + std::string(sides) +
                                ": 5 4 3 # values\nFormat: FLOAT32\nSpacing: 1 2 3\n");
    expect_near(volume.description().placement.spacing, {1, 2, 3});
    EXPECT_EQ(volume.description().centering, Centering::cell);
    expect_near(volume.world_corners()[0], {-2.5, -4, -4.5});
    expect_near(volume.world_corners()[7], {2.5, 4, 4.5});
  }
  const Volume offset =
      parse("RawFile: v.raw\nResolution: 5 4 3\nFormat: FLOAT32\nSpacing: 1 2 3\nOffset: 7 8 9\n");
  expect_near(offset.world_corners()[0], {7, 8, 9});
}

TEST_F(DatTest, RangesMapTheValues) {
  write("v.raw", bytes_of(counting<std::uint16_t>()));
  const std::string begin = "RawFile: v.raw\nResolution: 5 4 3\n";
  const Volume mapped = parse(begin + "Format: UINT16\nDataRange: 0 100\nValueRange: -1000 1000\n");
  EXPECT_EQ(type_name(mapped.data()), "f32");
  EXPECT_EQ(test::value_at(mapped, 4, 3, 2), -1000 + 20 * 59);
  expect_counting(parse(begin + "Format: UINT16\nDataRange: 0 100\nValueRange: 0 100\n"), "u16");
  expect_counting(parse(begin + "Format: USHORT_12\n"), "u16");
  const Volume twelve = parse(begin + "Format: USHORT_12\nValueRange: 0 8190\n");
  EXPECT_EQ(test::value_at(twelve, 4, 3, 2), 118);
  EXPECT_TRUE(
      contains(error(begin + "Format: UINT16\nDataRange: 1 1\nValueRange: 0 5\n"), "DataRange"));
}

TEST_F(DatTest, BytesAreSkippedAndStepsAreComponents) {
  write("v.raw", "1234567" + bytes_of(counting()));
  const std::string begin = "RawFile: v.raw\nResolution: 5 4 3\nFormat: FLOAT32\n";
  expect_counting(parse(begin + "ByteOffset: 7\n"), "f32");
  EXPECT_TRUE(contains(error(begin + "ByteOffset: -7\n"), "ByteOffset: -7"));
  std::vector<float> two = counting();
  for (int i = 0; i < 60; ++i) two.push_back(100 + static_cast<float>(i));
  write("v.raw", bytes_of(two));
  write("a.dat", begin + "Sequences: 2\n");
  const std::vector<Volume> steps = read_components(path("a.dat"));
  ASSERT_EQ(steps.size(), 2u);
  expect_counting(steps[0], "f32");
  EXPECT_EQ(test::value_at(steps[1], 4, 3, 2), 159);
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.dat")); }), "2 time steps"));
  EXPECT_TRUE(contains(error(begin + "Sequences: 0\n"), "Sequences: 0"));
  EXPECT_TRUE(contains(error("DatFile: a.dat\nDatFile: b.dat\n"), "lists headers of steps"));
}

TEST_F(DatTest, VectorsAreComponents) {
  std::vector<std::uint8_t> values;
  for (int i = 0; i < 120; ++i) values.push_back(static_cast<std::uint8_t>(i / 2 + 60 * (i % 2)));
  write("v.raw", bytes_of(values));
  write("a.dat", "RawFile: v.raw\nResolution: 5 4 3\nFormat: Vec2UINT8\n");
  const std::vector<Volume> both = read_components(path("a.dat"));
  ASSERT_EQ(both.size(), 2u);
  expect_counting(both[0], "u8");
  EXPECT_EQ(test::value_at(both[1], 4, 3, 2), 119);
}

TEST_F(DatTest, WideAndHalfTypes) {
  const auto header = [](const std::string& format, bool big_endian = false) {
    return "RawFile: v.raw\nResolution: 5 4 3\nFormat: " + format + "\n" +
           (big_endian ? "ByteOrder: BigEndian\n" : "");
  };
  write("v.raw", bytes_of(test::counting_halves()));
  expect_counting(parse(header("FLOAT16")), "f32");
  write("v.raw", test::swapped_bytes_of(test::counting_halves()));
  expect_counting(parse(header("FLOAT16", true)), "f32");
  write("v.raw", bytes_of(counting<std::int64_t>()));
  expect_counting(parse(header("INT64")), "u8");
  std::vector<std::uint64_t> large = counting<std::uint64_t>();
  large[1] = ~std::uint64_t{0};
  write("v.raw", test::swapped_bytes_of(large));
  EXPECT_EQ(test::value_at(parse(header("UINT64", true)), 1, 0, 0), 18446744073709551616.);
  std::vector<std::int64_t> negative = counting<std::int64_t>();
  negative[0] = -7;
  write("v.raw", bytes_of(negative));
  EXPECT_EQ(test::value_at(parse(header("INT64")), 0, 0, 0), -7);
  write("v.raw", bytes_of(test::counting_halves()).substr(1));
  EXPECT_TRUE(contains(error(header("FLOAT16")), "119 bytes"));
}

TEST_F(DatTest, BadHeadersAreRefused) {
  const auto with = [](const std::string& resolution, const std::string& format) {
    return "RawFile: v.raw\nResolution: " + resolution + "\nFormat: " + format + "\n";
  };
  EXPECT_TRUE(contains(error(with("5 4 3", "nonsense")), "\"nonsense\" are not read"));
  EXPECT_TRUE(contains(error(with("5 4", "FLOAT")), "no three numbers"));
  EXPECT_TRUE(contains(error(with("5 4 0", "FLOAT")), "whole numbers from 1"));
  EXPECT_TRUE(contains(error(with("5 4 2.5", "FLOAT")), "whole numbers from 1"));
  EXPECT_TRUE(contains(error(with("1e9 1e9 1e9", "FLOAT")), "too large"));
  EXPECT_TRUE(contains(error(with("5 4 4", "FLOAT")), "240 bytes"));
  EXPECT_TRUE(contains(error(with("5 4 3", "FLOAT") + "RawFile: w.raw\n"), "several files"));
  EXPECT_TRUE(contains(error("RawFile: none.raw\nResolution: 5 4 3\nFormat: FLOAT\n"),
                       "none.raw: no such file"));
  EXPECT_TRUE(contains(error("RawFile: v.raw\nFormat: FLOAT\n"), "extension is not known"));
  EXPECT_TRUE(contains(error(with("5 4 3", "FLOAT") + "SliceThickness: 1 0 1\n"), "spacing"));
  EXPECT_TRUE(contains(error(with("5 4 3", "FLOAT") + "BasisVector1: 0 0 0\nBasisVector2: 0 1 0\n"
                                                      "BasisVector3: 0 0 1\n"),
                       "no length"));
}

// Values without a header may have the same extension.
TEST_F(DatTest, HeaderlessDataStaysHeaderless) {
  ReadOptions options;
  options.dimensions = {5, 4, 3};
  options.type = "f32";
  expect_counting(read_volume(write("m.dat", bytes_of(counting())), options), "f32");
}

}  // namespace
}  // namespace pellucid::test_dat_header
