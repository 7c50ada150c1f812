// SPDX-License-Identifier: Apache-2.0

// macOS keeps what other file systems cannot hold in files "._NAME" beside NAME (AppleDouble). They
// are no slices, no arrays and no damaged files, whatever reads the folder.

#include <filesystem>
#include <string>
#include <vector>

#include "noting_folder.h"
#include "tests/io/arrays/zarr_files.h"
#include "tests/io/dicom/dicom_files.h"

namespace pellucid::test_apple_double {
namespace {

namespace fs = std::filesystem;
using test::contains;

class AppleDoubleTest : public test::NotingFolder {
 protected:
  /// Puts such a file beside each file of a folder and those within.
  static void double_all(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      files.push_back(entry.path());
    for (const fs::path& file : files) {
      std::ofstream(file.parent_path() / ("._" + file.filename().string()), std::ios::binary)
          << std::string("\0\5\x16\7\0\2\0\0Mac OS X        ", 24);
    }
  }
  fs::path folder_of(const std::string& name) const {
    fs::create_directory(path(name));
    return path(name);
  }
};

TEST_F(AppleDoubleTest, Dicom) {
  const fs::path series = folder_of("series");
  for (int k = 0; k < 3; ++k) {
    test::DicomSliceFile file;
    file.at("10\\20\\" + std::to_string(30 + 12 * k));
    file.pixels = test::page_values<std::uint16_t>(k);
    write("series/IM" + std::to_string(k) + ".dcm", file.bytes());
  }
  double_all(series);
  for (const fs::path& given : {series, series / "IM1.dcm"}) {
    test::expect_counting(components(given).front(), "u16");
    EXPECT_FALSE(is_noted("left out")) << notes();
  }
  // Those alone are no series.
  for (int k = 0; k < 3; ++k) fs::remove(series / ("IM" + std::to_string(k) + ".dcm"));
  EXPECT_TRUE(contains(refused(series), "no DICOM file and no .tif"));
}

TEST_F(AppleDoubleTest, Zarr) {
  test::ZarrStore store;
  fs::create_directories(path("store.zarr"));
  std::ofstream(path("store.zarr/.zgroup")) << "{\"zarr_format\": 2}";
  store.write_2(path("store.zarr/values"), test::bytes_of(test::counting()), 4);
  double_all(path("store.zarr"));
  test::expect_counting(components(path("store.zarr")).front(), "f32");
  EXPECT_FALSE(is_noted("holds")) << notes();
  EXPECT_EQ(list_arrays(path("store.zarr")).size(), 1u);
}

TEST_F(AppleDoubleTest, Stacks) {
  const fs::path stack = folder_of("stack");
  for (int k = 0; k < 3; ++k) {
    write("stack/a" + std::to_string(k) + ".png",
          test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(k)));
  }
  double_all(stack);
  for (const fs::path& given : {stack, stack / "a1.png", stack / "a%d.png"}) {
    test::expect_counting(components(given).front(), "u8");
    EXPECT_FALSE(is_noted("left out")) << notes();
  }
}

}  // namespace
}  // namespace pellucid::test_apple_double
