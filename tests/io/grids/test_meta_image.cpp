// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

#ifdef PELLUCID_HAVE_ITK

namespace pellucid::test_meta_image {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::world_of;

struct MetaImageFile {
  std::string type = "MET_FLOAT", dimensions = "5 4 3", spacing = "1 2 3", offset = "10 20 30";
  std::string matrix = "1 0 0 0 1 0 0 0 1", data_file = "LOCAL", more;
  std::string axes = "3", msb = "False";

  std::string header() const {
    return "ObjectType = Image\nNDims = " + axes +
           "\nBinaryData = True\nBinaryDataByteOrderMSB = " + msb + "\n" + more +
           "TransformMatrix = " + matrix + "\nOffset = " + offset +
           "\nElementSpacing = " + spacing + "\nDimSize = " + dimensions +
           "\nElementType = " + type + "\nElementDataFile = " + data_file + "\n";
  }
  MetaImageFile compressed(std::size_t size) const {
    MetaImageFile file = *this;
    file.more += "CompressedData = True\nCompressedDataSize = " + std::to_string(size) + "\n";
    return file;
  }
};

std::string zlib(const std::string& bytes) {
  return test::deflated(bytes, 15);
}

class MetaImageTest : public test::ScratchFolder {
 protected:
  Volume parse(const MetaImageFile& file, const std::string& values = bytes_of(counting())) {
    return read_volume(write("a.mha", file.header() + values));
  }
  std::string error(const MetaImageFile& file, const std::string& values = bytes_of(counting())) {
    return error_of([&] { parse(file, values); });
  }
  template <class Value>
  void expect_type(const std::string& name, const std::string& type) {
    SCOPED_TRACE(type);
    MetaImageFile file;
    file.type = name;
    const std::string values = bytes_of(counting<Value>()), packed = zlib(values);
    expect_counting(parse(file, values), type);
    expect_counting(parse(file.compressed(packed.size()), packed), type);
    file.msb = "True";
    expect_counting(parse(file, test::swapped_bytes_of(counting<Value>())), type);
  }
};

TEST_F(MetaImageTest, AllTypesInBothByteOrdersRawAndCompressed) {
  expect_type<std::uint8_t>("MET_UCHAR", "u8");
  expect_type<std::int8_t>("MET_CHAR", "i8");
  expect_type<std::uint16_t>("MET_USHORT", "u16");
  expect_type<std::int16_t>("MET_SHORT", "i16");
  expect_type<std::uint32_t>("MET_UINT", "u32");
  expect_type<std::int32_t>("MET_INT", "i32");
  expect_type<float>("MET_FLOAT", "f32");
  expect_type<double>("MET_DOUBLE", "f64");
  expect_type<std::int64_t>("MET_LONG_LONG", "u8");
  expect_type<std::uint64_t>("MET_ULONG_LONG", "u8");
  expect_type<std::int32_t>("MET_LONG", "i32");
  MetaImageFile file;
  file.type = "MET_NONSENSE";
  error(file);
}

// MetaImage is LPS already. The rows of TransformMatrix are the directions of the axes.
TEST_F(MetaImageTest, StandsAsItLies) {
  MetaImageFile file;
  expect_near(world_of(parse(file), 4, 3, 2), {14, 26, 36});
  file.matrix = "0 1 0 -1 0 0 0 0 1";
  expect_near(world_of(parse(file), 4, 0, 0), {10, 24, 30});
  expect_near(world_of(parse(file), 0, 3, 0), {4, 20, 30});
  file.matrix = "0.8 0.6 0 -0.6 0.8 0 0 0 -1";
  expect_near(world_of(parse(file), 4, 3, 2),
              {10 + 4 * 0.8 - 6 * 0.6, 20 + 4 * 0.6 + 6 * 0.8, 30 - 6});
}

TEST_F(MetaImageTest, Detached) {
  const std::string values = bytes_of(counting()), packed = zlib(values);
  MetaImageFile file;
  write("v.raw", values);
  file.data_file = "v.raw";
  expect_counting(read_volume(write("a.mhd", file.header())), "f32");
  write("v.zraw", packed);
  file.data_file = "v.zraw";
  expect_counting(read_volume(write("z.mhd", file.compressed(packed.size()).header())), "f32");
  write("s.raw", "1234567" + values);
  file.data_file = "s.raw";
  file.more = "HeaderSize = 7\n";
  expect_counting(read_volume(write("s.mhd", file.header())), "f32");
  file.more = "HeaderSize = -1\n";
  expect_counting(read_volume(write("t.mhd", file.header())), "f32");
}

TEST_F(MetaImageTest, AFileForEachSlice) {
  MetaImageFile file;
  for (int k = 0; k < 3; ++k) {
    write("slice0" + std::to_string(2 * k + 1) + ".raw",
          bytes_of(counting()).substr(static_cast<std::size_t>(80 * k), 80));
  }
  file.data_file = "slice%02d.raw 1 5 2";
  expect_counting(read_volume(write("p.mhd", file.header())), "f32");
  file.data_file = "LIST";
  expect_counting(
      read_volume(write("l.mhd", file.header() + "slice01.raw\nslice03.raw\nslice05.raw\n")),
      "f32");
  write("m.mhd", file.header() + "slice01.raw\nnone.raw\nslice05.raw\n");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("m.mhd")); }), "none.raw: no such file"));
  write("n.mhd", file.header() + "slice01.raw\nslice03.raw\n");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("n.mhd")); }), "2 files"));
  for (const char* pattern : {"slice%02d.raw 1 5 1", "slice%02d.raw 1 9 2", "slice%s.raw 1 3 1",
                              "slice%d%d.raw 1 3 1", "slice%999999d.raw 1 3 1",
                              "slice%02d.raw 1 5 0", "slice%02d.raw 5 1 2", "%", "slice.raw %d"}) {
    file.data_file = pattern;
    write("b.mhd", file.header());
    error_of([&] { read_volume(path("b.mhd")); });
  }
}

// Files whose CompressedDataSize is out of date are about; the data says where it ends.
TEST_F(MetaImageTest, CompressedDataSizeIsNotTrusted) {
  const std::string packed = zlib(bytes_of(counting()));
  for (const std::size_t size :
       {packed.size() - 9, packed.size() + 1000, std::size_t{0}, std::size_t{99999999999999}}) {
    expect_counting(parse(MetaImageFile{}.compressed(size), packed), "f32");
  }
  MetaImageFile none;
  none.more = "CompressedData = True\n";
  expect_counting(parse(none, packed), "f32");
}

TEST_F(MetaImageTest, EveryTruncationIsAnError) {
  const std::string values = bytes_of(counting()), packed = zlib(values);
  const std::string raw = MetaImageFile{}.header() + values;
  const std::string compressed = MetaImageFile{}.compressed(packed.size()).header() + packed;
  for (const std::string& whole : {raw, compressed}) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      write("cut.mha", whole.substr(0, length));
      error_of([&] { read_volume(path("cut.mha")); });
    }
  }
  std::string damaged = packed;
  damaged.back() = static_cast<char>(damaged.back() ^ 1);
  EXPECT_TRUE(contains(error(MetaImageFile{}.compressed(packed.size()), damaged), "damaged"));
}

TEST_F(MetaImageTest, BadHeadersAreRefused) {
  const auto with = [](auto change) {
    MetaImageFile file;
    change(file);
    return file;
  };
  EXPECT_TRUE(contains(error(with([](auto& f) { f.spacing = "1 0 3"; })), "spacing"));
  EXPECT_TRUE(contains(error(with([](auto& f) { f.spacing = "1 -2 3"; })), "spacing"));
  EXPECT_TRUE(contains(error(with([](auto& f) { f.spacing = "1 nan 3"; })), "finite"));
  EXPECT_TRUE(contains(error(with([](auto& f) { f.offset = "1 inf 3"; })), "finite"));
  EXPECT_TRUE(contains(error(with([](auto& f) { f.matrix = "1 0 0 0 -inf 0 0 0 1"; })), "finite"));
  EXPECT_TRUE(contains(error(with([](auto& f) { f.matrix = "1 0 0 1 0 0 0 0 1"; })), "singular"));
  EXPECT_TRUE(contains(error(with([](auto& f) { f.dimensions = "5 0 3"; })), "5 x 0 x 3"));
  EXPECT_TRUE(contains(error(with([](auto& f) { f.dimensions = "5 -4 3"; })), "5 x -4 x 3"));
  error(with([](auto& f) { f.dimensions = "5 4"; }));
  error(with([](auto& f) { f.dimensions = "4294967301 4 3"; }));
  EXPECT_TRUE(
      contains(error(with([](auto& f) { f.dimensions = "100000 100000 100000"; })), "cut off"));
  EXPECT_TRUE(contains(error(with([](auto& f) {
                         f = f.compressed(9);
                         f.dimensions = "100000 100000 100000";
                       })),
                       "memory"));
  error(with([](auto& f) { f.axes = "2"; }));
  error(with([](auto& f) { f.axes = "0"; }));
  error(with([](auto& f) { f.axes = "11"; }));
  EXPECT_TRUE(contains(error(with([](auto& f) { f.more = "ElementNumberOfChannels = 3\n"; })),
                       "3 components"));
  error(with([](auto& f) { f.data_file = "none.raw"; }));
  error(with([](auto& f) { f.data_file = ""; }));
  write("x.mha", "");
  error_of([&] { read_volume(path("x.mha")); });
  write("x.mha", std::string(300, 'x'));
  error_of([&] { read_volume(path("x.mha")); });
}

TEST_F(MetaImageTest, ValuesAsTextAreRefused) {
  std::string header = MetaImageFile{}.header();
  header.replace(header.find("BinaryData = True"), 17, "BinaryData = False");
  write("a.mha", header + "1 2 3");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.mha")); }), "text"));
}

TEST_F(MetaImageTest, NanIsKeptAndInfinityRefused) {
  std::vector<float> values = counting();
  values[31] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(parse({}, bytes_of(values)).statistics().nan, 1u);
  values[31] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(contains(error({}, bytes_of(values)), "infinite"));
}

TEST_F(MetaImageTest, NothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  MetaImageFile file;
  parse(file);
  error(file, "short");
  file.dimensions = "5";
  error(file);
  file.dimensions = "nonsense";
  error(file);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// MetaIO goes on reading numbers, 2^32 - 3 of them.
TEST_F(MetaImageTest, FewerAxesThanNoneAreRefused) {
  write("a.mha", "ObjectType = Image\nNDims =-3\nDimSize = 5 4 3\nOffset = 1 2 3\n");
  EXPECT_TRUE(test::contains(test::error_of([&] { read_volume(path("a.mha")); }), "below 0"));
}

TEST_F(MetaImageTest, BytesThatAreLeftOverAreTold) {
  std::string notes;
  ReadOptions options;
  options.note = [&](const std::string& line) { notes += line + "\n"; };
  MetaImageFile file;
  file.data_file = "v.raw";
  write("v.raw", std::string(100, 'h') + bytes_of(counting()));
  read_volume(write("a.mhd", file.header()), options);
  EXPECT_TRUE(contains(notes, "100 bytes more") && contains(notes, "HeaderSize = -1")) << notes;
  notes.clear();
  file.more = "HeaderSize = -1\n";
  expect_counting(read_volume(write("a.mhd", file.header()), options), "f32");
  EXPECT_EQ(notes, "");
  file.more = "HeaderSize = -2\n";
  write("a.mhd", file.header());
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.mhd")); }), "HeaderSize = -2"));
}

}  // namespace
}  // namespace pellucid::test_meta_image

#endif
