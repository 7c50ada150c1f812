// SPDX-License-Identifier: Apache-2.0

// Which files of a folder are the slices of a stack, by their names.

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

#include "tests/io/noting_folder.h"

namespace pellucid::test_stack_names {
namespace {

namespace fs = std::filesystem;
using test::contains;

class StackNamesTest : public test::NotingFolder {
 protected:
  /// Writes one page into each file, page k into the k-th.
  void slices(std::initializer_list<const char*> names) {
    int k = 0;
    for (const char* name : names) slice(name, k++);
  }
  void slice(const std::string& name, int k) {
    write(name, test::tiff(test::counting_page<std::uint16_t>(k, 1)));
  }
  void clear() {
    for (const std::string& name : files()) fs::remove(path(name));
  }
};

// S_z%02d_ch%02d.tif: page 10 c + z.
class TwoNumbersTest : public StackNamesTest {
 protected:
  void SetUp() override {
    StackNamesTest::SetUp();
    for (int z = 0; z < 6; ++z) {
      for (int c = 0; c < 2; ++c) {
        slice("S_z0" + std::to_string(z) + "_ch0" + std::to_string(c) + ".tif", 10 * c + z);
      }
    }
  }
};

TEST_F(TwoNumbersTest, PatternsMeanWhatTheySay) {
  EXPECT_EQ(order(path("S_z%02d_ch00.tif")), "0 1 2 3 4 5");
  EXPECT_EQ(order(path("S_z%02d_ch01.tif")), "10 11 12 13 14 15");
  EXPECT_EQ(order(path("S_z03_ch%02d.tif")), "3 13");
  EXPECT_EQ(order(path("S_z0%d_ch01.tif")), "10 11 12 13 14 15");
  EXPECT_TRUE(contains(refused(path("S_z%d_ch00.tif")), "no file has a name"));
  EXPECT_TRUE(contains(refused(path("S_z%02d_ch%02d.tif")), "has 2 numbers that vary"));
}

TEST_F(TwoNumbersTest, SeveralSeriesAskWhich) {
  const std::string text = refused(folder_);
  EXPECT_TRUE(contains(text, "holds 2 series of images")) << text;
  EXPECT_TRUE(contains(text, "S_z%02d_ch00.tif (6 files), S_z%02d_ch01.tif (6 files)")) << text;
  const std::string one = refused(path("S_z03_ch01.tif"));
  EXPECT_TRUE(contains(one, "S_z%02d_ch01.tif (6 files), S_z03_ch%02d.tif (2 files)")) << one;
  slice("mask.tif", 0);
  EXPECT_TRUE(contains(refused(folder_), "holds 3 series of images")) << refused(folder_);
  for (int z = 0; z < 6; ++z) fs::remove(path("S_z0" + std::to_string(z) + "_ch01.tif"));
  EXPECT_EQ(order(path("S_z03_ch00.tif")), "0 1 2 3 4 5");
  EXPECT_TRUE(contains(refused(folder_), "mask.tif (1 file)")) << refused(folder_);
  fs::remove(path("mask.tif"));
  EXPECT_EQ(order(folder_), "0 1 2 3 4 5");  // ch00 does not vary
}

TEST_F(StackNamesTest, NegativeNumbers) {
  slices({"z-2.tif", "z-1.tif", "z0.tif", "z1.tif"});
  for (const fs::path& given : {folder_, path("z-1.tif"), path("z1.tif"), path("z%d.tif")}) {
    EXPECT_EQ(order(given), "0 1 2 3") << given;
  }
  fs::remove(path("z0.tif"));
  EXPECT_TRUE(contains(refused(folder_), "by 2 from z-1.tif to z1.tif"));
  clear();
  slices({"z-010.tif", "z0000.tif", "z0010.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_EQ(order(path("z%04d.tif")), "0 1 2");
  // A hyphen that all have is none.
  clear();
  slices({"a-1.tif", "a-2.tif", "a-3.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_EQ(order(path("a-%d.tif")), "0 1 2");
  EXPECT_EQ(order(path("a%d.tif")), "2 1 0");
  clear();
  slices({"2020-01-05_s01.tif", "2020-01-05_s02.tif"});
  EXPECT_EQ(order(folder_), "0 1");
}

TEST_F(StackNamesTest, Decimals) {
  slices({"z0.0.tif", "z0.5.tif", "z1.0.tif", "z1.5.tif"});
  for (const fs::path& given : {folder_, path("z0.5.tif"), path("z%.1f.tif")}) {
    EXPECT_EQ(order(given), "0 1 2 3") << given;
  }
  EXPECT_TRUE(contains(refused(path("z%d.tif")), "no file has a name"));
  EXPECT_EQ(order(path("z%d.0.tif")), "0 2");
  fs::remove(path("z0.5.tif"));
  EXPECT_TRUE(contains(refused(folder_), "by 1.0 from z0.0.tif to z1.0.tif, but elsewhere by 0.5"));
  clear();
  slices({"z0.tif", "z0.5.tif", "z1.tif", "z1.5.tif"});
  EXPECT_EQ(order(folder_), "0 1 2 3");
  EXPECT_EQ(order(path("z%g.tif")), "0 1 2 3");
  EXPECT_EQ(order(path("z1.tif")), "0 1 2 3");
  clear();
  slices({"z-0.33.tif", "z0.00.tif", "z0.33.tif", "z0.67.tif", "z1.00.tif"});
  EXPECT_EQ(order(folder_), "0 1 2 3 4");
  EXPECT_EQ(order(path("z%.2f.tif")), "0 1 2 3 4");
  clear();
  slices({"z09.50.tif", "z10.00.tif", "z10.50.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_EQ(order(path("z%05.2f.tif")), "0 1 2");
  // A point before a number that counts is none of decimals: 9 is before 10.
  clear();
  slices({"a1.8.tif", "a1.9.tif", "a1.10.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  clear();
  slices({"a1.9.tif", "a1.10.tif", "a2.9.tif", "a2.10.tif"});
  EXPECT_TRUE(contains(refused(folder_), "series of images")) << refused(folder_);
  clear();
  slices({"v1.2_s1.tif", "v1.2_s2.tif"});
  EXPECT_EQ(order(folder_), "0 1");
}

TEST_F(StackNamesTest, DecimalsOfSeveralLengths) {
  slices({"s9.5.tif", "s9.75.tif", "s10.0.tif", "s10.25.tif"});
  EXPECT_EQ(order(folder_), "0 1 2 3");
  EXPECT_EQ(order(path("s10.0.tif")), "0 1 2 3");
  clear();
  // These count from 8 to 11 behind a point.
  slices({"v1.8.tif", "v1.9.tif", "v1.10.tif", "v1.11.tif", "v2.8.tif", "v2.9.tif"});
  EXPECT_TRUE(contains(refused(folder_), "holds 2 series")) << refused(folder_);
}

TEST_F(StackNamesTest, LongNumbers) {
  slices({"t20261128063012345678.tif", "t20261128063012345679.tif", "t20261128063012345680.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_EQ(order(path("t20261128063012345679.tif")), "0 1 2");
  clear();
  slices({"99999999999999999998_1.tif", "99999999999999999998_2.tif"});
  EXPECT_EQ(order(folder_), "0 1");
}

TEST_F(StackNamesTest, PlusSigns) {
  slices({"z-1.tif", "z+0.tif", "z+1.tif", "z+2.tif"});
  EXPECT_EQ(order(folder_), "0 1 2 3");
  EXPECT_EQ(order(path("z%+d.tif")), "0 1 2 3");
  EXPECT_EQ(order(path("z+1.tif")), "0 1 2 3");
  clear();
  slices({"z-05.tif", "z+00.tif", "z+05.tif"});
  EXPECT_EQ(order(path("z%+03d.tif")), "0 1 2");
  clear();
  slices({"a+1.tif", "a+2.tif"});
  EXPECT_EQ(order(path("a+%d.tif")), "0 1");
  EXPECT_EQ(order(folder_), "0 1");
}

TEST_F(StackNamesTest, OneNumberTwice) {
  slices({"s03.tif", "s3.tif", "s4.tif"});
  EXPECT_TRUE(contains(refused(folder_), "s03.tif and s3.tif have the same number"))
      << refused(folder_);
}

TEST_F(StackNamesTest, NumbersThatGoUpTogetherAreOne) {
  slices({"s001_0.0mm.tif", "s002_1.5mm.tif", "s003_3.2mm.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_EQ(order(path("s002_1.5mm.tif")), "0 1 2");
  clear();
  slices({"t0113_z5.tif", "t0207_z6.tif", "t0311_z7.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  clear();
  slices({"a1_ch0.tif", "a2_ch1.tif", "a3_ch0.tif", "a4_ch1.tif"});
  EXPECT_TRUE(contains(refused(folder_), "series of images"));
  clear();
  slices({"a1_b2.tif", "a2_b1.tif"});
  EXPECT_TRUE(contains(refused(folder_), "series of images"));
}

TEST_F(StackNamesTest, ExtensionsInAnyCase) {
  slices({"a1.tif", "a2.TIF", "a3.Tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_EQ(order(path("a2.TIF")), "0 1 2");
  slice("a3.tif", 7);
  EXPECT_TRUE(contains(refused(folder_), "a3.Tif and a3.tif have the same number"));
  clear();
  slices({"a1.tif", "a1.TIF"});
  EXPECT_TRUE(contains(refused(folder_), "2 series of images"));
  clear();
  slices({"a1.tif", "a2.tiff"});
  EXPECT_TRUE(contains(refused(folder_), "2 series of images"));
}

// What macOS keeps beside files on other file systems, and hidden files.
TEST_F(StackNamesTest, AppleDoubleAndHiddenFilesAreNoSlices) {
  slices({"a1.tif", "a2.tif", "a3.tif"});
  for (const char* name : {"._a1.tif", "._a2.tif", "._a3.tif", "._readme.txt", ".DS_Store"}) {
    write(name, std::string("\0\5\x16\7\0\2\0\0Mac OS X", 16));
  }
  write(".a4.tif", "half of a copy");
  for (const fs::path& given : {folder_, path("a1.tif"), path("a%d.tif")}) {
    EXPECT_EQ(order(given), "0 1 2") << given;
    EXPECT_FALSE(is_noted("left out")) << notes();
  }
  write("readme.txt", "");
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_TRUE(is_noted("1 file is no image and left out")) << notes();
  clear();
  slices({"a1.tif"});
  write("._a1.tif", "x");
  ReadOptions cells;
  cells.centering = Centering::cell;
  EXPECT_EQ(order(folder_, cells), "0");
}

TEST_F(StackNamesTest, PercentSignsAreEscaped) {
  slices({"50%_1.tif", "50%_2.tif"});
  EXPECT_EQ(order(path("50%%_%d.tif")), "0 1");
  EXPECT_EQ(order(path("50%_%d.tif")), "0 1");
  EXPECT_EQ(order(folder_), "0 1");
  slice("51%_1.tif", 0);
  slice("51%_2.tif", 0);
  EXPECT_TRUE(contains(refused(folder_), "50%%_%d.tif (2 files), 51%%_%d.tif (2 files)"))
      << refused(folder_);
  clear();
  slices({"%d.tif"});
  ReadOptions cells;
  cells.centering = Centering::cell;
  EXPECT_EQ(order(path("%d.tif"), cells), "0");  // the file of that name
  clear();
  slices({"a  1.tif", "a 10.tif"});
  EXPECT_EQ(order(path("a%3d.tif")), "0 1");
}

TEST_F(StackNamesTest, GapsAndWidths) {
  slices({"a9.tif", "a10.tif", "a11.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  clear();
  slices({"a0999.tif", "a1000.tif", "a1001.tif"});
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_EQ(order(path("a%04d.tif")), "0 1 2");
  clear();
  slices({"a998.tif", "a999.tif", "a1000.tif"});
  EXPECT_EQ(order(path("a%03d.tif")), "0 1 2");
  clear();
  slices({"a10.tif", "a20.tif", "a30.tif", "a50.tif"});
  EXPECT_TRUE(contains(refused(folder_), "by 20 from a30.tif to a50.tif, but elsewhere by 10"));
  clear();
  // More digits than a number has.
  slices({"20200101120000123456789_1.tif", "20200101120000123456789_2.tif"});
  EXPECT_EQ(order(folder_), "0 1");
}

// Files whose descriptions still speak of the file that they were cut out of.
TEST_F(StackNamesTest, NumberedFilesGoBeforeTheirDescriptions) {
  for (int k = 0; k < 3; ++k) {
    write("a" + std::to_string(k) + ".tif",
          test::described_tiff(1, "ImageJ=1.53t\nimages=3\nslices=3\n", {k}));
  }
  EXPECT_EQ(order(folder_), "0 1 2");
  EXPECT_TRUE(is_noted("describe several pages each (ImageJ), but have one")) << notes();
  fs::remove(path("a1.tif"));
  fs::remove(path("a2.tif"));
  EXPECT_TRUE(contains(refused(folder_), "the file has 1 page"));
}

}  // namespace
}  // namespace pellucid::test_stack_names
