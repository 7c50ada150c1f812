// SPDX-License-Identifier: Apache-2.0

// Pages of a stack that say other things than its first.

#include <cstdint>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/described_keys.h"
#include "tests/io/image_files.h"

namespace pellucid::test_page_marks {
namespace {

using test::contains;
using test::TiffPage;

std::vector<std::string> notes_of(const std::filesystem::path& file) {
  std::vector<std::string> notes;
  ReadOptions options;
  options.note = [&notes](const std::string& text) { notes.push_back(text); };
  read_components(file, options);
  return notes;
}

class DifferingPages : public test::DescribedKeys {
 protected:
  /// Writes one file of four pages, and changes the last two of them.
  template <class Change>
  std::filesystem::path pages(const Change& change) {
    test::TiffFile file(false);
    for (int k = 0; k < 4; ++k) {
      TiffPage page = test::counting_page<std::uint16_t>(k, 1);
      if (k >= 2) change(page);
      file.add(page);
    }
    return write("pages.tif", file.bytes());
  }
  /// Writes four files, and changes the last two of them.
  template <class Change>
  std::filesystem::path files(const Change& change) {
    for (int k = 0; k < 4; ++k) {
      TiffPage page = test::counting_page<std::uint16_t>(k, 1);
      if (k >= 2) change(page);
      write("f" + std::to_string(k) + ".tif", test::tiff(page));
    }
    return path("f%d.tif");
  }
  template <class Change>
  void expect_told_of_both(const Change& change, const std::string& text) {
    expect_told(notes_of(pages(change)), text + " at page 3 (and 1 other differs)");
    expect_told(notes_of(files(change)), text + " at f2.tif (and 1 other differs)");
  }
  void expect_nothing_differs(const std::filesystem::path& file) {
    for (const std::string& note : notes_of(file)) EXPECT_FALSE(contains(note, "differ")) << note;
  }
};

TEST_F(DifferingPages, Orientation) {
  expect_told_of_both([](TiffPage& page) { page.fields[274] = {4}; },
                      "differ in Orientation: 1 at the first, 4");
}
TEST_F(DifferingPages, Photometric) {
  expect_told_of_both([](TiffPage& page) { page.fields[262] = {0}; },
                      "PhotometricInterpretation: large values bright at the first, small values "
                      "bright");
}
TEST_F(DifferingPages, NoData) {
  expect_told_of_both([](TiffPage& page) { page.texts[42113] = "-9999"; },
                      "GDAL_NODATA: not said at the first, -9999");
}
TEST_F(DifferingPages, Scale) {
  expect_told_of_both(
      [](TiffPage& page) {
        page.texts[42112] = "<GDALMetadata><Item role=\"scale\">0.1</Item></GDALMetadata>";
      },
      "GDAL_METADATA: not said at the first, a scale or an offset");
}
TEST_F(DifferingPages, Resolution) {
  expect_told_of_both(
      [](TiffPage& page) {
        page.rationals = {{282, 20}, {283, 40}};
        page.fields[296] = {3};
      },
      "XResolution and YResolution: not said at the first, 0.5 x 0.25 mm");
}
TEST_F(DifferingPages, AlikePages) {
  const auto nothing = [](TiffPage&) {};
  expect_nothing_differs(pages(nothing));
  expect_nothing_differs(files(nothing));
}

TEST_F(DifferingPages, PngSizes) {
  const auto stack = [&](char last) {
    for (int k = 0; k < 3; ++k) {
      const std::string sizes = std::string("\0\0\x07\xd0\0\0\x0f", 7) + (k == 2 ? last : '\xa0');
      write("p" + std::to_string(k) + ".png",
            test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(k), 0, sizes + '\1'));
    }
    return path("p%d.png");
  };
  expect_told(notes_of(stack('\x00')), "differ in pHYs: 0.5 x 0.25 mm at the first");
  expect_nothing_differs(stack('\xa0'));
}

TEST_F(DifferingPages, ImageJSpacing) {
  const auto stack = [&](const std::string& last) {
    for (int k = 0; k < 3; ++k) {
      write("i" + std::to_string(k) + ".tif",
            test::described_tiff(
                1, "ImageJ=1.53t\nimages=1\nunit=um\n" + (k == 2 ? last : "spacing=2.5\n"), {k}));
    }
    return path("i%d.tif");
  };
  expect_told(notes_of(stack("spacing=5\n")), "2.5 um at the first, 5 um at i2.tif");
  expect_told(notes_of(stack("")), "2.5 um at the first, not said at i2.tif");
  expect_told(notes_of(stack("spacing=2.5\nxorigin=3\n")), "origin at pixel 3, 0, 0 at i2.tif");
  expect_nothing_differs(stack("spacing=2.5\n"));
}

TEST_F(DifferingPages, DescriptionsOfLaterPages) {
  const auto with = [&](const std::string& first, const std::string& last) {
    test::TiffFile file(false);
    for (int k = 0; k < 3; ++k) {
      TiffPage page = test::counting_page<std::uint16_t>(k, 1);
      page.description = k == 0 ? first : k == 2 ? last : "";
      file.add(page);
    }
    return write("d.tif", file.bytes());
  };
  const std::string one = "ImageJ=1.53t\nimages=3\nspacing=1\n";
  const std::string two = "ImageJ=1.53t\nimages=3\nspacing=2\n";
  expect_told(notes_of(with("", two)),
              "ImageDescription: not said at the first, ImageJ, spacing=2 at page 3; the first's");
  expect_told(notes_of(with(one, two)), "ImageJ, spacing=1 at the first, ImageJ, spacing=2");
  expect_told(notes_of(with(one, "{\"shape\": [4, 5]}")), "tifffile at page 3");
  expect_nothing_differs(with(one, one));
  expect_nothing_differs(with(one, "a word"));
  expect_nothing_differs(with("", "a word"));
}

PELLUCID_DESCRIBED_KEY(pages_differ, "Stacks of files", "a key that differs from page to page",
                       told) {
  write("a0.tif", test::tiff(test::counting_page<std::uint16_t>(0, 1)));
  TiffPage page = test::counting_page<std::uint16_t>(1, 1);
  page.fields[274] = {3};
  write("a1.tif", test::tiff(page));
  expect_told(notes_of(folder_), "differ in Orientation");
}

}  // namespace
}  // namespace pellucid::test_page_marks
