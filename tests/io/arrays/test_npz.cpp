// SPDX-License-Identifier: Apache-2.0
#include <zlib.h>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/io/internal/parse_arrays.h"
#include "tests/io/described_keys.h"
#include "tests/io/volume_files.h"

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
  options.note = [&](const std::string& line) { note += line + "\n"; };
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

// ------------------------------------------------------------ positions that stand beside it

using Beside = std::vector<std::pair<std::string, std::vector<double>>>;

std::string shape_of(std::size_t count) {
  return count == 1 ? "()" : count == 16 ? "(4, 4)" : "(" + std::to_string(count) + ",)";
}

/// An archive of v of 3 × 4 × 5 values and arrays of doubles beside it.
std::string archive_with(const Beside& beside, const std::string& v = floats()) {
  Zip zip{{{"v.npy", v}}};
  for (const auto& [name, numbers] : beside) {
    zip.entries.push_back(
        {name + ".npy", npy("<f8", shape_of(numbers.size()), test::bytes_of(numbers))});
  }
  return zip.archive();
}

struct Told {
  Volume volume;
  std::vector<std::string> notes;
};
Told telling(const std::string& archive, ReadOptions options = {}) {
  std::vector<std::string> notes;
  options.note = [&](const std::string& note) { notes.push_back(note); };
  if (!options.array) options.array = "v";
  Volume volume = parse(archive, options);
  return {std::move(volume), notes};
}

#define NPZ_KEY(name, key, treatment) \
  PELLUCID_DESCRIBED_KEY(npz_##name, "Archives of NumPy", key, treatment)

NPZ_KEY(affine, "affine", honored) {
  const std::vector<double> affine{2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30, 0, 0, 0, 1};
  const Told told = telling(archive_with({{"affine", affine}}));
  // v[x, y, z], as nibabel has it; the world of RAS is turned to LPS.
  EXPECT_EQ(told.volume.description().dimensions, (std::array<int, 3>{3, 4, 5}));
  EXPECT_EQ(test::value_at(told.volume, 1, 2, 3), 20 * 1 + 5 * 2 + 3);
  test::expect_near(test::world_of(told.volume, 1, 2, 3), {-12, -26, 42});
  expect_told(told.notes, "affine places it, as nibabel does");
  ReadOptions options;
  options.axes = "zyx";
  const Told as_said = telling(archive_with({{"affine", affine}}), options);
  expect_counting(as_said.volume, "f32");
  test::expect_near(test::world_of(as_said.volume, 3, 2, 1), {-12, -26, 42});
  // Turned axes, 3 x 4, and one that is no map.
  std::vector<double> turned{0, 2, 0, 1, 0, 0, 3, 2, 4, 0, 0, 3, 0, 0, 0, 1};
  const Told of_turned = telling(archive_with({{"affine_matrix", turned}}));
  test::expect_near(test::world_of(of_turned.volume, 1, 1, 1), {-3, -5, 7});
  turned[0] = turned[8] = 0;
  const Told flat = telling(archive_with({{"affine", turned}}));
  expect_counting(flat.volume, "f32");
  expect_told(flat.notes, "arrays affine may place or scale it and are not applied");
  // Of an array with a fourth axis, and of the type that numpy gives whole numbers.
  const std::string four = npy("<f4", "(3, 4, 5, 2)", test::bytes_of(std::vector<float>(120, 1)));
  const Told of_four = telling(archive_with({{"affine", affine}}, four), [] {
    ReadOptions first;
    first.component = 0;
    return first;
  }());
  EXPECT_EQ(of_four.volume.description().dimensions, (std::array<int, 3>{3, 4, 5}));
  test::expect_near(test::world_of(of_four.volume, 1, 2, 3), {-12, -26, 42});
  expect_told(of_four.notes, "axes xyzc");
}
NPZ_KEY(spacing, "spacing", honored) {
  for (const char* name : {"spacing", "voxel_size", "voxelSize", "Voxel-Size", "pixdim", "zooms"}) {
    SCOPED_TRACE(name);
    const Told told = telling(archive_with({{name, {2, 3, 2}}}));
    test::expect_near(told.volume.description().placement.spacing, {2, 3, 2});
    expect_told(told.notes, std::string("arrays ") + name + " place it");
  }
  const auto spacing_by = [](const Beside& beside) {
    return telling(archive_with(beside)).volume.description().placement.spacing;
  };
  test::expect_near(spacing_by({{"spacing", {0.5}}}), {0.5, 0.5, 0.5});
  test::expect_near(spacing_by({{"spacing_zyx", {3, 2, 1}}}), {1, 2, 3});
  test::expect_near(spacing_by({{"voxel_size_xyz_um", {3, 2, 1}}}), {3, 2, 1});
  test::expect_near(spacing_by({{"element_size_um", {3, 2, 1}}}), {1, 2, 3});
  test::expect_near(spacing_by({{"dx", {3}}, {"dy", {2}}, {"dz", {4}}}), {3, 2, 4});
  test::expect_near(spacing_by({{"spacing_x", {3}}, {"y_spacing", {2}}}), {3, 2, 1});
}
NPZ_KEY(spacing_of_any_order, "spacing of three that differ", told) {
  const Told told = telling(archive_with({{"spacing", {1, 2, 3}}}));
  test::expect_near(told.volume.description().placement.spacing, {1, 1, 1});
  expect_told(told.notes,
              "spacing (1, 2, 3) does not say whether it begins with x or with z, and is not "
              "applied; give --spacing");
  // Of no use, or of another array as well.
  expect_told(telling(archive_with({{"spacing", {1, -2, 1}}})).notes, "arrays spacing may place");
  expect_told(telling(archive_with({{"spacing", {2, 2}}})).notes, "arrays spacing may place");
  Zip zip{{{"v.npy", floats()},
           {"w.npy", npy("<f4", "(5, 4, 3)", test::bytes_of(counting()))},
           {"spacing.npy", npy("<f8", "()", test::bytes_of(std::vector<double>{2}))},
           {"voxel_size.npy", npy("<U3", "(2,)", std::string(24, '\0'))}}};
  expect_told(telling(zip.archive()).notes, "arrays spacing, voxel_size may place or scale it");
  EXPECT_TRUE(telling(archive_with({{"spacing", {1, 1, 1}}, {"origin", {0, 0, 0}}})).notes.empty());
}
NPZ_KEY(origin, "origin", honored) {
  const Told told = telling(archive_with({{"origin", {5, 6, 5}}, {"spacing", {2}}}));
  test::expect_near(test::world_of(told.volume, 1, 0, 0), {7, 6, 5});
  expect_told(telling(archive_with({{"origin", {5, 6, 7}}})).notes,
              "origin (5, 6, 7) does not say");
  test::expect_near(
      telling(archive_with({{"origin_zyx", {5, 6, 7}}})).volume.description().placement.origin,
      {7, 6, 5});
  test::expect_near(
      telling(archive_with({{"x0", {5}}, {"z0", {7}}})).volume.description().placement.origin,
      {5, 0, 7});
}
NPZ_KEY(coordinates, "x, y, z", honored) {
  const Beside zyx{{"z", {0, 2, 4}}, {"y", {0, 1, 2, 3}}, {"x", {10, 13, 16, 19, 22}}};
  const Told told = telling(archive_with(zyx));
  expect_counting(told.volume, "f32");
  test::expect_near(test::world_of(told.volume, 1, 2, 2), {13, 2, 4});
  expect_told(told.notes, "arrays x, y, z place it; its axes are z, y, x");
  // The lengths tell that it is v[x, y, z].
  const Beside xyz{{"x", {0, 2, 4}}, {"y", {0, 1, 2, 3}}, {"z", {10, 13, 16, 19, 22}}};
  const Told turned = telling(archive_with(xyz));
  EXPECT_EQ(turned.volume.description().dimensions, (std::array<int, 3>{3, 4, 5}));
  test::expect_near(test::world_of(turned.volume, 2, 2, 1), {4, 2, 13});
  // Uneven ones, and those of sides that are alike.
  const Beside uneven{{"depth", {0, 1, 5}}, {"lat", {0, 1, 2, 3}}};
  EXPECT_EQ(telling(archive_with(uneven)).volume.description().coordinates[2],
            (std::vector<double>{0, 1, 5}));
  const std::string cube = npy("<f4", "(2, 2, 2)", test::bytes_of(std::vector<float>(8, 1)));
  const Told open = telling(archive_with({{"x", {0, 2}}, {"z", {0, 3}}}, cube));
  test::expect_near(test::world_of(open.volume, 1, 0, 1), {2, 0, 3});
  expect_told(open.notes, "which the arrays' lengths do not tell");
  // Not in order.
  const Told no_order = telling(archive_with({{"x", {0, 1, 2, 2, 3}}}));
  expect_counting(no_order.volume, "f32");
  expect_told(no_order.notes, "arrays x may place or scale it");
  // Of a length that fits no axis, and of several axes.
  EXPECT_TRUE(telling(archive_with({{"x", {0, 1, 2, 3, 4, 5}}})).notes.empty());
  expect_told(
      telling(archive_with({{"x", {0, 1, 2}}, {"y", {0, 1, 2, 3, 4}}, {"z", {0, 1, 2}}})).notes,
      "arrays x, y, z may place or scale it");
}
NPZ_KEY(wide_coordinates, "X of several axes", told) {
  const Zip zip{{{"v.npy", floats()}, {"X.npy", floats()}}};
  expect_told(telling(zip.archive()).notes, "coordinates X, which change along several axes");
}
NPZ_KEY(other_places, "direction, extent, scale, resolution", told) {
  for (const char* name : {"direction", "extent", "slope", "resolution", "voxel_offset",
                           "image_spacing", "world_transform", "domain_left_edge", "nodata"}) {
    const Told told = telling(archive_with({{name, {1, 2, 3}}}));
    expect_counting(told.volume, "f32");
    expect_told(told.notes, std::string(name) + " may place or scale it and are not applied");
  }
  expect_told(telling(archive_with({{"coords", std::vector<double>(180, 1)}})).notes,
              "arrays coords may place or scale it");
  EXPECT_TRUE(telling(archive_with({{"weights", {1, 2, 3}}, {"seed", {1}}})).notes.empty());
}

}  // namespace
}  // namespace pellucid::test_npz
