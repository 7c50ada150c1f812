// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pellucid/io/internal/parse_arrays.h"
#include "tests/io/volume_files.h"
#include "tests/support/test_data.h"

namespace pellucid::test_slc {
namespace {

namespace fs = std::filesystem;

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;

/// One slice in runs: the first row as it is, each value of the others for itself.
std::string runs(const std::vector<std::uint8_t>& slice) {
  std::string bytes(1, static_cast<char>(0x80 | 5));
  for (std::size_t i = 0; i < 5; ++i) bytes += static_cast<char>(slice[i]);
  for (std::size_t i = 5; i < slice.size(); ++i) {
    bytes += '\1';
    bytes += static_cast<char>(slice[i]);
  }
  return bytes + '\0';
}

std::string header(int compression, const std::string& sides = "5 4 3 8",
                   const std::string& icon = "2 1 X") {
  return "11111\n" + sides + "\n1.5 2 0.25\n1 6 0 " + std::to_string(compression) + "\n" + icon +
         "icon!!";
}

std::string slc(bool compressed) {
  const auto values = counting<std::uint8_t>();
  if (!compressed) return header(0) + test::bytes_of(values);
  std::string file = header(1);
  for (std::ptrdiff_t z = 0; z < 3; ++z) {
    const std::string slice = runs({values.begin() + 20 * z, values.begin() + 20 * (z + 1)});
    file += std::to_string(slice.size()) + " X" + slice;
  }
  return file;
}

Volume parse(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return parse_slc({bytes.begin(), bytes.end()}, "a.slc");
}

std::string error(const std::string& text) {
  const std::string what = error_of([&] { parse(text); });
  EXPECT_TRUE(what.starts_with("a.slc: ")) << what;
  return what;
}

TEST(Slc, PlainAndInRuns) {
  for (const bool compressed : {false, true}) {
    const Volume volume = parse(slc(compressed));
    expect_counting(volume, "u8");
    test::expect_near(test::world_of(volume, 1, 1, 1), {1.5, 2, 0.25}, 0);
  }
  // A run that repeats its value.
  std::string file = header(1, "5 1 2 8");
  file += "3 X" + std::string("\5\7\0", 3) + "3 X" + std::string("\5\11\0", 3);
  EXPECT_TRUE(contains(error(file), "single value along y"));
  ReadOptions options;
  options.centering = Centering::cell;
  const auto bytes = std::as_bytes(std::span(file));
  const Volume volume = parse_slc({bytes.begin(), bytes.end()}, "a.slc", options);
  EXPECT_EQ(test::value_at(volume, 4, 0, 0), 7);
  EXPECT_EQ(test::value_at(volume, 0, 0, 1), 9);
}

TEST(Slc, CutOffAnywhereIsAnError) {
  for (const bool compressed : {false, true}) {
    const std::string file = slc(compressed);
    for (std::size_t length = 0; length < file.size(); ++length) error(file.substr(0, length));
  }
}

TEST(Slc, RefusesWhatCannotBe) {
  EXPECT_TRUE(contains(error("22222\n" + slc(true).substr(6)), "no SLC"));
  EXPECT_TRUE(contains(error(header(0, "5 4 3 16") + std::string(200, '\0')), "16 bits"));
  EXPECT_TRUE(contains(error(header(2)), "compression 2"));
  error(header(1, "2147483647 2147483647 2147483647 8"));
  error(header(0, "-5 4 3 8"));
  error(header(0, "5 4 3 8", "2000000000 2000000000 X"));
  error(header(0, "5 4 3 8", "-1 -1 X"));
  error(header(0, "5 x 3 8"));
  // Runs that are longer or shorter than the slice, and a length that is wrong.
  const std::size_t first = header(1).size();
  const auto replaced = [](std::size_t place, const std::string& by) {
    return slc(true).replace(place, by.size(), by);
  };
  error(replaced(first + 4, "\x7f"));
  error(replaced(first + 4, std::string(1, '\0')));
  error(replaced(first, "36"));
}

TEST(Slc, RealFile) {
  const fs::path file = test_data_folder() / "structured/neghip.slc";
  if (!fs::exists(file)) GTEST_SKIP() << file.string() << " not found";
  const Volume volume = read_volume(file);
  EXPECT_EQ(volume.description().dimensions, (std::array<int, 3>{66, 66, 66}));
  EXPECT_EQ(type_name(volume.data()), "u8");
  EXPECT_EQ(volume.statistics().minimum, 0);
  EXPECT_EQ(volume.statistics().maximum, 255);
}

}  // namespace
}  // namespace pellucid::test_slc
