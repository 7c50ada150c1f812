// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "volume_files.h"

namespace pellucid {
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

// numpy writes 2 × 3 × 4 in C order with the last axis fastest; x is the fastest axis in either.
TEST(Npy, TheFastestAxisIsX) {
  const std::string values = test::bytes_of(counting());
  const Volume c = parse(npy(dictionary("<f4", "False", "(3, 4, 5)"), values));
  const Volume f = parse(npy(dictionary("<f4", "True", "(5, 4, 3)"), values));
  expect_counting(c, "f32");
  expect_counting(f, "f32");
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
  for (const char* descr : {"<f2", "<i8", "<u8", "|b1", "<c8", "<c16", "|S4", "<U1", "|O", "<f16",
                            "f4", "=f4", "|f4", "", "<", "<m8[ns]", "\x01\xff"}) {
    SCOPED_TRACE(descr);
    EXPECT_TRUE(contains(error(npy(dictionary(descr), std::string(960, '\0'))), "is not read"));
  }
  EXPECT_TRUE(contains(error(npy(dictionary("<i8"), "")), "64-bit"));
  EXPECT_TRUE(contains(error(npy(dictionary("<f2"), "")), "half"));
}

TEST(Npy, OtherThanThreeAxesAreRefused) {
  for (const char* shape : {"()", "(60,)", "(3, 20)", "(1, 3, 4, 5, 1)"}) {
    SCOPED_TRACE(shape);
    EXPECT_TRUE(contains(error(npy(dictionary("<f4", "False", shape), test::bytes_of(counting()))),
                         "3 axes"));
  }
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
}  // namespace pellucid
