// SPDX-License-Identifier: Apache-2.0

// Descriptions of ImageJ, SCIFIO, tifffile, ScanImage, LSM and Micro-Manager. The texts are what
// these programs write; the expected orders follow their documents.

#include <bit>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/io/noting_folder.h"

namespace pellucid::test_described_tiff {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::described_tiff;
using test::expect_near;
using test::value_at;

class DescribedTiffTest : public test::NotingFolder {
 protected:
  fs::path described(int pages, const std::string& description) {
    return write("d.tif", described_tiff(pages, description));
  }
  /// Pages of which the first has other tags.
  template <class Change>
  fs::path changed(int pages, const Change& change) {
    test::TiffFile file(false);
    for (int k = 0; k < pages; ++k) {
      test::TiffPage page = test::counting_page<std::uint16_t>(k, 1);
      change(page, k);
      file.add(page);
    }
    return write("c.tif", file.bytes());
  }
};

TEST_F(DescribedTiffTest, HyperstacksOfImageJ) {
  const auto with = [&](int pages, const std::string& text) {
    return described(pages, "ImageJ=1.53t\n" + text);
  };
  EXPECT_EQ(order(with(12, "images=12\nchannels=2\nslices=3\nframes=2\nhyperstack=true\n")),
            "0 2 4, 1 3 5, 6 8 10, 7 9 11");
  EXPECT_TRUE(is_noted("2 times of 2 channels, which are its components")) << notes();
  EXPECT_EQ(order(with(6, "images=6\nchannels=2\nslices=3\n")), "0 2 4, 1 3 5");
  EXPECT_EQ(order(with(6, "images=6\nslices=2\nframes=3\r\n")), "0 1, 2 3, 4 5");
  EXPECT_EQ(order(with(3, "images=3\nslices=3\n")), "0 1 2");
  EXPECT_EQ(order(with(3, "unit=um\n")), "0 1 2");
  ReadOptions options;
  options.time = 1.1;
  EXPECT_EQ(order(with(6, "images=6\nslices=2\nframes=3\nfinterval=0.5\n"), options), "4 5");
  EXPECT_EQ(order(with(6, "images=6\nslices=2\nframes=3\nfps=2\n"), options), "4 5");
  EXPECT_EQ(order(with(6, "images=6\nslices=2\nframes=3\n"), options), "2 3");
  // A movie has no slices.
  options = {};
  options.component = 2;
  EXPECT_TRUE(contains(refused(with(3, "images=3\nframes=3\n"), options), "is a movie, 3 times"));

  EXPECT_TRUE(contains(refused(with(4, "images=6\nslices=6\n")), "says 6 slices"));
  EXPECT_TRUE(contains(refused(with(8, "images=6\nslices=6\n")), "the file has 8 pages"));
  EXPECT_TRUE(contains(refused(with(6, "images=6\nslices=3\n")), "make 3"));
  EXPECT_TRUE(contains(refused(with(6, "images=6\nchannels=2\nslices=2\n")), "make 4"));
  EXPECT_TRUE(contains(refused(with(6, "images=6\nslices=0\n")), "slices=0"));
  EXPECT_TRUE(contains(refused(with(6, "slices=2000000000\nframes=2000000000\n")), "mend the"));
  EXPECT_TRUE(contains(refused(with(1, "images=6\nslices=6\n")), "the file has 1 page"));
  components(with(3, "images=3\nslices=3\nloop=false\nmagic=7\n"));
  EXPECT_TRUE(is_noted("lines that are not read: magic")) << notes();
}

// Above 4 GB, ImageJ writes one directory, and all planes behind each other.
TEST_F(DescribedTiffTest, PlanesThatShareOnePage) {
  for (const bool big_endian : {false, true}) {
    for (const bool several_strips : {false, true}) {
      test::TiffFile file(big_endian);
      test::TiffPage page = test::counting_page<std::uint16_t>(0, 1, big_endian);
      page.description = "ImageJ=1.53t\nimages=6\nchannels=2\nslices=3\n";
      // The file's only strip is followed by those that no directory names.
      std::string all;
      for (int k = 0; k < 6; ++k) all += test::page_values<std::uint16_t>(k, big_endian);
      if (several_strips) {
        page.fields[278] = {2};
        page.strips = {all.substr(0, 20), all.substr(20)};
      } else {
        page.strips = {all};
      }
      file.add(page);
      EXPECT_EQ(order(write("big.tif", file.bytes())), "0 2 4, 1 3 5");
      ReadOptions options;
      options.component = 1;
      EXPECT_EQ(order(path("big.tif"), options), "1 3 5");
      EXPECT_EQ(order(folder_), "0 2 4, 1 3 5");
      page.strips.back().resize(page.strips.back().size() - 120);
      test::TiffFile cut(big_endian);
      cut.add(page);
      std::string bytes = cut.bytes();
      EXPECT_TRUE(contains(refused(write("big.tif", bytes.substr(0, bytes.size()))), "1 page"));
      page.fields[259] = {8};
      page.strips = {test::deflated(all, 15)};
      page.fields[278] = {4};
      test::TiffFile packed(big_endian);
      packed.add(page);
      EXPECT_TRUE(contains(refused(write("big.tif", packed.bytes())), "1 page"));
    }
  }
}

TEST_F(DescribedTiffTest, CalibrationOfImageJ) {
  const auto with = [&](const std::string& text, auto change) {
    return components(changed(3,
                              [&](test::TiffPage& page, int k) {
                                change(page, k);
                                if (k == 0)
                                  page.description = "ImageJ=1.53t\nimages=3\nslices=3\n" + text;
                              }))
        .front();
  };
  const auto same = [](test::TiffPage&, int) {};
  const auto shifted = [](test::TiffPage& page, int k) {
    std::vector<std::uint16_t> values(20);
    for (int i = 0; i < 20; ++i) {
      values[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(32768 + 20 * k + i);
    }
    page.strips = {test::bytes_of(values)};
  };
  test::expect_counting(with("cf=0\nc0=-32768.0\nc1=1.0\nvunit=HU\n", shifted), "i16");
  EXPECT_TRUE(is_noted("calibrated by ImageJ's line, -32768.0 + 1.0 times the stored one, in HU"))
      << notes();
  const Volume half = with("cf=0\nc0=-1.5\nc1=0.5\n", same);
  EXPECT_EQ(type_name(half.data()), "f32");
  EXPECT_EQ(value_at(half, 4, 3, 2), -1.5 + 0.5 * 59);
  const Volume moved = with("cf=0\nc0=100000\nc1=1\n", same);
  EXPECT_EQ(type_name(moved.data()), "u32");
  EXPECT_EQ(value_at(moved, 4, 3, 2), 100059);
  test::expect_counting(with("cf=0\nc0=0\nc1=1\nvunit=gray\n", same), "u16");
  EXPECT_TRUE(is_noted("values are in gray")) << notes();
  for (const char* function : {"1", "4", "8", "21", "22"}) {
    test::expect_counting(with(std::string("cf=") + function + "\nc0=1\nc1=2\nc2=3\n", same),
                          "u16");
    EXPECT_TRUE(is_noted(std::string("cf=") + function)) << notes();
  }
  test::expect_counting(with("cf=20\n", same), "u16");
  EXPECT_FALSE(is_noted("cf="));
  test::expect_counting(with("cf=0\nc0=x\n", same), "u16");
  EXPECT_TRUE(is_noted("not usable")) << notes();
  // ImageJ shifts signed values before it calibrates them.
  const auto is_signed = [](test::TiffPage& page, int) { page.fields[339] = {2}; };
  test::expect_counting(with("cf=0\nc0=-32768\nc1=1\n", is_signed), "i16");
  // Samples of colors and slices of numbered files are calibrated, too.
  const auto colors = [](test::TiffPage& page, int k) {
    page.fields[258] = {8, 8};
    page.fields[277] = {2};
    page.strips = {std::string(40, static_cast<char>(k))};
  };
  with("cf=0\nc0=1000\nc1=1\n", colors);
  const std::vector<Volume> two = components(path("c.tif"));
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(value_at(two[1], 0, 0, 2), 1002);
  EXPECT_EQ(type_name(two[1].data()), "u16");
}

TEST_F(DescribedTiffTest, CalibrationsOfNumberedFiles) {
  const auto one = [&](int k, const std::string& text) {
    write("s" + std::to_string(k) + ".tif", described_tiff(1, "ImageJ=1.53t\n" + text, {k}));
  };
  for (const int k : {0, 1, 2}) one(k, "cf=0\nc0=-1\nc1=1\n");
  EXPECT_EQ(value_at(components(folder_).front(), 0, 0, 1), 19);
  one(1, "cf=0\nc0=-2\nc1=1\n");
  EXPECT_TRUE(contains(refused(folder_), "s1.tif have another calibration"));
  one(1, "");
  EXPECT_TRUE(contains(refused(folder_), "s1.tif have another calibration"));
}

TEST_F(DescribedTiffTest, UnitsOfImageJ) {
  const auto with = [&](const std::string& text, double x = 4, double y = 2) {
    return spacing(changed(3, [&](test::TiffPage& page, int k) {
      page.rationals = {{282, x}, {283, y}};
      if (k == 0) page.description = "ImageJ=1.53t\nimages=3\nslices=3\n" + text;
    }));
  };
  expect_near(with("unit=\\u00B5m\nspacing=3\n"), {0.25, 0.5, 3});
  EXPECT_TRUE(is_noted("is the file's, in \u00b5m")) << notes();
  expect_near(with("unit=\xb5m\nspacing=3\n"), {0.25, 0.5, 3});  // Latin-1
  EXPECT_TRUE(is_noted("is the file's, in \u00b5m")) << notes();
  expect_near(with("unit=micron\nzunit=mm\nspacing=0.003\n"), {0.25, 0.5, 3});
  EXPECT_TRUE(is_noted("lengths are turned into micron")) << notes();
  expect_near(with("unit=um\nyunit=nm\nzunit=pixel\nspacing=3\n"), {0.25, 0.5, 3});
  EXPECT_TRUE(is_noted("which cannot be turned into one")) << notes();
  expect_near(with("unit=mm\nyunit=cm\nspacing=-3\n"), {0.25, 5, 3});
  expect_near(with("unit=um\nyunit=microns\nzunit=\\u00B5m\nspacing=3\n"), {0.25, 0.5, 3});
  EXPECT_FALSE(is_noted("turned")) << notes();
  expect_near(with("spacing=3\n"), {1, 1, 3});
  EXPECT_TRUE(is_noted("spacing of slices is the file's, whose unit is not stated")) << notes();
  expect_near(with("unit=inch\nspacing=1\nzunit=ft\n"), {0.25, 0.5, 12});
  expect_near(with("unit=nanometers\nspacing=1\nzunit=Angstrom\n"), {0.25, 0.5, 0.1});
  const Volume moved = components(changed(3, [&](test::TiffPage& page, int k) {
                         page.rationals = {{282, 4}, {283, 2}};
                         if (k == 0) {
                           page.description =
                               "ImageJ=1.53t\nimages=3\nslices=3\nunit=mm\nspacing=3\nxorigin=2\n"
                               "yorigin=-4\nzorigin=1\ninverty=true\n";
                         }
                       })).front();
  expect_near(moved.description().placement.origin, {-0.5, 2, -3});
  EXPECT_TRUE(is_noted("inverty")) << notes();
}

TEST_F(DescribedTiffTest, AxesOfScifio) {
  const auto with = [&](int pages, const std::string& axes, const std::string& lengths,
                        const std::string& more = "") {
    return described(pages, "SCIFIO=0.42.0\naxes=" + axes + "\nlengths=" + lengths + "\n" + more);
  };
  EXPECT_EQ(order(with(6, "X,Y,Z,Channel", "5,4,3,2")), "0 1 2, 3 4 5");
  EXPECT_EQ(order(with(6, "X,Y,Channel,Z", "5,4,2,3")), "0 2 4, 1 3 5");
  EXPECT_EQ(order(with(6, "X,Y,Time,Z", "5,4,2,3",
                       "images=6\nchannels=1\nslices=3\nframes=2\nhyperstack=true\n")),
            "0 2 4, 1 3 5");
  EXPECT_EQ(order(with(12, "X,Y,Z,Lifetime,Channel", "5,4,3,2,2")), "0 1 2, 6 7 8, 3 4 5, 9 10 11");
  EXPECT_EQ(order(described(6, "ImageJ=\nSCIFIO=1\naxes=X,Y,Channel,Z\nlengths=5,4,2,3\n")),
            "0 2 4, 1 3 5");
  EXPECT_TRUE(contains(refused(with(6, "X,Y,Z,Channel", "5,4,4,2")), "4 slices of 2 channels"));
  EXPECT_TRUE(contains(refused(with(6, "X,Y,A,B", "5,4,3,2")), "two axes that are neither"));
  EXPECT_TRUE(contains(refused(with(6, "X,Y,Z", "5,4,-6")), "lengths=-6"));
  expect_near(spacing(with(3, "X,Y,Z", "5,4,3", "scales=0.5,0.25,2\nunits=mm,mm,cm\n")),
              {0.5, 0.25, 20});
  expect_near(spacing(with(3, "X,Y,Z", "5,4,3", "scales=1.0,1.0,1.0\nunits=null,null,null\n")),
              {1, 1, 1});
  EXPECT_TRUE(is_noted("nothing of distances")) << notes();
}

TEST_F(DescribedTiffTest, ArraysOfTifffile) {
  EXPECT_EQ(order(described(6, R"({"shape": [2, 3, 4, 5], "axes": "CZYX"})")), "0 1 2, 3 4 5");
  EXPECT_EQ(order(described(6, R"({"shape": [3, 2, 4, 5], "axes": "ZCYX"})")), "0 2 4, 1 3 5");
  EXPECT_EQ(order(described(12, R"({"shape": [2, 3, 2, 4, 5], "axes": "TZCYX"})")),
            "0 2 4, 1 3 5, 6 8 10, 7 9 11");
  EXPECT_EQ(order(described(6, R"({"shape": [1, 2, 1, 3, 4, 5], "axes": "TCQZYX"})")),
            "0 1 2, 3 4 5");
  EXPECT_EQ(order(described(3, R"({"shape": [3, 4, 5]})")), "0 1 2");
  EXPECT_EQ(order(described(3, "shape=(3, 4, 5)")), "0 1 2");
  EXPECT_EQ(order(described(3, R"({"shape": [3, 4, 5], "axes": "QYX"})")), "0 1 2");
  EXPECT_TRUE(is_noted("along an axis \"q\"; they are taken as slices")) << notes();
  EXPECT_EQ(order(described(6, R"({"shape": [2, 3, 4, 5], "axes": "QZYX"})")), "0 1 2, 3 4 5");
  // Nobody says which is which.
  EXPECT_EQ(order(described(6, R"({"shape": [3, 2, 4, 5]})")), "0 2 4, 1 3 5");
  EXPECT_TRUE(is_noted("is taken as zcyx")) << notes();
  ReadOptions options;
  options.axes = "czyx";
  EXPECT_EQ(order(path("d.tif"), options), "0 1, 2 3, 4 5");
  options.axes = "zyx";
  EXPECT_TRUE(contains(refused(path("d.tif"), options), "give czyx or zcyx"));
  options.axes = "zyxc";
  EXPECT_TRUE(contains(refused(path("d.tif"), options), "are not those of its pages"));
  EXPECT_TRUE(contains(refused(described(3, ""), options), "leave the axes out"));

  EXPECT_TRUE(contains(refused(described(6, R"({"shape": [7, 4, 5]})")), "the file has 6 pages"));
  EXPECT_TRUE(
      contains(refused(described(6, R"({"shape": [6, 5, 4]})")), "whose last axes are not"));
  EXPECT_TRUE(contains(refused(described(6, R"({"shape": [6, 4, 5], "axes": "XYZ"})")), "(xyz)"));
  EXPECT_TRUE(contains(refused(described(6, R"({"shape": [6, 4, 5], "axes": "XYC"})")), "along x"));
  EXPECT_TRUE(
      contains(refused(described(8, R"({"shape": [2, 2, 2, 4, 5]})")), "what its axes are"));
  EXPECT_TRUE(contains(refused(described(4, R"({"shape": [2, 2, 4, 5], "axes": "QRYX"})")),
                       "several axes"));
  EXPECT_FALSE(refused(described(6, R"({"shape": [0, 4, 5]})")).empty());
  EXPECT_FALSE(refused(described(6, R"({"shape": [1e99, 4, 5]})")).empty());
  // Words of people in braces.
  EXPECT_EQ(order(described(3, "{ my \"shape\" and \"axes\" }")), "0 1 2");
  expect_near(spacing(changed(3,
                              [](test::TiffPage& page, int k) {
                                page.rationals = {{282, 4}, {283, 2}};
                                page.fields[296] = {1};
                                if (k == 0)
                                  page.description =
                                      R"({"shape": [3, 4, 5], "spacing": 3, "unit": "um"})";
                              })),
              {0.25, 0.5, 3});
  expect_near(spacing(described(3, R"({"shape": [3, 4, 5], "PhysicalSizeX": 0.5, "PhysicalSizeY":
                                       0.25, "PhysicalSizeZ": 1, "PhysicalSizeZUnit": "mm"})")),
              {0.5, 0.25, 1000});
}

TEST_F(DescribedTiffTest, AxistagsOfVigra) {
  const std::string tags =
      R"({"axes": [{"key": "LETTER", "typeFlags": 2}, {"key": "y"}, {"key": "x"}]})";
  const auto with = [&](const std::string& letter) {
    std::string text = tags;
    return described(3, text.replace(text.find("LETTER"), 6, letter));
  };
  EXPECT_EQ(order(with("z")), "0 1 2");
  ReadOptions cells;
  cells.centering = Centering::cell;
  EXPECT_EQ(order(with("c"), cells), "0, 1, 2");
  EXPECT_EQ(order(with("t"), cells), "0, 1, 2");
  EXPECT_EQ(order(described(6, R"({"shape": [2, 3, 4, 5], "axes": [{"key": "z"}, {"key": "c"},
                                   {"key": "y"}, {"key": "x"}]})")),
            "0 3, 1 4, 2 5");
  EXPECT_TRUE(contains(refused(described(6, R"({"axes": [{"key": "z"}, {"key": "c"}, {"key": "y"},
                                                {"key": "x"}]})")),
                       "names the axes zcyx"));
}

TEST_F(DescribedTiffTest, ScanImage) {
  const auto with = [&](int pages, const std::string& settings, std::uint16_t tag = 305) {
    return changed(pages, [&](test::TiffPage& page, int k) {
      if (k == 0) page.texts[tag] = settings;
    });
  };
  const std::string two = "SI.VERSION_MAJOR = 5\nSI.hChannels.channelSave = [1;3]\n";
  EXPECT_EQ(order(with(6, two + "SI.hStackManager.enable = true\nSI.hStackManager.numSlices = 3\n"
                                "SI.hStackManager.framesPerSlice = 1\n"
                                "SI.hStackManager.stackZStepSize = -2.5\n")),
            "0 2 4, 1 3 5");
  EXPECT_NEAR(components(path("c.tif")).front().description().placement.spacing.z, 2.5, 1e-9);
  EXPECT_EQ(order(with(8, two + "SI.hFastZ.enable = 1\nSI.hFastZ.numFramesPerVolume = 2\n")),
            "0 2, 1 3, 4 6, 5 7");
  EXPECT_EQ(order(with(8, two + "SI.hStackManager.enable = true\nSI.hStackManager.numSlices = 2\n"
                                "SI.hStackManager.framesPerSlice = 4\n"
                                "SI.hScan2D.logAverageFactor = 2\n")),
            "0 4, 1 5, 2 6, 3 7");
  ReadOptions cells;
  cells.centering = Centering::cell;
  EXPECT_EQ(order(with(4, two + "SI.hStackManager.enable = false\n"), cells), "0, 1, 2, 3");
  EXPECT_TRUE(contains(refused(with(5, two + "SI.hStackManager.enable = true\n"
                                             "SI.hStackManager.numSlices = 3\n")),
                       "the file has 5 pages"));
  EXPECT_EQ(order(with(6,
                       "state.configName='x'\rstate.acq.numberOfChannelsSave=2\r"
                       "state.acq.numberOfZSlices=3\rstate.acq.numberOfFrames=1\r"
                       "state.acq.zStepSize=4\r",
                       270)),
            "0 2 4, 1 3 5");
}

TEST_F(DescribedTiffTest, RecordsOfLsm) {
  const auto with = [&](const std::array<std::int32_t, 5>& sides, std::uint16_t scan = 0) {
    std::string record(128, '\0');
    std::memcpy(&record[8], sides.data(), sizeof sides);
    const double metres[] = {2e-7, 3e-7, 1.5e-6};
    std::memcpy(&record[40], metres, sizeof metres);
    std::memcpy(&record[88], &scan, sizeof scan);
    return changed(6, [&](test::TiffPage& page, int k) {
      if (k == 0) page.records[34412] = record;
    });
  };
  EXPECT_EQ(order(with({5, 4, 3, 1, 2})), "0 1 2, 3 4 5");
  expect_near(spacing(path("c.tif")), {0.2, 0.3, 1.5});
  EXPECT_TRUE(contains(refused(with({5, 4, 5, 1, 1})), "(LSM) says 5 slices"));
  components(with({5, 4, 6, 1, 1}, 3));
  EXPECT_TRUE(is_noted("scan of type 3")) << notes();
  EXPECT_EQ(order(changed(3, [](test::TiffPage& page, int) { page.records[34412] = "short"; })),
            "0 1 2");
}

TEST_F(DescribedTiffTest, PagesOfMicroManager) {
  const auto with = [&](const std::vector<std::string>& metadata) {
    return changed(static_cast<int>(metadata.size()), [&](test::TiffPage& page, int k) {
      page.texts[51123] = metadata[static_cast<std::size_t>(k)];
    });
  };
  const auto page = [](int z, int c, int position = 0) {
    return "{\"SliceIndex\": " + std::to_string(z) + ", \"ChannelIndex\": " + std::to_string(c) +
           ", \"FrameIndex\": 0, \"PositionIndex\": " + std::to_string(position) +
           ", \"PixelSizeUm\": 0.5, \"z-step_um\": 2}";
  };
  EXPECT_EQ(order(with({page(0, 0), page(0, 1), page(1, 0), page(1, 1)})), "0 2, 1 3");
  expect_near(spacing(path("c.tif")), {0.5, 0.5, 2});
  EXPECT_EQ(order(with({page(1, 0), page(0, 0)})), "1 0");
  EXPECT_TRUE(contains(refused(with({page(0, 0), page(0, 1), page(1, 0)})), "missing"));
  EXPECT_TRUE(contains(refused(with({page(0, 0), page(0, 0)})), "two pages for one plane"));
  EXPECT_TRUE(contains(refused(with({page(0, 0), page(1, 0, 1)})), "several positions"));
  const auto axes = [](int z, const std::string& channel) {
    return "{\"Axes\": {\"z\": " + std::to_string(z) + ", \"channel\": \"" + channel + "\"}}";
  };
  const fs::path named =
      with({axes(-1, "GFP"), axes(-1, "DAPI"), axes(-2, "GFP"), axes(-2, "DAPI")});
  EXPECT_EQ(order(named), "2 0, 3 1");
  ReadOptions options;
  options.component_name = "DAPI";
  EXPECT_EQ(order(named, options), "3 1");
  EXPECT_EQ(order(with({"words", "words"})), "0 1");
}

TEST_F(DescribedTiffTest, MasksAndThumbnailsAreNoSlices) {
  EXPECT_EQ(order(changed(5,
                          [](test::TiffPage& page, int k) {
                            if (k == 1) page.fields[254] = {1};
                            if (k == 2) page.fields[254] = {4};
                            if (k == 4) page.fields[254] = {5};
                          })),
            "0 3");
}

TEST_F(DescribedTiffTest, NamesOfUnits) {
  const auto micrometres = [&](const std::string& unit) {
    return 1e6 * spacing(described(2, test::ome_xml({2, 1, 1}, "<TiffData/>",
                                                    "PhysicalSizeX=\"1\" PhysicalSizeXUnit=\"m\" "
                                                    "PhysicalSizeY=\"1\" PhysicalSizeYUnit=\"m\" "
                                                    "PhysicalSizeZ=\"1\" PhysicalSizeZUnit=\"" +
                                                        unit + "\"")))
                     .z;
  };
  // Those of OME's UnitsLength, in µm.
  const std::pair<const char*, double> units[] = {{"Mm", 1e12},
                                                  {"km", 1e9},
                                                  {"hm", 1e8},
                                                  {"dam", 1e7},
                                                  {"m", 1e6},
                                                  {"dm", 1e5},
                                                  {"cm", 1e4},
                                                  {"mm", 1e3},
                                                  {"\u00b5m", 1},
                                                  {"\u03bcm", 1},
                                                  {"um", 1},
                                                  {"nm", 1e-3},
                                                  {"pm", 1e-6},
                                                  {"fm", 1e-9},
                                                  {"am", 1e-12},
                                                  {"zm", 1e-15},
                                                  {"ym", 1e-18},
                                                  {"Gm", 1e15},
                                                  {"Tm", 1e18},
                                                  {"Pm", 1e21},
                                                  {"Em", 1e24},
                                                  {"Zm", 1e27},
                                                  {"Ym", 1e30},
                                                  {"\u00c5", 1e-4},
                                                  {"\u212b", 1e-4},
                                                  {"thou", 25.4},
                                                  {"in", 25400},
                                                  {"ft", 304800},
                                                  {"yd", 914400},
                                                  {"mi", 1609344000},
                                                  {"pt", 25400. / 72},
                                                  {"li", 25400. / 12},
                                                  {"ua", 149597870700e6},
                                                  {"ly", 9460730472580800e6},
                                                  {"pc", 3.0856775814913673e22}};
  for (const auto& [unit, expected] : units) {
    SCOPED_TRACE(unit);
    EXPECT_NEAR(micrometres(unit) / expected, 1, 1e-9);
  }
  for (const char* unit : {"pixel", "reference frame", "parrot", "MM"}) {
    SCOPED_TRACE(unit);
    EXPECT_NEAR(micrometres(unit), 1e6, 1e-3);
    EXPECT_TRUE(is_noted("cannot be turned into one")) << notes();
  }
}

}  // namespace
}  // namespace pellucid::test_described_tiff
