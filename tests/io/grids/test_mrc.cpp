// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_mrc {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::value_at;
using test::world_of;

/// The 256 words of a header, by their numbers in the description of MRC2014.
struct MrcFile {
  std::array<std::uint32_t, 256> words{};
  bool big_endian = false, stamp = true, map = true;

  MrcFile() {
    set(1, {5, 4, 3, 2});  // sides, mode
    set(8, {5, 4, 3});     // intervals of the cell
    real(11, {5, 8, 9}).real(14, {90, 90, 90});
    set(17, {1, 2, 3});
  }
  MrcFile& set(std::size_t word, const std::vector<std::int32_t>& values) {
    for (const std::int32_t v : values) words[word++ - 1] = static_cast<std::uint32_t>(v);
    return *this;
  }
  MrcFile& real(std::size_t word, const std::vector<float>& values) {
    for (const float v : values) words[word++ - 1] = std::bit_cast<std::uint32_t>(v);
    return *this;
  }
  std::string header() const {
    std::string bytes;
    for (const std::uint32_t word : words) {
      for (int i = 0; i < 4; ++i) bytes += static_cast<char>(word >> 8 * (big_endian ? 3 - i : i));
    }
    if (map) bytes.replace(208, 4, "MAP ");
    if (stamp) bytes.replace(212, 2, big_endian ? "\x11\x11" : "\x44\x44");
    return bytes;
  }
};

class MrcTest : public test::ScratchFolder {
 protected:
  Volume parse(const MrcFile& file, const std::string& values = bytes_of(counting()),
               const ReadOptions& options = {}) {
    return read_volume(write("a.mrc", file.header() + values), options);
  }
  std::string error(const MrcFile& file, const std::string& values = bytes_of(counting())) {
    return error_of([&] { parse(file, values); });
  }
  template <class Value>
  void expect_mode(int mode, const std::string& type) {
    SCOPED_TRACE(type);
    for (const bool stamp : {true, false}) {
      MrcFile file;
      file.set(4, {mode});
      file.stamp = stamp;
      expect_counting(parse(file, bytes_of(counting<Value>())), type);
      file.big_endian = true;
      expect_counting(parse(file, test::swapped_bytes_of(counting<Value>())), type);
    }
  }
};

TEST_F(MrcTest, ModesInBothByteOrders) {
  expect_mode<std::int8_t>(0, "i8");
  expect_mode<std::int16_t>(1, "i16");
  expect_mode<float>(2, "f32");
  expect_mode<std::uint16_t>(6, "u16");
  MrcFile file;
  EXPECT_TRUE(contains(error(file.set(4, {4})), "complex"));
  EXPECT_TRUE(contains(error(file.set(4, {101})), "mode 101"));
  EXPECT_TRUE(contains(error(file.set(4, {-1})), "mode -1"));
}

TEST_F(MrcTest, HalfFloats) {
  MrcFile file;
  file.set(4, {12});
  expect_counting(parse(file, bytes_of(test::counting_halves())), "f32");
  // 1/2, −2, the smallest number, NaN.
  std::vector<std::uint16_t> values = test::counting_halves();
  values[0] = 0x3800;
  values[1] = 0xc000;
  values[2] = 0x0001;
  values[3] = 0x7e00;
  const Volume volume = parse(file, bytes_of(values));
  EXPECT_EQ(value_at(volume, 0, 0, 0), 0.5);
  EXPECT_EQ(value_at(volume, 1, 0, 0), -2);
  EXPECT_EQ(value_at(volume, 2, 0, 0), std::ldexp(1., -24));
  EXPECT_EQ(volume.statistics().nan, 1U);
  values[3] = 0xfc00;
  EXPECT_TRUE(contains(error(file, bytes_of(values)), "infinite"));
  EXPECT_TRUE(contains(error(file, std::string(119, '\0')), "cut off"));
  file.big_endian = true;
  expect_counting(parse(file, test::swapped_bytes_of(test::counting_halves())), "f32");
}

TEST_F(MrcTest, Gzipped) {
  MrcFile file;
  file.set(24, {7});
  const std::string whole = file.header() + "1234567" + bytes_of(counting());
  const std::string packed = test::gzipped(whole);
  for (const char* name : {"a.mrc.gz", "a.map.gz", "a.CCP4.GZ"}) {
    expect_counting(read_volume(write(name, packed)), "f32");
  }
  // What is not gzipped, and what is by another name.
  expect_counting(read_volume(write("b.map.gz", whole)), "f32");
  expect_counting(read_volume(write("b.map", packed)), "f32");
  // The last four bytes only repeat the length.
  for (std::size_t length = 0; length < packed.size() - 4; length += 7) {
    write("cut.mrc.gz", packed.substr(0, length));
    error_of([&] { read_volume(path("cut.mrc.gz")); });
  }
  write("short.mrc.gz", test::gzipped(whole.substr(0, whole.size() - 1)));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("short.mrc.gz")); }), "cut off"));
}

TEST_F(MrcTest, AStackOfGzippedVolumesGivesAnyOfThem) {
  MrcFile file;
  file.set(3, {6}).set(10, {3}).set(23, {401});
  std::vector<float> values = counting();
  for (int i = 60; i < 120; ++i) values.push_back(static_cast<float>(i));
  write("a.mrc.gz", test::gzipped(file.header() + bytes_of(values)));
  ReadOptions options;
  options.component = 1;
  EXPECT_EQ(value_at(read_volume(path("a.mrc.gz"), options), 4, 3, 2), 119);
  options.component = 0;
  expect_counting(read_volume(path("a.mrc.gz"), options), "f32");
}

TEST_F(MrcTest, UnsignedBytesOfOldFiles) {
  const std::string values(60, '\xc8');  // 200, or -56
  const auto value = [&](const MrcFile& file) { return value_at(parse(file, values), 1, 1, 1); };
  MrcFile file;
  file.set(4, {0});
  EXPECT_EQ(value(file), -56);
  EXPECT_EQ(value(file.set(39, {1146047817, 0})), 200);
  EXPECT_EQ(value(file.set(39, {1146047817, 1})), -56);
  EXPECT_EQ(value(file.set(39, {0, 0}).real(20, {0, 200})), 200);
  EXPECT_EQ(value(file.real(20, {-56, 100})), -56);
}

TEST_F(MrcTest, ExtensionsAndExtendedHeader) {
  MrcFile file;
  file.set(24, {7});
  for (const char* name : {"a.mrc", "a.map", "a.rec", "a.st", "a.CCP4"}) {
    write(name, file.header() + "1234567" + bytes_of(counting()));
    expect_counting(read_volume(path(name)), "f32");
  }
  EXPECT_TRUE(contains(error(file), "cut off"));
  EXPECT_TRUE(contains(error(file.set(24, {-1})), "-1 bytes"));
}

TEST_F(MrcTest, PlacedByCellStartAndOrigin) {
  MrcFile file;
  expect_near(world_of(parse(file), 4, 3, 2), {4, 6, 6});
  file.set(5, {10, -1, 2});
  expect_near(world_of(parse(file), 0, 0, 0), {10, -2, 6});
  // An origin goes before the start, but only where "MAP " says that there is one.
  file.real(50, {1, 2, 3});
  expect_near(world_of(parse(file), 4, 3, 2), {5, 8, 9});
  file.map = false;
  expect_near(world_of(parse(file), 0, 0, 0), {10, -2, 6});
}

// Columns along z, rows along x, sections along y.
TEST_F(MrcTest, PermutedAxesStandInTheWorld) {
  MrcFile file;
  file.set(17, {3, 1, 2}).set(5, {1, 2, 3});
  file.set(8, {4, 3, 5}).real(11, {8, 9, 5});  // spacing 2, 3, 1 along x, y, z
  const Volume volume = parse(file);
  expect_counting(volume, "f32");
  expect_near(world_of(volume, 4, 3, 2), {(2 + 3) * 2, (3 + 2) * 3, 1 + 4});
  EXPECT_TRUE(contains(error(file.set(17, {1, 1, 3})), "1, 1 and 3"));
  EXPECT_TRUE(contains(error(file.set(17, {0, 1, 2})), "0, 1 and 2"));
  file.set(17, {0, 0, 0}).set(8, {5, 4, 3}).set(5, {0, 0, 0});
  std::string notes;
  ReadOptions options;
  options.note = [&](const std::string& text) { notes += text + "\n"; };
  parse(file, bytes_of(counting()), options);
  EXPECT_TRUE(contains(notes, "MAPC, MAPR, MAPS are 0")) << notes;
  expect_near(world_of(parse(file), 1, 0, 0), {8. / 5, 0, 0});
}

TEST_F(MrcTest, ACellWithAnglesIsSheared) {
  MrcFile file;
  file.real(14, {90, 90, 120});
  const double s = std::sin(2 * std::numbers::pi / 3);
  expect_near(world_of(parse(file), 4, 3, 2), {4 - 6 * 0.5, 6 * s, 6});
  file.real(14, {60, 60, 60});
  // The third edge of a regular tetrahedron: (1/2, 1/√12, √(2/3)).
  expect_near(world_of(parse(file), 0, 0, 2), {3, 6 / std::sqrt(12), 6 * std::sqrt(2. / 3)});
  EXPECT_TRUE(contains(error(file.real(14, {10, 20, 90})), "angles that no cell has"));
  EXPECT_TRUE(contains(error(file.real(14, {180, 90, 90})), "180"));
  EXPECT_TRUE(contains(error(file.real(14, {NAN, 90, 90})), "nan degrees"));
  file.real(14, {0, 0, 0});
  expect_near(world_of(parse(file), 4, 3, 2), {4, 6, 6});
}

TEST_F(MrcTest, ACellWithoutSizeIsTold) {
  for (const float size : {0.F, -5.F, INFINITY, NAN}) {
    MrcFile file;
    file.real(12, {size});
    std::string notes;
    ReadOptions options;
    options.note = [&](const std::string& text) { notes += text; };
    const Volume volume = parse(file, bytes_of(counting()), options);
    expect_near(world_of(volume, 4, 3, 2), {4, 3, 6});
    EXPECT_TRUE(contains(notes, "along y; the spacing is taken to be 1")) << notes;
  }
  MrcFile file;
  file.set(8, {5, 0, 3});
  expect_near(world_of(parse(file), 4, 3, 2), {4, 3, 6});
}

TEST_F(MrcTest, SeveralVolumesAreComponents) {
  MrcFile file;
  file.set(3, {6}).set(10, {3}).set(23, {401});
  std::vector<float> values = counting();
  for (int i = 60; i < 120; ++i) values.push_back(static_cast<float>(i));
  const std::vector<Volume> both =
      read_components(write("a.mrc", file.header() + bytes_of(values)));
  ASSERT_EQ(both.size(), 2u);
  expect_counting(both[0], "f32");
  EXPECT_EQ(value_at(both[1], 4, 3, 2), 119);
  EXPECT_TRUE(contains(error(file, bytes_of(values)), "2 volumes"));
  EXPECT_TRUE(contains(error(file.set(3, {7}), bytes_of(values)), "volumes of 3"));
}

TEST_F(MrcTest, AStackOfImagesIsTold) {
  const auto notes = [&](const MrcFile& file) {
    std::string all;
    ReadOptions options;
    options.note = [&](const std::string& note) { all += note + "\n"; };
    parse(file, bytes_of(counting()), options);
    return all;
  };
  MrcFile file;
  file.real(13, {3});
  EXPECT_TRUE(contains(notes(file.set(10, {1}).set(23, {0})), "stack of images (ISPG 0, MZ 1)"));
  EXPECT_EQ(notes(file.set(23, {1})), "");
  EXPECT_EQ(notes(file.set(10, {3}).set(23, {0})), "");
}

TEST_F(MrcTest, EveryTruncationIsAnError) {
  const std::string whole = MrcFile{}.header() + bytes_of(counting());
  for (std::size_t length = 0; length < whole.size(); length += length < 1000 ? 97 : 1) {
    write("cut.mrc", whole.substr(0, length));
    EXPECT_TRUE(contains(error_of([&] { read_volume(path("cut.mrc")); }), "cut off")) << length;
  }
}

TEST_F(MrcTest, BadHeadersAreRefused) {
  EXPECT_TRUE(contains(error(MrcFile{}.set(1, {0})), "0 x 4 x 3"));
  EXPECT_TRUE(contains(error(MrcFile{}.set(1, {-5})), "-5 x 4 x 3"));
  EXPECT_TRUE(contains(error(MrcFile{}.set(1, {2000000000, 2000000000, 2000000000})), "too large"));
  EXPECT_TRUE(contains(error(MrcFile{}.set(1, {100000, 100000, 100000})), "cut off"));
  EXPECT_TRUE(contains(error(MrcFile{}.real(50, {INFINITY, 0, 0})), "origin"));
  // Nothing may be taken off the least of all numbers: the fuzz check's sanitizer found that.
  constexpr int least = std::numeric_limits<int>::min();
  EXPECT_TRUE(contains(error(MrcFile{}.set(17, {least, 2, 3})), "axes -2147483648, 2 and 3"));
  EXPECT_TRUE(contains(error(MrcFile{}.set(17, {1, 1, 3})), "axes 1, 1 and 3"));
  MrcFile file;
  file.stamp = false;
  EXPECT_TRUE(contains(error(file.set(1, {-1})), "does not begin"));
  write("a.map", std::string(2000, 'x'));
  EXPECT_FALSE(error_of([&] { read_volume(path("a.map")); }).empty());
  ReadOptions options;
  options.type = "u8";
  EXPECT_TRUE(contains(error_of([&] { parse({}, bytes_of(counting()), options); }), "headerless"));
}

}  // namespace
}  // namespace pellucid::test_mrc
