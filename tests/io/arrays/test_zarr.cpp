// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#ifdef PELLUCID_HAVE_BLOSC
#include <blosc.h>
#endif
#ifdef PELLUCID_HAVE_BZIP2
#include <bzlib.h>
#endif
#ifdef PELLUCID_HAVE_LZ4
#include <lz4.h>
#endif
#ifdef PELLUCID_HAVE_ZSTD
#include <zstd.h>
#endif

#include "pellucid/io/read_volume.h"
#include "zarr_files.h"

namespace pellucid::test_zarr {
namespace {

namespace fs = std::filesystem;

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::swapped_bytes_of;
using test::value_at;
using test::world_of;
using test::ZarrStore;

std::string little_32(std::uint32_t number) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> (8 * i) & 255U);
  return bytes;
}
std::string little_64(std::uint64_t number) {
  return little_32(static_cast<std::uint32_t>(number)) +
         little_32(static_cast<std::uint32_t>(number >> 32));
}

/// The checksum bit by bit, as its definition has it.
std::uint32_t castagnoli(const std::string& bytes) {
  std::uint32_t remainder = 0xFFFFFFFF;
  for (const char c : bytes) {
    remainder ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) {
      remainder = remainder >> 1 ^ ((remainder & 1U) != 0 ? 0x82F63B78U : 0U);
    }
  }
  return ~remainder;
}

class ZarrTest : public test::ScratchFolder {
 protected:
  fs::path folder(const std::string& name) const {
    fs::create_directories(path(name));
    return path(name);
  }
  void write_text(const std::string& name, const std::string& text) const {
    fs::create_directories(path(name).parent_path());
    write(name, text);
  }
  /// Notes of what is read.
  ReadOptions noting() {
    ReadOptions options;
    options.note = [this](const std::string& line) { notes_ += line + "\n"; };
    return options;
  }
  Volume read_2(const ZarrStore& store, const std::string& values, std::size_t size) {
    fs::remove_all(path("a.zarr"));
    store.write_2(path("a.zarr"), values, size);
    return read_volume(path("a.zarr"), noting());
  }
  Volume read_3(const ZarrStore& store, const std::string& type, const std::string& codecs,
                const std::string& values, std::size_t size, std::vector<int> axes = {}) {
    fs::remove_all(path("a.zarr"));
    ZarrStore slashed = store;
    slashed.separator = "/";
    write_text("a.zarr/zarr.json", slashed.array_3(type, codecs,
                                                   "{\"name\": \"default\", \"configuration\": "
                                                   "{\"separator\": \"/\"}}"));
    slashed.write_chunks(path("a.zarr"), values, size, "c", std::move(axes));
    return read_volume(path("a.zarr"), noting());
  }
  std::string error_2(const ZarrStore& store) {
    return error_of([&] { read_2(store, bytes_of(counting()), 4); });
  }
  std::string error_of_metadata(const std::string& text) {
    fs::remove_all(path("a.zarr"));
    write_text("a.zarr/.zarray", text);
    return error_of([&] { read_volume(path("a.zarr")); });
  }

  std::string notes_;
};

TEST_F(ZarrTest, TypesByteOrdersAndAxes) {
  for (const char* order : {"C", "F"}) {
    for (const char* separator : {".", "/"}) {
      ZarrStore store;
      store.order = order;
      store.separator = separator;
      store.type = "|u1";
      expect_counting(read_2(store, bytes_of(counting<std::uint8_t>()), 1), "u8");
      store.type = "<i2";
      expect_counting(read_2(store, bytes_of(counting<std::int16_t>()), 2), "i16");
      store.type = ">u4";
      expect_counting(read_2(store, swapped_bytes_of(counting<std::uint32_t>()), 4), "u32");
      store.type = ">f8";
      expect_counting(read_2(store, swapped_bytes_of(counting<double>()), 8), "f64");
    }
  }
  EXPECT_EQ(notes_, "");
}

TEST_F(ZarrTest, TypesThatVolumesHaveNot) {
  ZarrStore store;
  store.type = "<f2";
  expect_counting(read_2(store, bytes_of(test::counting_halves()), 2), "f32");
  store.type = "|b1";
  const Volume truth = read_2(store, std::string(60, '\2'), 1);
  EXPECT_EQ(type_name(truth.data()), "u8");
  EXPECT_EQ(value_at(truth, 4, 3, 2), 1);
  store.type = "<i8";
  expect_counting(read_2(store, bytes_of(counting<std::int64_t>()), 8), "u8");
  std::vector<std::int64_t> numbers = counting<std::int64_t>();
  numbers[1] = -300;
  EXPECT_EQ(type_name(read_2(store, bytes_of(numbers), 8).data()), "i16");
  EXPECT_EQ(notes_, "");
  numbers[1] = (std::int64_t{1} << 53) + 1;
  EXPECT_EQ(type_name(read_2(store, bytes_of(numbers), 8).data()), "f64");
  EXPECT_TRUE(contains(notes_,
                       "1 of 60 whole numbers of 64 bits does not fit double and is "
                       "rounded, by at most 1"))
      << notes_;
  store.type = ">u8";
  EXPECT_EQ(value_at(read_2(store, swapped_bytes_of(counting<std::uint64_t>()), 8), 4, 3, 2), 59);
}

TEST_F(ZarrTest, ChunksThatAreInflatedInSlabs) {
  const auto numbers = [](std::size_t count) {
    std::vector<std::uint16_t> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<std::uint16_t>(i * 7919);
    return values;
  };
  ZarrStore store;
  store.type = "<u2";
  store.compressor = "{\"id\": \"zlib\", \"level\": 1}";
  store.encode = [](const std::string& bytes) { return test::deflated(bytes, 15); };
  // 1.2 MB of a chunk; the second one is cut off by the array's end.
  store.shape = {41, 150, 131};
  store.chunk = {30, 150, 131};
  const std::vector<std::uint16_t> values = numbers(std::size_t{41} * 150 * 131);
  for (const char* order : {"C", "F"}) {
    store.order = order;
    const Volume volume = read_2(store, bytes_of(values), 2);
    const auto& read = std::get<DataArray<std::uint16_t>>(volume.data());
    EXPECT_TRUE(std::ranges::equal(read, values)) << order;
  }
  // The end of a chunk is looked for.
  const auto encode = store.encode;
  store.encode = [&](const std::string& bytes) { return encode(bytes + "more"); };
  EXPECT_TRUE(contains(error_of([&] { read_2(store, bytes_of(values), 2); }), "is damaged"));
  store.encode = [&](const std::string& bytes) { return encode(bytes.substr(4)); };
  EXPECT_TRUE(contains(error_of([&] { read_2(store, bytes_of(values), 2); }), "is damaged"));
  // Slabs along an axis of components, two of which are in a chunk.
  store.encode = encode;
  store.order = "C";
  store.shape = {3, 20, 200, 150};
  store.chunk = {2, 20, 200, 150};
  const std::size_t points = std::size_t{20} * 200 * 150;
  const std::vector<std::uint16_t> all = numbers(3 * points);
  fs::remove_all(path("a.zarr"));
  store.write_2(path("a.zarr"), bytes_of(all), 2);
  for (int c = 0; c < 3; ++c) {
    ReadOptions options;
    options.component = c;
    const Volume volume = read_volume(path("a.zarr"), options);
    const auto& read = std::get<DataArray<std::uint16_t>>(volume.data());
    EXPECT_TRUE(std::equal(read.begin(), read.end(), all.begin() + c * std::ptrdiff_t(points)))
        << c;
  }
}

TEST_F(ZarrTest, Compressors) {
  ZarrStore store;
  const std::string values = bytes_of(counting());
  store.compressor = "{\"id\": \"zlib\", \"level\": 1}";
  store.encode = [](const std::string& bytes) { return test::deflated(bytes, 15); };
  expect_counting(read_2(store, values, 4), "f32");
  store.compressor = "{\"id\": \"gzip\", \"level\": 1}";
  store.encode = test::gzipped;
  expect_counting(read_2(store, values, 4), "f32");
#ifdef PELLUCID_HAVE_BZIP2
  store.compressor = "{\"id\": \"bz2\", \"level\": 1}";
  store.encode = [](std::string bytes) {
    std::string out(bytes.size() + 1000, '\0');
    auto size = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()),
                             1, 0, 0);
    out.resize(size);
    return out;
  };
  expect_counting(read_2(store, values, 4), "f32");
#endif
#ifdef PELLUCID_HAVE_ZSTD
  store.compressor = "{\"id\": \"zstd\", \"level\": 1}";
  store.encode = [](const std::string& bytes) {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
    return out;
  };
  expect_counting(read_2(store, values, 4), "f32");
#endif
#ifdef PELLUCID_HAVE_LZ4
  store.compressor = "{\"id\": \"lz4\", \"acceleration\": 1}";
  store.encode = [](const std::string& bytes) {
    std::string out(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(bytes.size()))),
                    '\0');
    out.resize(static_cast<std::size_t>(LZ4_compress_default(
        bytes.data(), out.data(), static_cast<int>(bytes.size()), static_cast<int>(out.size()))));
    return little_32(static_cast<std::uint32_t>(bytes.size())) + out;
  };
  expect_counting(read_2(store, values, 4), "f32");
  const auto lz4 = store.encode;
  store.encode = [&](const std::string& bytes) { return little_32(0x7FFFFFFF) + lz4(bytes); };
  EXPECT_TRUE(contains(error_2(store), "lz4 data is damaged"));
#endif
}

#ifdef PELLUCID_HAVE_BLOSC
std::string blosc(const std::string& bytes, const char* library, int shuffle) {
  std::string out(bytes.size() + BLOSC_MAX_OVERHEAD, '\0');
  const int size = blosc_compress_ctx(5, shuffle, 4, bytes.size(), bytes.data(), out.data(),
                                      out.size(), library, 0, 1);
  EXPECT_GT(size, 0) << library;
  out.resize(static_cast<std::size_t>(std::max(size, 0)));
  return out;
}

TEST_F(ZarrTest, Blosc) {
  ZarrStore store;
  store.compressor = "{\"id\": \"blosc\", \"cname\": \"lz4\", \"clevel\": 5, \"shuffle\": 1}";
  for (const char* library : {"blosclz", "lz4", "lz4hc", "zlib", "zstd"}) {
    for (const int shuffle : {BLOSC_NOSHUFFLE, BLOSC_SHUFFLE, BLOSC_BITSHUFFLE}) {
      store.encode = [&](const std::string& bytes) { return blosc(bytes, library, shuffle); };
      expect_counting(read_2(store, bytes_of(counting()), 4), "f32");
    }
  }
  // A header that says more bytes, or fewer, or is cut off.
  for (const std::uint32_t size : {0U, 44U, 0x7FFFFFF0U, 0xFFFFFFFFU}) {
    store.encode = [&](const std::string& bytes) {
      std::string out = blosc(bytes, "lz4", 1);
      return out.replace(4, 4, little_32(size));
    };
    EXPECT_TRUE(contains(error_2(store), "the chunk's blosc data is damaged")) << size;
  }
  for (const std::size_t length : {0U, 5U, 16U, 20U}) {
    store.encode = [&](const std::string& bytes) {
      return blosc(bytes, "lz4", 1).substr(0, length);
    };
    EXPECT_TRUE(contains(error_2(store), "the chunk's blosc data is damaged")) << length;
  }
}
#endif

TEST_F(ZarrTest, Filters) {
  ZarrStore store;
  store.type = "<i2";
  store.filters = "[{\"id\": \"delta\", \"dtype\": \"<i2\", \"astype\": \"|i1\"}]";
  const auto numbers_of = [](const std::string& bytes) {
    std::vector<std::int16_t> numbers(bytes.size() / 2);
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    return numbers;
  };
  store.encode = [&](const std::string& bytes) {
    std::string out;
    std::int16_t before = 0;
    for (const std::int16_t number : numbers_of(bytes)) {
      out += static_cast<char>(number - before);
      before = number;
    }
    return out;
  };
  expect_counting(read_2(store, bytes_of(counting<std::int16_t>()), 2), "i16");
  // Compressed behind the filter, whose bytes are half as many.
  const auto filtered = store.encode;
  store.compressor = "{\"id\": \"gzip\"}";
  store.encode = [&](const std::string& bytes) { return test::gzipped(filtered(bytes)); };
  expect_counting(read_2(store, bytes_of(counting<std::int16_t>()), 2), "i16");
  store.compressor = "null";
  store.filters = "[{\"id\": \"shuffle\", \"elementsize\": 2}, {\"id\": \"crc32\"}]";
  store.encode = [](const std::string& bytes) {
    std::string low, high;
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
      low += bytes[i];
      high += bytes[i + 1];
    }
    const std::string out = low + high;
    return little_32(static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(out.data()),
                                                      static_cast<uInt>(out.size())))) +
           out;
  };
  expect_counting(read_2(store, bytes_of(counting<std::int16_t>()), 2), "i16");
  const auto right = store.encode;
  store.encode = [&](const std::string& bytes) { return right(bytes).replace(4, 1, "\x55"); };
  EXPECT_TRUE(contains(error_of([&] { read_2(store, bytes_of(counting<std::int16_t>()), 2); }),
                       "checksum (crc32) is wrong"));
  store.type = "<f4";
  store.filters =
      "[{\"id\": \"fixedscaleoffset\", \"dtype\": \"<f4\", \"astype\": \"|u1\", \"scale\": 2, "
      "\"offset\": 1}]";
  store.encode = [](const std::string& bytes) {
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
      float number = 0;
      std::memcpy(&number, &bytes[i], 4);
      out += static_cast<char>(static_cast<unsigned char>((number - 1) * 2 + 2));
    }
    return out;
  };
  // (v - 1) 2 + 2 = 2 v, whose decoding is v + 1; the 0 of places that the array has not, too.
  EXPECT_EQ(value_at(read_2(store, bytes_of(counting()), 4), 4, 3, 2), 60);
  store.filters = "[{\"id\": \"categorize\"}]";
  EXPECT_TRUE(contains(error_2(store), "\"categorize\" is no codec that is read"));
}

TEST_F(ZarrTest, MissingChunksHaveTheFillValue) {
  ZarrStore store;
  store.left_out = {"1.1.2"};  // z 2, y 3, x 4
  const auto last = [&] { return value_at(read_2(store, bytes_of(counting()), 4), 4, 3, 2); };
  store.fill = "7.5";
  EXPECT_EQ(last(), 7.5);
  EXPECT_TRUE(contains(notes_, "1 of 12 chunks are not there; they have the fill value, 7.5"))
      << notes_;
  store.fill = "\"NaN\"";
  EXPECT_TRUE(std::isnan(last()));
  store.fill = "NaN";  // as Python's json writes it
  EXPECT_TRUE(std::isnan(last()));
  store.fill = "null";
  EXPECT_EQ(last(), 0);
  store.fill = "\"Infinity\"";
  EXPECT_TRUE(contains(error_of(last), "infinite"));
  store.type = "<i4";
  store.fill = "-3.0";
  EXPECT_EQ(value_at(read_2(store, bytes_of(counting<std::int32_t>()), 4), 4, 3, 2), -3);
  store.fill = "0.5";
  EXPECT_TRUE(contains(error_of(last), "/fill_value: is no number of the array's type"));
  store.fill = "3000000000";
  EXPECT_TRUE(contains(error_of(last), "/fill_value: is no number of the array's type"));
}

constexpr const char* bytes_codec = "{\"name\": \"bytes\", \"configuration\": {\"endian\": ";

TEST_F(ZarrTest, Version3) {
  ZarrStore store;
  const std::string little = std::string(bytes_codec) + "\"little\"}}";
  expect_counting(read_3(store, "float32", "[" + little + "]", bytes_of(counting()), 4), "f32");
  expect_counting(read_3(store, "uint8", "[\"bytes\"]", bytes_of(counting<std::uint8_t>()), 1),
                  "u8");
  expect_counting(read_3(store, "int16", "[" + std::string(bytes_codec) + "\"big\"}}]",
                         swapped_bytes_of(counting<std::int16_t>()), 2),
                  "i16");
  expect_counting(read_3(store, "int64", "[" + little + "]", bytes_of(counting<std::int64_t>()), 8),
                  "u8");
  store.encode = test::gzipped;
  const std::string gzip = "{\"name\": \"gzip\", \"configuration\": {\"level\": 5}}";
  expect_counting(
      read_3(store, "float32", "[" + little + ", " + gzip + "]", bytes_of(counting()), 4), "f32");
  store.encode = [](const std::string& bytes) { return bytes + little_32(castagnoli(bytes)); };
  const std::string checked = "[" + little + ", {\"name\": \"crc32c\"}]";
  expect_counting(read_3(store, "float32", checked, bytes_of(counting()), 4), "f32");
  store.encode = [](const std::string& bytes) { return bytes + "abcd"; };
  EXPECT_TRUE(contains(
      error_of([&] { read_3(store, "float32", checked, bytes_of(counting()), 4); }), "checksum"));
}

// Stored axis i is axis order[i]: the values that the test stores lie in that order.
TEST_F(ZarrTest, TransposedChunks) {
  const ZarrStore store;
  const std::string little = std::string(bytes_codec) + "\"little\"}}";
  const auto transpose = [](const std::string& order) {
    return "{\"name\": \"transpose\", \"configuration\": {\"order\": " + order + "}}, ";
  };
  expect_counting(read_3(store, "float32", "[" + transpose("[2, 0, 1]") + little + "]",
                         bytes_of(counting()), 4, {2, 0, 1}),
                  "f32");
  // The second permutes what the first made: axes 2, 0, 1 in the order 1, 2, 0 are 0, 1, 2.
  expect_counting(
      read_3(store, "float32", "[" + transpose("[2, 0, 1]") + transpose("[1, 2, 0]") + little + "]",
             bytes_of(counting()), 4),
      "f32");
  expect_counting(
      read_3(store, "float32", "[" + transpose("[2, 0, 1]") + transpose("[0, 2, 1]") + little + "]",
             bytes_of(counting()), 4, {2, 1, 0}),
      "f32");
  EXPECT_TRUE(contains(error_of([&] {
                         read_3(store, "float32", "[" + transpose("[0, 0, 1]") + little + "]",
                                bytes_of(counting()), 4);
                       }),
                       "lists an axis twice"));
}

TEST_F(ZarrTest, KeysAsInVersion2) {
  const ZarrStore store;
  write_text("a.zarr/zarr.json",
             store.array_3("float32",
                           "[{\"name\": \"bytes\", \"configuration\": {\"endian\": "
                           "\"little\"}}]",
                           "{\"name\": \"v2\"}"));
  store.write_chunks(path("a.zarr"), bytes_of(counting()), 4);
  expect_counting(read_volume(path("a.zarr")), "f32");
  expect_counting(read_volume(path("a.zarr/zarr.json")), "f32");
}

/// Shards of 2 × 6 × 4 values with chunks of 2 × 3 × 2, which the first leaves out.
class ZarrShardTest : public ZarrTest {
 protected:
  std::string shard_codec(const std::string& place) const {
    return "{\"name\": \"sharding_indexed\", \"configuration\": {\"chunk_shape\": [2, 3, 2], "
           "\"codecs\": [{\"name\": \"bytes\", \"configuration\": {\"endian\": \"little\"}}, "
           "{\"name\": \"gzip\", \"configuration\": {\"level\": 1}}], \"index_codecs\": "
           "[{\"name\": \"bytes\", \"configuration\": {\"endian\": \"little\"}}, {\"name\": "
           "\"crc32c\"}], \"index_location\": \"" +
           place + "\"}}";
  }
  /// `offset` is added to where the index says that chunks begin.
  void write_shards(bool in_front, bool leave_out, std::uint64_t offset = 0) {
    ZarrStore store;
    store.chunk = {2, 6, 4};
    store.separator = "/";
    store.fill = "-1";
    fs::remove_all(path("a.zarr"));
    write_text("a.zarr/zarr.json",
               store.array_3("float32", "[" + shard_codec(in_front ? "start" : "end") + "]",
                             "{\"name\": \"default\"}"));
    const std::string values = bytes_of(counting());
    for (int k = 0; k < 2; ++k) {
      for (int i = 0; i < 2; ++i) {
        std::string chunks, index;
        const std::size_t index_size = 4 * 16 + 4;
        for (int y = 0; y < 2; ++y) {
          for (int x = 0; x < 2; ++x) {
            if (leave_out && k == 0 && i == 0 && y == 0 && x == 1) {
              index += std::string(16, '\xFF');
              continue;
            }
            const std::string chunk = test::gzipped(ZarrStore::box(
                values, 4, {3, 4, 5}, {2 * k, 3 * y, 4 * i + 2 * x}, {2, 3, 2}, {0, 1, 2}));
            index += little_64(chunks.size() + (in_front ? index_size : 0) + offset) +
                     little_64(chunk.size());
            chunks += chunk;
          }
        }
        index += little_32(castagnoli(index));
        write_text("a.zarr/c/" + std::to_string(k) + "/0/" + std::to_string(i),
                   in_front ? index + chunks : chunks + index);
      }
    }
  }
};

TEST_F(ZarrShardTest, AreReadChunkByChunk) {
  for (const bool in_front : {false, true}) {
    write_shards(in_front, false);
    expect_counting(read_volume(path("a.zarr")), "f32");
    write_shards(in_front, true);
    const Volume volume = read_volume(path("a.zarr"));
    EXPECT_EQ(value_at(volume, 2, 0, 0), -1);
    EXPECT_EQ(value_at(volume, 1, 0, 0), 1);
    EXPECT_EQ(value_at(volume, 4, 3, 2), 59);
  }
}

TEST_F(ZarrShardTest, RefuseAnIndexThatLies) {
  write_shards(false, false, 100000);
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr")); }), "points beyond its end"));
  write_shards(false, false);
  std::string shard = read(path("a.zarr/c/0/0/0"));
  write("a.zarr/c/0/0/0", shard.substr(0, shard.size() - 5));
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr")); }), "checksum of the index"));
  write("a.zarr/c/0/0/0", "short");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr")); }), "shorter than the index"));
}

TEST_F(ZarrTest, FourAxesAreComponents) {
  std::vector<std::uint8_t> values;
  for (int c = 0; c < 2; ++c) {
    for (int i = 0; i < 60; ++i) values.push_back(static_cast<std::uint8_t>(i + 100 * c));
  }
  ZarrStore store;
  store.type = "|u1";
  store.shape = {2, 3, 4, 5};
  store.chunk = {2, 2, 2, 2};
  store.write_2(path("a.zarr"), bytes_of(values), 1);
  ReadOptions options = noting();
  const std::vector<Volume> both = read_components(path("a.zarr"), options);
  ASSERT_EQ(both.size(), 2u);
  expect_counting(both[0], "u8");
  EXPECT_EQ(value_at(both[1], 4, 3, 2), 159);
  EXPECT_TRUE(contains(notes_, "the first is taken for 2 components, axes czyx")) << notes_;
  options.component = 1;
  EXPECT_EQ(value_at(read_volume(path("a.zarr"), options), 0, 0, 0), 100);
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr")); }), "choose a component"));

  std::vector<std::uint8_t> behind;
  for (int i = 0; i < 60; ++i) {
    behind.push_back(static_cast<std::uint8_t>(i));
    behind.push_back(static_cast<std::uint8_t>(i + 100));
  }
  store.shape = {3, 4, 5, 2};
  store.write_2(path("b.zarr"), bytes_of(behind), 1);
  const std::vector<Volume> colors = read_components(path("b.zarr"), noting());
  ASSERT_EQ(colors.size(), 2u);
  expect_counting(colors[0], "u8");
  EXPECT_EQ(value_at(colors[1], 4, 3, 2), 159);
  EXPECT_TRUE(contains(notes_, "the fourth is taken for 2 components, axes zyxc")) << notes_;
}

TEST_F(ZarrTest, WholeNumbersOfComponentsAreOfOneType) {
  std::vector<std::int64_t> numbers(120);
  for (std::size_t i = 0; i < 60; ++i) {
    numbers[i] = static_cast<std::int64_t>(i);
    numbers[i + 60] = static_cast<std::int64_t>(i) * 100 - 10;
  }
  ZarrStore store;
  store.type = "<i8";
  store.shape = {2, 3, 4, 5};
  store.chunk = {1, 2, 4, 3};
  store.write_2(path("a.zarr"), bytes_of(numbers), 8);
  const std::vector<Volume> both = read_components(path("a.zarr"));
  ASSERT_EQ(both.size(), 2u);
  expect_counting(both[0], "i16");
  EXPECT_EQ(type_name(both[1].data()), "i16");
  EXPECT_EQ(value_at(both[1], 0, 0, 0), -10);
  EXPECT_EQ(value_at(both[1], 4, 3, 2), 5890);
}

// The rule is that of NumPy and HDF5: what one of them reads as slices no other reads as channels.
TEST_F(ZarrTest, FourAxesAreGuessedAsElsewhere) {
  const auto guess = [&](const std::vector<int>& shape) {
    fs::remove_all(path("a.zarr"));
    ZarrStore store;
    store.type = "|u1";
    store.shape = store.chunk = shape;
    write_text("a.zarr/.zarray", store.array_2());
    notes_.clear();
    component_count(path("a.zarr"), noting());
    const std::string before = "components, axes ";
    return notes_.substr(notes_.find(before) + before.size(), 4);
  };
  EXPECT_EQ(guess({20, 10, 10, 6}), "zyxc");
  EXPECT_EQ(guess({3, 10, 10, 4}), "zyxc");
  EXPECT_EQ(guess({4, 10, 10, 6}), "czyx");
  EXPECT_EQ(guess({20, 3, 10, 12}), "zcyx");
  EXPECT_EQ(guess({20, 30, 40, 50}), "czyx");
}

TEST_F(ZarrTest, AxesThatAreGiven) {
  ReadOptions options = noting();
  const auto write_store = [&](const std::vector<int>& shape, const std::string& values) {
    fs::remove_all(path("a.zarr"));
    ZarrStore store;
    store.type = "|u1";
    store.shape = shape;
    store.chunk = {2, 3, 2, 2};
    store.chunk.resize(shape.size());
    store.write_2(path("a.zarr"), values, 1);
  };
  // a[x, y, z]
  std::string values, both;
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 4; ++y) {
      for (int z = 0; z < 3; ++z) values += static_cast<char>(x + 5 * (y + 4 * z));
    }
  }
  write_store({5, 4, 3}, values);
  options.axes = "xyz";
  expect_counting(read_volume(path("a.zarr"), options), "u8");
  options.axes = "czyx";
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr"), options); }),
                       "of shape (5, 4, 3) has 3 axes, but the axes \"czyx\" are given"));
  // a[z, c, y, x], which nobody would guess.
  for (int z = 0; z < 3; ++z) {
    for (int c = 0; c < 2; ++c) {
      for (int i = 0; i < 20; ++i) both += static_cast<char>(i + 20 * z + 60 * c);
    }
  }
  write_store({3, 2, 4, 5}, both);
  options.axes = "zcyx";
  const std::vector<Volume> components = read_components(path("a.zarr"), options);
  ASSERT_EQ(components.size(), 2u);
  expect_counting(components[0], "u8");
  EXPECT_EQ(value_at(components[1], 0, 0, 0), 60);
  EXPECT_EQ(value_at(components[1], 4, 3, 2), 119);
  EXPECT_EQ(notes_, "");
  // Names that say nothing of the axes do not stand in the way, others do.
  write_text("a.zarr/.zattrs", "{\"_ARRAY_DIMENSIONS\": [\"i\", \"j\", \"k\", \"l\"]}");
  expect_counting(read_components(path("a.zarr"), options).at(0), "u8");
  write_text("a.zarr/.zattrs", "{\"_ARRAY_DIMENSIONS\": [\"c\", \"z\", \"y\", \"x\"]}");
  EXPECT_TRUE(
      contains(error_of([&] { read_components(path("a.zarr"), options); }), "leave the axes out"));
}

TEST_F(ZarrTest, AxesThatAreGivenCountInListings) {
  write_text("a.zarr/.zgroup", "{\"zarr_format\": 2}");
  ZarrStore store;
  store.write_2(path("a.zarr/a"), bytes_of(counting()), 4);
  ReadOptions options;
  options.axes = "xyz";
  const std::vector<VolumeArray> arrays = list_arrays(path("a.zarr"), options);
  ASSERT_EQ(arrays.size(), 1u);
  EXPECT_EQ(arrays[0].dimensions, (std::vector<int>{3, 4, 5}));
}

// As xarray writes them: names of axes, and arrays of positions beside the values.
TEST_F(ZarrTest, PositionsOfXarray) {
  write_text("a.zarr/.zgroup", "{\"zarr_format\": 2}");
  ZarrStore store;
  store.write_2(path("a.zarr/density"), bytes_of(counting()), 4);
  write_text("a.zarr/density/.zattrs",
             "{\"_ARRAY_DIMENSIONS\": [\"height\", \"lat\", \"lon\"], \"_FillValue\": NaN}");
  const auto line = [&](const std::string& name, const std::vector<double>& positions) {
    ZarrStore axis;
    axis.type = "<f8";
    axis.shape = {static_cast<int>(positions.size())};
    axis.chunk = {2};
    axis.write_2(path("a.zarr/" + name), bytes_of(positions), 8);
  };
  line("lon", {10, 12, 14, 16, 18});
  line("lat", {3, 2, 1, 0});
  line("height", {0, 1, 5});
  const Volume volume = read_volume(path("a.zarr"));
  expect_counting(volume, "f32");
  EXPECT_EQ(volume.description().coordinates[2], (std::vector<double>{0, 1, 5}));
  EXPECT_EQ(volume.description().placement.spacing.x, 2);
  EXPECT_EQ(volume.description().placement.direction.column[1].y, -1);
  const std::vector<VolumeArray> arrays = list_arrays(path("a.zarr"));
  ASSERT_EQ(arrays.size(), 4u);
  EXPECT_EQ(arrays[0].name, "density");
  EXPECT_EQ(arrays[0].components.at(0).maximum, 59);
  EXPECT_TRUE(arrays[0].is_default);
  EXPECT_TRUE(contains(arrays[1].unreadable_reason, "is no volume")) << arrays[1].unreadable_reason;
}

TEST_F(ZarrTest, ArraysOfAGroup) {
  write_text("a.zarr/.zgroup", "{\"zarr_format\": 2}");
  ZarrStore store;
  store.write_2(path("a.zarr/deep/first"), bytes_of(counting()), 4);
  std::vector<float> more = counting();
  for (float& number : more) number += 1;
  store.write_2(path("a.zarr/second"), bytes_of(more), 4);
  expect_counting(read_volume(path("a.zarr"), noting()), "f32");
  EXPECT_TRUE(
      contains(notes_, "holds 2 arrays or images (deep/first, second); read is deep/first"));
  ReadOptions options;
  options.array = "second";
  EXPECT_EQ(value_at(read_volume(path("a.zarr"), options), 0, 0, 0), 1);
  options.array = "/deep/first";
  expect_counting(read_volume(path("a.zarr"), options), "f32");
  EXPECT_EQ(read_named_components(path("a.zarr"), options).array, "deep/first");
  const auto error = [&](const std::string& array) {
    options.array = array;
    return error_of([&] { read_volume(path("a.zarr"), options); });
  };
  EXPECT_TRUE(contains(error("third"), "it has deep/first, second"));
  EXPECT_TRUE(contains(error("../a.zarr/second"), "leaves the folder"));
  EXPECT_TRUE(contains(error("deep/../../x"), "leaves the folder"));
}

TEST_F(ZarrTest, RefusesWhatIsNoStore) {
  folder("a.zarr");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr")); }), "has neither .zarray"));
  write_text("b.zarr/.zgroup", "{\"zarr_format\": 2}");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("b.zarr")); }), "without arrays"));
  write("c.zarr.zip", "PK");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("c.zarr.zip")); }), "unpack it"));
  ZarrStore store;
  store.write_2(path("d.zarr"), bytes_of(counting()), 4);
  ReadOptions options;
  options.level = 1;
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("d.zarr"), options); }), "has no levels"));
  options = {};
  options.time = 1;
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("d.zarr"), options); }), "steps in time"));
  options = {};
  options.level = 1;
  write("e.npy", "");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("e.npy"), options); }), "no levels"));
}

TEST_F(ZarrTest, RefusesMetadataThatLie) {
  const auto with = [](auto change) {
    ZarrStore store;
    change(store);
    return store.array_2();
  };
  const auto error = [&](auto change) { return error_of_metadata(with(change)); };
  EXPECT_TRUE(contains(error([](ZarrStore& s) { s.chunk[0] = 0; }), "/chunks/0: is 0"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) { s.chunk[1] = -4; }), "/chunks/1: is -4"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) { s.chunk = {2, 2}; }), "but the array has 3 axes"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) { s.shape = {3, 0, 5}; }), "the array is empty"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) {
                         s.shape = {4, 5};
                         s.chunk = {1, 1};
                       }),
                       "an array of shape (4, 5) is an image of 2 axes and no volume"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) { s.type = "<c8"; }), "\"<c8\" is not read"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) { s.order = "A"; }), "/order"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) { s.compressor = "{\"id\": \"zfpy\"}"; }),
                       "\"zfpy\" is no codec that is read"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) {
                         s.shape = {2000000000, 2000000000, 2000000000};
                       }),
                       "too large"));
  EXPECT_TRUE(contains(error([](ZarrStore& s) {
                         s.shape = {300, 300, 300};
                         s.chunk = {1, 1, 1};
                       }),
                       "more than 16 million chunks"));
  EXPECT_TRUE(contains(error_of_metadata("{"), "not valid JSON"));
  EXPECT_TRUE(contains(error_of_metadata("[]"), "must be an object"));
  EXPECT_TRUE(contains(error_of_metadata(std::string(100000, '[')), "nested deeper than 64"));
  EXPECT_TRUE(contains(error_of_metadata("{\"zarr_format\": 2}"), "/shape: is missing"));
}

// Chunks larger than the array are allowed, but not larger than the machine.
TEST_F(ZarrTest, HugeChunks) {
  ZarrStore store;
  store.chunk = {2000000, 2000000, 2000000};
  write_text("a.zarr/.zarray", store.array_2());
  write_text("a.zarr/0.0.0", "few");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr")); }), "too large to be read"));
  store.chunk = {20000, 20000, 20000};
  write_text("a.zarr/.zarray", store.array_2());
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.zarr")); }), "of memory"));
}

TEST_F(ZarrTest, ChunksThatAreCutOff) {
  ZarrStore store;
  store.encode = [](const std::string& bytes) { return bytes.substr(1); };
  EXPECT_TRUE(contains(error_2(store), "holds 47 bytes of a chunk"));
  store.encode = [](const std::string& bytes) { return bytes + "x"; };
  EXPECT_TRUE(contains(error_2(store), "holds 49 bytes of a chunk"));
  store.compressor = "{\"id\": \"gzip\"}";
  store.encode = [](const std::string& bytes) { return test::gzipped(bytes).substr(0, 20); };
  EXPECT_TRUE(contains(error_2(store), "ends too early"));
  store.encode = [](const std::string& bytes) { return test::gzipped(bytes + "more"); };
  EXPECT_TRUE(contains(error_2(store), "is damaged"));
  store.encode = [](const std::string&) { return std::string(); };
  EXPECT_TRUE(contains(error_2(store), "a.zarr"));
}

}  // namespace
}  // namespace pellucid::test_zarr
