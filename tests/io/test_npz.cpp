// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "volume_files.h"

namespace pellucid::test_npz {
namespace {

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;

std::string npy(const std::string& descr, const std::string& shape, const std::string& values) {
  const std::string header =
      "{'descr': '" + descr + "', 'fortran_order': False, 'shape': " + shape + ", }\n";
  return std::string("\x93NUMPY\1\0", 8) + static_cast<char>(header.size()) + '\0' + header +
         values;
}

std::string floats() {
  return npy("<f4", "(3, 4, 5)", test::bytes_of(counting()));
}

std::string little(std::uint64_t number, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> (8 * i) & 255);
  return text;
}

/// A zip archive byte by byte, by PKWARE's APPNOTE.
struct Zip {
  struct Entry {
    std::string name, bytes;
    unsigned method = 8, flags = 0;
    bool wrong_checksum = false;
  };
  std::vector<Entry> entries;
  bool zip64 = false;     ///< sizes and places in extra fields, as of archives beyond 4 GiB
  bool streamed = false;  ///< sizes behind the bytes, as of archives written to a pipe
  std::string before = {}, comment = {};

  std::string archive() const {
    std::string all = before, directory;
    for (const Entry& entry : entries) {
      const std::string packed = entry.method == 8 ? test::deflated(entry.bytes, -15) : entry.bytes;
      const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(entry.bytes.data()),
                                  static_cast<uInt>(entry.bytes.size()));
      const unsigned flags = entry.flags | (streamed ? 8U : 0U);
      const std::string sum = little(entry.wrong_checksum ? checksum ^ 1U : checksum, 4);
      const std::string sizes = little(packed.size(), 4) + little(entry.bytes.size(), 4);
      const std::size_t at = all.size() - before.size();
      const std::string kind = little(20, 2) + little(flags, 2) + little(entry.method, 2);
      // numpy.savez has an extra field in each header.
      const std::string extra =
          little(1, 2) + little(16, 2) + little(entry.bytes.size(), 8) + little(packed.size(), 8);
      const std::string none(8, '\xff');
      all += little(0x04034b50, 4) + kind + little(0, 4) + (streamed ? std::string(4, '\0') : sum) +
             (streamed ? std::string(8, '\0') : none) + little(entry.name.size(), 2) +
             little(extra.size(), 2) + entry.name + extra + packed;
      if (streamed) all += little(0x08074b50, 4) + sum + sizes;
      const std::string wide = little(0x7777, 2) + little(3, 2) + "abc" + little(1, 2) +
                               little(24, 2) + little(entry.bytes.size(), 8) +
                               little(packed.size(), 8) + little(at, 8);
      directory += little(0x02014b50, 4) + little(20, 2) + kind + little(0, 4) + sum +
                   (zip64 ? none : sizes) + little(entry.name.size(), 2) +
                   little(zip64 ? wide.size() : 0, 2) + little(1, 2) + little(0, 8) +
                   (zip64 ? std::string(4, '\xff') : little(at, 4)) + entry.name +
                   (zip64 ? wide : "") + "c";
    }
    const std::size_t begin = all.size() - before.size(), size = directory.size();
    all += directory;
    if (zip64) {
      const std::size_t at = all.size();
      all += little(0x06064b50, 4) + little(44, 8) + little(45, 2) + little(45, 2) + little(0, 8) +
             little(entries.size(), 8) + little(entries.size(), 8) + little(size, 8) +
             little(begin, 8);
      all += little(0x07064b50, 4) + little(0, 4) + little(at, 8) + little(1, 4);
    }
    all += little(0x06054b50, 4) + little(0, 4) +
           (zip64 ? std::string(12, '\xff')
                  : little(entries.size(), 2) + little(entries.size(), 2) + little(size, 4) +
                        little(begin, 4)) +
           little(comment.size(), 2) + comment;
    return all;
  }
};

Volume parse(const std::string& file, const ReadOptions& options = {}) {
  const std::span<const std::byte> view = std::as_bytes(std::span(file));
  return parse_npz({view.begin(), view.end()}, "a.npz", options);
}

std::string error(const std::string& file, const ReadOptions& options = {}) {
  return error_of([&] { parse(file, options); });
}

ReadOptions with_array(const std::string& name) {
  ReadOptions options;
  options.array = name;
  return options;
}

TEST(Npz, OneArrayStoredOrDeflatedOfAnyKindOfArchive) {
  for (const unsigned method : {0U, 8U}) {
    for (const bool zip64 : {false, true}) {
      for (const bool streamed : {false, true}) {
        for (const char* before : {"", "#!/bin/sh\n"}) {
          // zip64 has a place from the file's beginning, which nothing may be in front of.
          if (zip64 && *before != '\0') continue;
          const Zip zip{{{"v.npy", floats(), method}},
                        zip64,
                        streamed,
                        before,
                        "a comment with PK\5\6 in it"};
          expect_counting(parse(zip.archive()), "f32");
          expect_counting(parse(zip.archive(), with_array("v")), "f32");
          expect_counting(parse(zip.archive(), with_array("v.npy")), "f32");
        }
      }
    }
  }
}

TEST(Npz, TypesAndAxesAreThoseOfNpy) {
  ReadOptions options;
  options.axes = "xyz";
  const Zip zip{{{"v.npy", npy("<i8", "(5, 4, 3)", test::bytes_of(counting<std::int64_t>()))}}};
  const Volume volume = parse(zip.archive(), options);
  EXPECT_EQ(type_name(volume.data()), "u8");
  EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{5, 4, 3}));
  EXPECT_EQ(test::value_at(volume, 1, 2, 2), 12 + 2 * 3 + 2);
}

TEST(Npz, OfSeveralArraysOneIsChosen) {
  Zip zip{{{"first.npy", npy("|u1", "(3, 4, 5)", test::bytes_of(counting<std::uint8_t>()))},
           {"second.npy", floats()},
           {"spacing.npy", npy("<f8", "(3,)", std::string(24, '\0'))},
           {"words.npy", npy("<U3", "(2,)", std::string(24, '\0'))},
           {"readme.txt", "hello"}}};
  expect_counting(parse(zip.archive(), with_array("first")), "u8");
  expect_counting(parse(zip.archive(), with_array("second")), "f32");
  const std::string several = error(zip.archive());
  EXPECT_TRUE(contains(several, "first (3, 4, 5), second (3, 4, 5), spacing (3), words (not read)"))
      << several;
  EXPECT_TRUE(contains(error(zip.archive(), with_array("third")), "has no array \"third\""));
  EXPECT_TRUE(contains(error(zip.archive(), with_array("spacing")), "3 axes"));
  EXPECT_TRUE(contains(error(zip.archive(), with_array("words")), "is not read: text"));
  // One volume beside others that are none.
  zip.entries.erase(zip.entries.begin());
  std::string note;
  ReadOptions options;
  options.note = [&](const std::string& line) { note = line; };
  expect_counting(parse(zip.archive(), options), "f32");
  EXPECT_TRUE(contains(note, "second is taken")) << note;
  zip.entries.erase(zip.entries.begin());
  EXPECT_TRUE(contains(error(zip.archive()), "no array of three or four axes"));
}

class NpzFiles : public test::ScratchFolder {};

TEST_F(NpzFiles, ListsItsArrays) {
  const Zip zip{{{"a.npy", npy("<i8", "(3, 4, 5)", test::bytes_of(counting<std::int64_t>()))},
                 {"flat.npy", npy("<f8", "(3,)", std::string(24, '\0'))},
                 {"group/b.npy", floats()}}};
  const auto file = write("a.npz", zip.archive());
  const std::vector<VolumeArray> arrays = list_arrays(file);
  ASSERT_EQ(arrays.size(), 3u);
  EXPECT_EQ(arrays[0].name, "a");
  EXPECT_EQ(arrays[0].type, "u8");
  EXPECT_TRUE(arrays[0].is_default);
  EXPECT_EQ(arrays[0].components.front().maximum, 59);
  EXPECT_TRUE(contains(arrays[1].unreadable_reason, "3 axes"));
  EXPECT_EQ(arrays[2].name, "group/b");
  EXPECT_EQ(arrays[2].dimensions, (std::vector<int>{5, 4, 3}));
  EXPECT_FALSE(arrays[2].is_default);
  expect_counting(read_volume(file, with_array("group/b")), "f32");
}

TEST(Npz, DamageIsNamed) {
  EXPECT_TRUE(contains(error(""), "zip archive"));
  EXPECT_TRUE(contains(error(std::string(1000, 'x')), "zip archive"));
  EXPECT_TRUE(contains(error(Zip{}.archive()), "no array"));
  for (const unsigned method : {0U, 8U}) {
    Zip zip{{{"v.npy", floats(), method}}};
    zip.entries[0].wrong_checksum = true;
    EXPECT_TRUE(contains(error(zip.archive()), "checksum"));
  }
  Zip zip{{{"v.npy", floats(), 14}}};
  EXPECT_TRUE(contains(error(zip.archive()), "method 14"));
  zip.entries[0].method = 0;
  zip.entries[0].flags = 1;
  EXPECT_TRUE(contains(error(zip.archive()), "encrypted"));
  zip.entries[0].flags = 0;
  zip.entries[0].bytes.pop_back();
  EXPECT_TRUE(contains(error(zip.archive()), "cut off"));
}

// Every byte that is cut off or changed: an Error, or the values, which checksums protect.
TEST(Npz, DamagedArchivesAreReadOrRefused) {
  for (const bool zip64 : {false, true}) {
    for (const unsigned method : {0U, 8U}) {
      Zip zip{{{"v.npy", floats(), method}}};
      zip.zip64 = zip64;
      const std::string whole = zip.archive();
      for (std::size_t length = 0; length < whole.size(); ++length) error(whole.substr(0, length));
      for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const unsigned change : {1U, 0x80U, 0xffU}) {
          std::string damaged = whole;
          damaged[i] = static_cast<char>(static_cast<unsigned char>(damaged[i]) ^ change);
          try {
            const Volume volume = parse(damaged);
            EXPECT_EQ(volume.statistics().maximum, 59) << i;
          } catch (const Error& e) {
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
          }
        }
      }
    }
  }
}

TEST(Npz, SizesThatAreClaimedAreNotReserved) {
  Zip zip{{{"v.npy", npy("<f4", "(100000, 100000, 100000)", "")}}};
  EXPECT_TRUE(contains(error(zip.archive()), "bytes of values"));
}

}  // namespace
}  // namespace pellucid::test_npz
