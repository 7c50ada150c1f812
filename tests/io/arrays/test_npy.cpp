// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "pellucid/io/internal/parse_arrays.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_npy {
namespace {

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;

std::string dictionary(const std::string& descr, const std::string& order = "False",
                       const std::string& shape = "(3, 4, 5)") {
  return "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
}

std::string npy(const std::string& header, const std::string& values, char version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  const std::uint32_t length = static_cast<std::uint32_t>(header.size());
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i) {
    bytes += static_cast<char>(length >> (8 * i));
  }
  return bytes + header + values;
}

Volume parse(const std::string& file, const ReadOptions& options = {}) {
  const std::span<const std::byte> view = std::as_bytes(std::span(file));
  const std::vector<std::byte> bytes(view.begin(), view.end());
  return parse_npy(bytes, "a.npy", options);
}

std::string error(const std::string& file, const ReadOptions& options = {}) {
  return error_of([&] { parse(file, options); });
}

template <class Value>
void expect_both_orders(const std::string& kind, const std::string& type) {
  SCOPED_TRACE(type);
  expect_counting(parse(npy(dictionary("<" + kind), test::bytes_of(counting<Value>()))), type);
  expect_counting(parse(npy(dictionary(">" + kind), test::swapped_bytes_of(counting<Value>()))),
                  type);
}

TEST(Npy, AllTypesInBothByteOrders) {
  expect_both_orders<std::uint8_t>("u1", "u8");
  expect_both_orders<std::int8_t>("i1", "i8");
  expect_both_orders<std::uint16_t>("u2", "u16");
  expect_both_orders<std::int16_t>("i2", "i16");
  expect_both_orders<std::uint32_t>("u4", "u32");
  expect_both_orders<std::int32_t>("i4", "i32");
  expect_both_orders<float>("f4", "f32");
  expect_both_orders<double>("f8", "f64");
  expect_counting(parse(npy(dictionary("|u1"), test::bytes_of(counting<std::uint8_t>()))), "u8");
}

TEST(Npy, ExtremesOfEachTypeKeepTheirValue) {
  const auto extremes = [](auto value, const std::string& descr) {
    using Value = decltype(value);
    // Of floating numbers the largest that a Volume takes, and the smallest there is.
    constexpr bool floating = std::is_floating_point_v<Value>;
    std::vector<Value> values(8, floating ? Value(-1e37) : std::numeric_limits<Value>::lowest());
    values[6] = floating ? std::numeric_limits<Value>::denorm_min() : Value(1);
    values[7] = floating ? Value(1e37) : std::numeric_limits<Value>::max();
    const Volume volume =
        parse(npy(dictionary(descr, "False", "(2, 2, 2)"), test::bytes_of(values)));
    EXPECT_EQ(std::get<DataArray<Value>>(volume.data()), values);
  };
  extremes(std::uint8_t{}, "|u1");
  extremes(std::int8_t{}, "|i1");
  extremes(std::uint16_t{}, "<u2");
  extremes(std::int16_t{}, "<i2");
  extremes(std::uint32_t{}, "<u4");
  extremes(std::int32_t{}, "<i4");
  extremes(0.F, "<f4");
  extremes(0., "<f8");
}

TEST(Npy, VersionsOneToThree) {
  for (const char version : {'\1', '\2', '\3'}) {
    expect_counting(parse(npy(dictionary("<f4"), test::bytes_of(counting()), version)), "f32");
  }
  EXPECT_TRUE(contains(error(npy(dictionary("<f4"), "", '\4')), "version 4"));
  EXPECT_TRUE(contains(error(npy(dictionary("<f4"), "", '\0')), "version 0"));
}

/// The value of an element is 100 times its first index, 10 times the second and so on.
struct TestArray {
  std::vector<int> shape;
  std::string descr = "<i2";

  template <class Value = std::int16_t>
  std::string file(bool fortran) const {
    std::size_t count = 1;
    std::string text;
    for (const int n : shape) {
      count *= static_cast<std::size_t>(n);
      text += std::to_string(n) + ", ";
    }
    std::vector<Value> values(count);
    std::vector<int> index(shape.size(), 0);
    for (Value& value : values) {
      int number = 0;
      for (const int i : index) number = 10 * number + i;
      value = static_cast<Value>(number);
      for (std::size_t n = 0; n < shape.size(); ++n) {
        const std::size_t axis = fortran ? n : shape.size() - 1 - n;
        if (++index[axis] < shape[axis]) break;
        index[axis] = 0;
      }
    }
    return npy(dictionary(descr, fortran ? "True" : "False", "(" + text + ")"),
               test::bytes_of(values));
  }
};

ReadOptions with_axes(const std::string& axes, std::optional<int> component = {}) {
  ReadOptions options;
  options.axes = axes;
  options.component = component;
  return options;
}

TEST(Npy, AxesFollowTheIndicesAndNotTheMemory) {
  const TestArray array{{3, 4, 5}};
  for (const bool fortran : {false, true}) {
    SCOPED_TRACE(fortran);
    const Volume volume = parse(array.file(fortran));
    EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{5, 4, 3}));
    EXPECT_EQ(test::value_at(volume, 4, 2, 1), 124);
    for (const std::string axes : {"zyx", "zxy", "yzx", "yxz", "xyz", "xzy", "XYZ"}) {
      SCOPED_TRACE(axes);
      const Volume named = parse(array.file(fortran), with_axes(axes));
      for (int i = 0; i < 60; ++i) {
        const std::array<int, 3> index{i / 20, i / 5 % 4, i % 5};
        std::array<int, 3> place{};
        for (std::size_t a = 0; a < 3; ++a) {
          place[static_cast<std::size_t>((axes[a] | 0x20) - 'x')] = index[a];
        }
        ASSERT_EQ(test::value_at(named, place[0], place[1], place[2]),
                  100 * index[0] + 10 * index[1] + index[2]);
      }
    }
  }
}

TEST(Npy, LargeArraysArePermutedInTiles) {
  std::vector<std::uint32_t> values(std::size_t{67} * 35 * 70);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::uint32_t>(i);
  for (const bool big : {false, true}) {
    const std::string bytes = big ? test::swapped_bytes_of(values) : test::bytes_of(values);
    const Volume volume =
        parse(npy(dictionary(big ? ">u4" : "<u4", "True", "(67, 35, 70)"), bytes));
    for (const auto& [x, y, z] : {std::array{69, 34, 66}, {0, 1, 2}, {33, 31, 65}, {64, 0, 0}}) {
      EXPECT_EQ(test::value_at(volume, x, y, z), z + 67 * (y + 35 * x));
    }
  }
}

/// What is noted of a file, and its components.
struct Noted {
  std::vector<Volume> components;
  std::string notes;
};

class NpyFiles : public test::ScratchFolder {
 protected:
  Noted read(const std::string& file, ReadOptions options = {}, const std::string& name = "a.npy") {
    Noted noted;
    options.note = [&](const std::string& line) { noted.notes += line + "\n"; };
    noted.components = read_components(write(name, file), options);
    return noted;
  }
};

TEST_F(NpyFiles, FourAxesHaveComponentsWhereThatIsPlausible) {
  const auto expect = [&](const std::vector<int>& shape, const std::string& axes) {
    SCOPED_TRACE(axes + " " + std::to_string(shape[0]) + " " + std::to_string(shape[3]));
    for (const bool fortran : {false, true}) {
      const Noted noted = read(TestArray{shape}.file(fortran));
      const std::size_t c = axes.find('c');
      ASSERT_EQ(noted.components.size(), static_cast<std::size_t>(shape[c]));
      EXPECT_TRUE(contains(noted.notes, "axes " + axes)) << noted.notes;
      std::vector<int> index(4, 1);
      const int last = shape[c] - 1;
      index[c] = last;
      EXPECT_EQ(test::value_at(noted.components[static_cast<std::size_t>(last)], 1, 1, 1),
                ((index[0] * 10 + index[1]) * 10 + index[2]) * 10 + index[3]);
    }
  };
  expect({3, 12, 11, 28}, "czyx");
  expect({12, 11, 28, 3}, "zyxc");
  expect({6, 12, 11, 28}, "czyx");
  expect({12, 11, 28, 6}, "zyxc");
  expect({20, 11, 9, 10}, "czyx");  // steps
  expect({20, 3, 9, 10}, "zcyx");
  expect({2, 3, 4, 5}, "czyx");
  expect({5, 4, 3, 2}, "zyxc");
  expect({2, 10, 10, 3}, "zyxc");  // slices of colors
  expect({2, 2, 2, 2}, "zyxc");
  expect({2, 2, 2, 3}, "zyxc");
  expect({2, 3, 4, 3}, "czyx");
  expect({5, 6, 7, 8}, "czyx");
  const Noted told = read(TestArray{{3, 4, 5, 3}}.file(true), with_axes("cxyz"));
  EXPECT_EQ(told.notes, "");
  ASSERT_EQ(told.components.size(), 3u);
  EXPECT_EQ(told.components[2].description().dimensions, (std::array<int, 3>{4, 5, 3}));
  EXPECT_EQ(test::value_at(told.components[2], 3, 1, 2), 2312);
  EXPECT_EQ(read(TestArray{{3, 4, 5, 2}}.file(false), with_axes("tzyx", 1)).components.size(), 1u);
}

TEST_F(NpyFiles, AxesOfOneEntryInFrontAndBehindDoNotCount) {
  for (const std::vector<int>& shape :
       {std::vector{1, 1, 3, 4, 5}, {1, 3, 4, 5}, {3, 4, 5, 1}, {1, 3, 4, 5, 1, 1}}) {
    for (const bool fortran : {false, true}) {
      const Noted noted = read(TestArray{shape}.file(fortran));
      ASSERT_EQ(noted.components.size(), 1u);
      EXPECT_EQ(noted.components[0].description().dimensions, (std::array<int, 3>{5, 4, 3}));
      EXPECT_EQ(noted.notes, "");
    }
  }
  EXPECT_EQ(read(TestArray{{1, 2, 3, 4, 5}}.file(false)).components.size(), 2u);
  const Noted told = read(TestArray{{1, 1, 3, 4, 5}}.file(false), with_axes("xyz"));
  EXPECT_EQ(told.components[0].description().dimensions, (std::array<int, 3>{3, 4, 5}));
}

TEST(Npy, AxesThatDoNotFitAreRefused) {
  const std::string file = TestArray{{3, 4, 5}}.file(false);
  for (const char* axes : {"", "x", "zy", "zzy", "zyq", "cyx", "zyxcc", "zyxct", "\n\n\n"}) {
    EXPECT_TRUE(contains(error(file, with_axes(axes)), "not understood")) << axes;
  }
  EXPECT_TRUE(contains(error(file, with_axes("czyx")), "give a letter for each"));
  EXPECT_TRUE(contains(error(TestArray{{2, 3, 4, 5}}.file(false), with_axes("zyx")), "4 axes"));
}

template <class Value>
void expect_whole(const std::string& kind, const std::vector<Value>& some, const std::string& type,
                  const std::string& note = {}) {
  SCOPED_TRACE(type);
  std::vector<Value> values(8, some.front());
  std::ranges::copy(some, values.begin());
  for (const bool big : {false, true}) {
    const std::string bytes = big ? test::swapped_bytes_of(values) : test::bytes_of(values);
    std::string notes;
    ReadOptions options;
    options.note = [&](const std::string& line) { notes += line; };
    const Volume volume =
        parse(npy(dictionary((big ? ">" : "<") + kind, "False", "(2, 2, 2)"), bytes), options);
    EXPECT_EQ(type_name(volume.data()), type);
    for (int i = 0; i < 8; ++i) {
      EXPECT_EQ(test::value_at(volume, i % 2, i / 2 % 2, i / 4),
                static_cast<double>(values[static_cast<std::size_t>(i)]));
    }
    if (note.empty()) {
      EXPECT_EQ(notes, "");
    } else {
      EXPECT_TRUE(contains(notes, note)) << notes;
    }
  }
}

TEST(Npy, WholeNumbersOf64BitsAreKeptInTheSmallestType) {
  using Signed = std::int64_t;
  using Unsigned = std::uint64_t;
  expect_whole<Signed>("i8", {0, 255}, "u8");
  expect_whole<Signed>("i8", {-128, 127}, "i8");
  expect_whole<Signed>("i8", {255, -1}, "i16");
  expect_whole<Signed>("i8", {65535, 256}, "u16");
  expect_whole<Signed>("i8", {-32768, 32767}, "i16");
  expect_whole<Signed>("i8", {5, 4294967295, 65536}, "u32");
  expect_whole<Signed>("i8", {-2147483648, 2147483647}, "i32");
  expect_whole<Signed>("i8", {-1, 4294967295}, "f64");
  expect_whole<Signed>("i8", {9007199254740992, -9007199254740992, 9007199254740994}, "f64");
  expect_whole<Signed>("i8", {1, 9007199254740993}, "f64",
                       "1 of 8 whole numbers of 64 bits does not fit double and is rounded, by at "
                       "most 1");
  expect_whole<Signed>("i8", {std::numeric_limits<Signed>::lowest(), 0}, "f64");
  expect_whole<Signed>("i8", {1, std::numeric_limits<Signed>::max()}, "f64", "1 of 8 whole");
  expect_whole<Unsigned>("u8", {0, 200}, "u8");
  expect_whole<Unsigned>("u8", {4294967296, 200}, "f64");
  expect_whole<Unsigned>("u8", {0, ~Unsigned{0}, ~Unsigned{0} - 511}, "f64",
                         "2 of 8 whole numbers of 64 bits do not fit double and are rounded, by at "
                         "most 512");
}

// The type of a long array is not known before its end.
TEST(Npy, TheTypeWidensAsLargerNumbersCome) {
  std::vector<std::int64_t> values(std::size_t{64} * 64 * 64);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int64_t>(i % 200);
  values[70000] = 300;
  values[140000] = -70000;
  values[200000] = 5'000'000'000;
  const Volume volume =
      parse(npy(dictionary("<i8", "False", "(64, 64, 64)"), test::bytes_of(values)));
  const auto& data = std::get<DataArray<double>>(volume.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(data[i], static_cast<double>(values[i]));
  }
}

TEST_F(NpyFiles, WholeNumbersOfComponentsAreOfOneType) {
  std::vector<std::int64_t> values(120, 7);
  values[1] = 300;
  for (const std::string shape : {"(3, 4, 5, 2)", "(2, 3, 4, 5)"}) {
    const Noted noted = read(npy(dictionary("<i8", "False", shape), test::bytes_of(values)));
    ASSERT_EQ(noted.components.size(), 2u);
    for (const Volume& volume : noted.components) EXPECT_EQ(type_name(volume.data()), "u16");
  }
}

TEST(Npy, TruthValuesAreZeroAndOne) {
  std::string values(60, '\0');
  values[7] = '\1';
  const Volume volume = parse(npy(dictionary("|b1"), values));
  EXPECT_EQ(type_name(volume.data()), "u8");
  EXPECT_EQ(test::value_at(volume, 2, 1, 0), 1);
  EXPECT_EQ(volume.statistics().maximum, 1);
}

// Each of the 65536, against the definition: sign, exponent - 15, fraction / 1024.
TEST(Npy, HalfFloatsAreExact) {
  std::vector<std::uint16_t> halves;
  for (unsigned bits = 0; bits < 0x10000; ++bits) {
    const bool infinite = (bits & 0x7fffU) == 0x7c00U;
    halves.push_back(infinite ? std::uint16_t{0} : static_cast<std::uint16_t>(bits));
  }
  for (const bool big : {false, true}) {
    const std::string bytes = big ? test::swapped_bytes_of(halves) : test::bytes_of(halves);
    const Volume volume =
        parse(npy(dictionary(big ? ">f2" : "<f2", "False", "(16, 64, 64)"), bytes));
    const auto& values = std::get<DataArray<float>>(volume.data());
    for (std::size_t i = 0; i < halves.size(); ++i) {
      const int exponent = halves[i] >> 10 & 31, fraction = halves[i] & 1023;
      if (exponent == 31) {
        ASSERT_TRUE(std::isnan(values[i]));
        continue;
      }
      const double size = exponent == 0 ? std::ldexp(fraction, -24)
                                        : std::ldexp(1 + fraction / 1024., exponent - 15);
      ASSERT_EQ(static_cast<double>(values[i]), (halves[i] & 0x8000) != 0 ? -size : size);
    }
  }
  std::vector<std::uint16_t> infinite = test::counting_halves();
  infinite[3] = 0xfc00;
  EXPECT_TRUE(contains(error(npy(dictionary("<f2"), test::bytes_of(infinite))), "infinite"));
  // In the order of Fortran and of two components, whose values lie side by side.
  expect_counting(parse(npy(dictionary("<f2"), test::bytes_of(test::counting_halves()))), "f32");
  const Volume turned =
      parse(npy(dictionary("<f2", "True", "(5, 4, 3)"), test::bytes_of(test::counting_halves())),
            with_axes("xyz"));
  expect_counting(turned, "f32");
}

TEST(Npy, PlacementIsTheIndexUnlessGiven) {
  const std::string file = npy(dictionary("<f4"), test::bytes_of(counting()));
  const Volume plain = parse(file);
  test::expect_near(test::world_of(plain, 4, 3, 2), {4, 3, 2}, 0);
  EXPECT_EQ(plain.description().centering, Centering::point);
  ReadOptions options;
  options.spacing = Vec3<double>{1, 2, 3};
  options.origin = Vec3<double>{10, 20, 30};
  options.centering = Centering::cell;
  const Volume given = parse(file, options);
  test::expect_near(test::world_of(given, 4, 3, 2), {14, 26, 36}, 0);
  EXPECT_EQ(given.description().centering, Centering::cell);
}

TEST(Npy, TheHeaderMayBeSpacedAndOrderedAsItLikes) {
  const std::string values = test::bytes_of(counting());
  for (const char* header :
       {"{\"shape\": (3,4,5), \"fortran_order\":False,\"descr\":\"<f4\"}",
        "  { 'shape' :( 3 , 4 , 5 , ) ,\n'descr': '<f4' , 'fortran_order' : False }   \n",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3L, 4L, 5L), }      \n"}) {
    expect_counting(parse(npy(header, values)), "f32");
  }
}

TEST(Npy, HeadersThatAreNotOneAreRefused) {
  const std::string values = test::bytes_of(counting());
  for (const char* header :
       {"",
        "{",
        "{}",
        "[]",
        "{'descr': '<f4'}",
        "{'descr': '<f4', 'fortran_order': False}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5)",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5)} x",
        "{'descr': '<f4', 'fortran_order': 0, 'shape': (3, 4, 5)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': [3, 4, 5]}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3 4 5)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4.0, 5)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3, -4, 5)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (60)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3,, 4, 5)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999, 1, 1)}",
        "{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5), 'more': 1}",
        "{'descr': '<f4' 'fortran_order': False, 'shape': (3, 4, 5)}",
        "{'descr: '<f4', 'fortran_order': False, 'shape': (3, 4, 5)}",
        "{descr: '<f4', 'fortran_order': False, 'shape': (3, 4, 5)}",
        "{'de\\x73cr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5)}"}) {
    SCOPED_TRACE(header);
    EXPECT_TRUE(contains(error(npy(header, values)), ".npy header"));
  }
  EXPECT_TRUE(contains(
      error(npy("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (3, 4, 5)}", values)),
      "several fields"));
}

TEST(Npy, TypesThatAreNotReadAreNamed) {
  for (const char* descr : {"<c8", "<c16", "|S4", "<U1", "|O", "<f16", "f4", "=f4", "|f4", "|i8",
                            "|f2", "b1", "", "<", "<m8[ns]", "|V2", "\x01\xff"}) {
    SCOPED_TRACE(descr);
    EXPECT_TRUE(contains(error(npy(dictionary(descr), std::string(960, '\0'))), "is not read"));
  }
  EXPECT_TRUE(contains(error(npy(dictionary("<c8"), "")), "complex"));
  EXPECT_TRUE(contains(error(npy(dictionary("|O"), "")), "Python objects"));
}

TEST(Npy, OtherThanThreeAxesAreRefused) {
  for (const char* shape : {"()", "(60,)", "(2, 2, 3, 1, 5)"}) {
    SCOPED_TRACE(shape);
    EXPECT_TRUE(contains(error(npy(dictionary("<f4", "False", shape), test::bytes_of(counting()))),
                         "3 axes"));
  }
  EXPECT_TRUE(
      contains(error(npy(dictionary("<f4", "False", "(3, 20)"), "")), "an image of 2 axes"));
}

TEST(Npy, SizesMustAgree) {
  const std::string file = npy(dictionary("<f4"), test::bytes_of(counting()));
  for (std::size_t length = 0; length < file.size(); ++length) {
    error(file.substr(0, length));
  }
  EXPECT_TRUE(contains(error(file.substr(0, file.size() - 1)), "239 bytes"));
  EXPECT_TRUE(contains(error(file + "x"), "241 bytes"));
  EXPECT_TRUE(contains(error(npy(dictionary("<f4", "False", "(3, 0, 5)"), "")), "5 x 0 x 3"));
  error(npy(dictionary("<f8", "False", "(2147483647, 2147483647, 2147483647)"), ""));
  error(npy(dictionary("<f8", "False", "(4294967296, 4294967296, 2)"), ""));
  // A product that wraps around 64 bits to the number of bytes that are there.
  error(npy(dictionary("|u1", "False", "(4194304, 2097152, 2097152)"), ""));
}

TEST(Npy, AHeaderThatClaimsToBeLongIsNotReserved) {
  std::string file = npy(dictionary("<f4"), "", '\2');
  file[8] = file[9] = file[10] = file[11] = '\xff';
  EXPECT_TRUE(contains(error(file), "cut off"));
}

TEST(Npy, NanIsKeptAndInfinityRefused) {
  std::vector<float> values = counting();
  values[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(parse(npy(dictionary("<f4"), test::bytes_of(values))).statistics().nan, 1u);
  values[9] = -std::numeric_limits<float>::infinity();
  EXPECT_TRUE(contains(error(npy(dictionary("<f4"), test::bytes_of(values))), "infinite"));
}

TEST(Npy, OptionsOfHeaderlessDataAreRefused) {
  const std::string file = npy(dictionary("<f4"), test::bytes_of(counting()));
  ReadOptions options;
  options.type = "f32";
  EXPECT_TRUE(contains(error(file, options), "headerless"));
}

}  // namespace
}  // namespace pellucid::test_npy
