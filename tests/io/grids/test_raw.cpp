// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "pellucid/io/internal/parse_arrays.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_raw {
namespace {

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;

ReadOptions raw(const std::string& type, std::array<int, 3> dimensions = {5, 4, 3}) {
  ReadOptions options;
  options.dimensions = dimensions;
  options.type = type;
  return options;
}

Volume parse(const std::string& file, const ReadOptions& options) {
  const std::span<const std::byte> view = std::as_bytes(std::span(file));
  const std::vector<std::byte> bytes(view.begin(), view.end());
  return parse_raw(bytes, "a.raw", options);
}

std::string error(const std::string& file, const ReadOptions& options) {
  return error_of([&] { parse(file, options); });
}

template <class Value>
void expect_both_orders(const std::string& type, const std::string& kept) {
  SCOPED_TRACE(type);
  ReadOptions options = raw(type);
  expect_counting(parse(test::bytes_of(counting<Value>()), options), kept);
  options.big_endian = false;
  expect_counting(parse(test::bytes_of(counting<Value>()), options), kept);
  options.big_endian = true;
  expect_counting(parse(test::swapped_bytes_of(counting<Value>()), options), kept);
}
template <class Value>
void expect_both_orders(const std::string& type) {
  expect_both_orders<Value>(type, type);
}

TEST(Raw, AllTypesInBothByteOrders) {
  expect_both_orders<std::uint8_t>("u8");
  expect_both_orders<std::int8_t>("i8");
  expect_both_orders<std::uint16_t>("u16");
  expect_both_orders<std::int16_t>("i16");
  expect_both_orders<std::uint32_t>("u32");
  expect_both_orders<std::int32_t>("i32");
  expect_both_orders<float>("f32");
  expect_both_orders<double>("f64");
  expect_both_orders<std::int64_t>("i64", "u8");
  expect_both_orders<std::uint64_t>("u64", "u8");
  const std::string halves = test::bytes_of(test::counting_halves());
  expect_counting(parse(halves, raw("f16")), "f32");
}

TEST(Raw, ComponentsOf64BitsAndHalves) {
  std::vector<std::int64_t> numbers(240);
  std::vector<std::uint16_t> halves(240);
  for (std::size_t i = 0; i < 240; ++i) {
    // Components are i, -1, 2 i and 300 i.
    const auto point = static_cast<std::int64_t>(i / 4);
    numbers[i] = std::array<std::int64_t, 4>{point, -1, 2 * point, 300 * point}[i % 4];
    halves[i] = i % 4 == 2 ? test::counting_halves()[i / 4] : std::uint16_t{0x3c00};
  }
  ReadOptions options = raw("i64");
  options.components = 4;
  options.component = 3;
  EXPECT_EQ(type_name(parse(test::bytes_of(numbers), options).data()), "u16");
  EXPECT_EQ(test::value_at(parse(test::bytes_of(numbers), options), 4, 3, 2), 300 * 59);
  options.component = 0;
  expect_counting(parse(test::bytes_of(numbers), options), "u8");
  options.type = "f16";
  options.component = 2;
  expect_counting(parse(test::bytes_of(halves), options), "f32");
}

TEST(Raw, SkipsWhatStandsBefore) {
  ReadOptions options = raw("f32");
  options.skip_bytes = 7;
  expect_counting(parse("1234567" + test::bytes_of(counting()), options), "f32");
  options.skip_bytes = 6;
  const std::string text = error("1234567" + test::bytes_of(counting()), options);
  EXPECT_TRUE(contains(text, "247") && contains(text, "240") && contains(text, "6")) << text;
  options.skip_bytes = std::numeric_limits<std::size_t>::max();
  error(test::bytes_of(counting()), options);
}

TEST(Raw, NeedsDimensionsAndType) {
  ReadOptions options = raw("f32");
  options.type.reset();
  EXPECT_TRUE(contains(error("", options), "type"));
  options = raw("f32");
  options.dimensions.reset();
  EXPECT_TRUE(contains(error("", options), "dimensions"));
  for (const char* type : {"", "f8", "u128", "int64", "float", "U8", "u8 "}) {
    EXPECT_TRUE(contains(error(std::string(60, '\0'), raw(type)), "there is no type")) << type;
  }
}

TEST(Raw, SizesMustAgreeExactly) {
  const std::string values = test::bytes_of(counting());
  for (const std::string& file : {std::string(), values.substr(1), values + "x"}) {
    const std::string text = error(file, raw("f32"));
    EXPECT_TRUE(contains(text, std::to_string(file.size()) + " bytes")) << text;
    EXPECT_TRUE(contains(text, "240")) << text;
  }
  error(values, raw("f32", {5, 0, 3}));
  error(values, raw("f32", {-5, -4, 3}));
  error(values, raw("f64", {2147483647, 2147483647, 2147483647}));
  // Products that wrap around 64 bits.
  error("", raw("u8", {4194304, 2097152, 2097152}));
  error("", raw("f64", {2097152, 2097152, 524288}));
}

TEST(Raw, OptionsAreChecked) {
  const std::string values = test::bytes_of(counting());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0., -1., nan, inf}) {
    for (int a = 0; a < 3; ++a) {
      ReadOptions options = raw("f32");
      options.spacing = Vec3<double>{1, 1, 1};
      (*options.spacing)[a] = bad;
      const std::string text = error(values, options);
      EXPECT_TRUE(contains(text, "spacing") && contains(text, std::string(1, "xyz"[a]))) << text;
    }
  }
  for (const double bad : {nan, inf, -inf}) {
    ReadOptions options = raw("f32");
    options.origin = Vec3<double>{0, bad, 0};
    EXPECT_TRUE(contains(error(values, options), "origin"));
  }
}

TEST(Raw, NanIsKeptAndInfinityRefused) {
  std::vector<double> values = counting<double>();
  values[59] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(parse(test::bytes_of(values), raw("f64")).statistics().nan, 1u);
  values[0] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(contains(error(test::bytes_of(values), raw("f64")), "infinite"));
}

class GzippedRaw : public test::ScratchFolder {};

TEST_F(GzippedRaw, IsReadAsHeaderless) {
  const std::string values = test::swapped_bytes_of(counting<std::uint16_t>());
  ReadOptions options = raw("u16");
  options.big_endian = true;
  expect_counting(read_volume(write("a.raw.gz", test::gzipped(values)), options), "u16");
  const std::string wide = test::gzipped(test::bytes_of(counting<std::uint64_t>()));
  expect_counting(read_volume(write("w.raw.gz", wide), raw("u64")), "u8");
  options.skip_bytes = 3;
  expect_counting(read_volume(write("b.raw.gz", test::gzipped("abc" + values)), options), "u16");
}

TEST_F(GzippedRaw, SaysWhatIsWrong) {
  const std::string whole = test::gzipped(test::bytes_of(counting<float>()));
  const auto refused = [&](const std::string& bytes, const ReadOptions& options,
                           const std::string& part) {
    const std::string message = error_of([&] { read_volume(write("a.raw.gz", bytes), options); });
    EXPECT_TRUE(contains(message, part)) << message;
  };
  refused(whole, {}, "give its dimensions");
  refused(whole, raw("f32", {5, 4, 2}), "holds more than");
  refused(whole, raw("f32", {5, 4, 4}), "ends too early");
  refused(whole, raw("f64", {1000, 1000, 1000}), "too small");
  refused(whole.substr(0, whole.size() / 2), raw("f32"), "cut off");
  refused("no gzip at all", raw("u8", {2, 2, 2}), "damaged");
}

}  // namespace
}  // namespace pellucid::test_raw
