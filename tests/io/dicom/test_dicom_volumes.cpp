// SPDX-License-Identifier: Apache-2.0
//
// Series of several volumes, positions that are rounded or missing, and what is told of values.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "dicom_files.h"
#include "pellucid/io/dicom_series.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/io/time_steps.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_dicom_volumes {
namespace {

using test::bytes_of;
using test::contains;
using test::DicomSliceFile;
using test::error_of;
using test::expect_near;
using test::value_at;
using test::world_of;

class DicomVolumesTest : public test::ScratchFolder {
 protected:
  using Change = std::function<void(DicomSliceFile&, int)>;

  /// Slice `i` of `count` by its number: all values are i, the position is what `change` says.
  void write_slices(int count, const Change& change) {
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      std::filesystem::remove(entry.path());
    }
    for (int i = 0; i < count; ++i) {
      DicomSliceFile file;
      file.set(0x00200013, std::to_string(i + 1));
      file.pixels = bytes_of(std::vector<std::uint16_t>(20, static_cast<std::uint16_t>(i)));
      change(file, i);
      write("s" + std::to_string(100 + i), file.bytes());
    }
  }
  static std::string at(double z) { return "10\\20\\" + std::to_string(z); }

  Volume read_noting(const std::string& series = "") {
    ReadOptions options;
    notes_.clear();
    options.note = [this](const std::string& text) { notes_ += text + "\n"; };
    if (!series.empty()) options.series = series;
    return read_volume(folder_, options);
  }
  /// Expects each series to have these values along z.
  void expect_series(const std::vector<std::vector<int>>& values, const std::string& name = "") {
    const std::vector<DicomSeries> list = list_dicom_series(folder_);
    ASSERT_EQ(list.size(), values.size());
    for (std::size_t s = 0; s < values.size(); ++s) {
      const Volume volume = read_noting(std::to_string(s + 1));
      ASSERT_EQ(volume.description().dimensions[2], static_cast<int>(values[s].size()));
      for (std::size_t k = 0; k < values[s].size(); ++k) {
        EXPECT_EQ(value_at(volume, 0, 0, static_cast<int>(k)), values[s][k]) << s << ", " << k;
      }
      EXPECT_TRUE(volume.description().coordinates[2].empty());
      EXPECT_TRUE(name.empty() || contains(list[s].description, name)) << list[s].description;
    }
    if (values.size() < 2) return;
    const std::string text = error_of([&] { read_volume(folder_); });
    EXPECT_TRUE(contains(text, "DICOM series") && contains(text, name)) << text;
  }
  /// Expects the value of the slice `k` at a time, by the path of any file.
  void expect_of_file(double time, int k) {
    ReadOptions options;
    options.time = time;
    EXPECT_EQ(value_at(read_volume(folder_ / "s105", options), 0, 0, k), k);
  }
  std::string notes_;
};

// Two acquisitions between each other's slices, numbered one behind the other.
TEST_F(DicomVolumesTest, AcquisitionsThatInterleaveAreTwoSeries) {
  write_slices(8, [](auto& f, int i) {
    f.at(at(30 + 3 * (i % 4) + 1.5 * (i / 4)));
    f.set(0x00200012, std::to_string(i / 4 + 1));
  });
  expect_series({{0, 1, 2, 3}, {4, 5, 6, 7}}, "AcquisitionNumber");
  // A file leads to its own.
  EXPECT_EQ(value_at(read_volume(path("s105")), 0, 0, 0), 4);
  // Without a number of the acquisition, an offset that is no half step.
  for (const double offset : {1.0, 1.5, -1.0}) {
    write_slices(8, [&](auto& f, int i) { f.at(at(30 + 3 * (i % 4) + offset * (i / 4))); });
    expect_series({{0, 1, 2, 3}, {4, 5, 6, 7}}, "by InstanceNumber");
  }
  // A slice is missing in one; two ranges that overlap in part.
  write_slices(8, [](auto& f, int i) {
    f.at(at(i < 4 ? 30 + 3 * (i < 2 ? i : i + 1) : 31 + 3 * (i - 4)));
    f.set(0x00200012, std::to_string(i / 4 + 1));
  });
  ASSERT_EQ(list_dicom_series(folder_).size(), 2u);
  EXPECT_EQ(read_noting("1").description().coordinates[2], (std::vector<double>{0, 3, 9, 12}));
  write_slices(8, [](auto& f, int i) {
    f.at(at(i < 4 ? 30 + 3 * i : 37 + 3 * (i - 4)));
    f.set(0x00200012, std::to_string(i / 4 + 1));
  });
  expect_series({{0, 1, 2, 3}, {4, 5, 6, 7}}, "AcquisitionNumber");
  // Down the first time, up the second.
  write_slices(8, [](auto& f, int i) {
    f.at(at(i < 4 ? 60 - 3 * i : 50 + 3 * (i - 4)));
    f.set(0x00200012, std::to_string(i / 4 + 1));
  });
  expect_series({{3, 2, 1, 0}, {4, 5, 6, 7}}, "AcquisitionNumber");
}

// What scanners do of one stack.
TEST_F(DicomVolumesTest, AcquisitionsOfOneStackStayOne) {
  const std::vector<int> all{0, 1, 2, 3, 4, 5, 6, 7};
  // Each slice is an acquisition.
  write_slices(8,
               [](auto& f, int i) { f.at(at(30 + 3 * i)).set(0x00200012, std::to_string(i + 1)); });
  expect_series({all});
  EXPECT_EQ(notes_, "");
  // The lower half and the upper half; a pair of slices at a time.
  for (const int size : {4, 2}) {
    write_slices(8, [&](auto& f, int i) {
      f.at(at(30 + 3 * i)).set(0x00200012, std::to_string(i / size + 1));
    });
    expect_series({all});
    EXPECT_EQ(notes_, "");
  }
  // Odd and even slices in turn, numbered along the stack.
  write_slices(
      8, [](auto& f, int i) { f.at(at(30 + 3 * i)).set(0x00200012, std::to_string(i % 2 + 1)); });
  expect_series({all});
  EXPECT_TRUE(contains(notes_, "alternate")) << notes_;
  // Numbers in no order.
  write_slices(8, [](auto& f, int i) {
    f.at(at(30 + 3 * i)).set(0x00200013, std::to_string((5 * i + 3) % 8));
  });
  expect_series({all});
  EXPECT_EQ(notes_, "");
  // A time for each slice.
  write_slices(8, [](auto& f, int i) {
    f.at(at(30 + 3 * i));
    f.text[0x00080032] = {"TM", "1200" + std::to_string(10 + i) + ".5"};
  });
  expect_series({all});
  EXPECT_EQ(notes_, "");
}

TEST_F(DicomVolumesTest, WhatTellsVolumesAtOnePlaceApart) {
  const auto places = [](auto& f, int i) { f.at(at(30 + 3 * (i / 2))); };
  struct Case {
    std::uint32_t tag;
    const char *type, *first, *second, *name;
  };
  for (const Case& c : std::initializer_list<Case>{
           {0x00180086, "IS", "1", "2", "EchoNumbers"},
           {0x00180081, "DS", "2.5", "11", "EchoTime"},
           {0x00200100, "IS", "2", "10", "TemporalPosition"},
           {0x00080008, "CS", "ORIGINAL\\PRIMARY\\M", "ORIGINAL\\PRIMARY\\P", "ImageType"},
           {0x00180082, "DS", "100", "900", "InversionTime"},
           {0x00181210, "SH", "B30f", "B70f", "ConvolutionKernel"},
           {0x00200012, "IS", "1", "2", "AcquisitionNumber"},
           {0x00181060, "DS", "0", "40", "TriggerTime"},
           {0x00089208, "CS", "MAGNITUDE", "PHASE", "ComplexImageComponent"}}) {
    SCOPED_TRACE(c.name);
    write_slices(8, [&](auto& f, int i) {
      places(f, i);
      f.text[c.tag] = {c.type, i % 2 == 0 ? c.first : c.second};
    });
    expect_series({{0, 2, 4, 6}, {1, 3, 5, 7}}, c.name);
  }
  // Of b-values, doubles; of two attributes, four volumes.
  write_slices(8, [&](auto& f, int i) {
    places(f, i);
    f.text[0x00189087] = {"FD", bytes_of(std::vector<double>{i % 2 == 0 ? 0. : 1000.})};
  });
  expect_series({{0, 2, 4, 6}, {1, 3, 5, 7}}, "DiffusionBValue");
  write_slices(12, [&](auto& f, int i) {
    f.at(at(30 + 3 * (i / 4)));
    f.set(0x00180086, std::to_string(i % 2 + 1)).set(0x00200100, std::to_string(i / 2 % 2 + 1));
  });
  expect_series({{0, 4, 8}, {2, 6, 10}, {1, 5, 9}, {3, 7, 11}}, "EchoNumbers");
  // By nothing but their numbers.
  write_slices(8, [&](auto& f, int i) { places(f, i); });
  expect_series({{0, 2, 4, 6}, {1, 3, 5, 7}}, "by InstanceNumber");
  // By nothing at all.
  write_slices(8, [&](auto& f, int i) {
    places(f, i);
    f.set(0x00200013, "1");
  });
  EXPECT_TRUE(contains(error_of([&] { read_volume(folder_); }), "same place"));
}

TEST_F(DicomVolumesTest, FramesOfOneFileAreToldApart) {
  DicomSliceFile file;
  const test::DicomWriter w = file.writer();
  file.without(0x00200032);
  file.text[0x00280008] = {"IS", "6"};
  for (int i = 0; i < 6; ++i) {
    file.sequences[0x52009230].push_back(
        w.sequence(0x00209111, {w.element(0x00209128, "UL", w.number(i % 2 == 0 ? 1 : 2, 4))}) +
        w.sequence(0x00209113,
                   {w.element(0x00200032, "DS", "10\\20\\" + std::to_string(30 + 3 * (i / 2)))}));
    file.pixels += bytes_of(std::vector<std::uint16_t>(20, static_cast<std::uint16_t>(i)));
  }
  write("frames", file.bytes());
  expect_series({{0, 2, 4}, {1, 3, 5}}, "TemporalPosition");
  const std::vector<DicomSeries> list = list_dicom_series(folder_);
  EXPECT_TRUE(contains(list[1].description, "TemporalPosition 2")) << list[1].description;
}

TEST_F(DicomVolumesTest, RoundedPositionsAreALine) {
  const double c = std::cos(0.35), s = std::sin(0.35);
  const auto text = [](double x, int decimals) {
    char number[40];
    std::snprintf(number, sizeof number, "%.*f", decimals, x);
    return std::string(number);
  };
  for (const int decimals : {1, 2, 3}) {
    for (const bool zeros : {false, true}) {
      SCOPED_TRACE(std::to_string(decimals) + (zeros ? " with zeros" : ""));
      const auto rounded = [&](double x) { return text(x, decimals) + (zeros ? "0000" : ""); };
      write_slices(12, [&](auto& f, int i) {
        f.set(0x00280030, "0.4\\0.4");
        f.set(0x00200037, "1\\0\\0\\0\\" + text(c, 6) + "\\" + text(s, 6));
        f.at(rounded(10.123) + "\\" + rounded(20.456 - s * 0.9 * i) + "\\" +
             rounded(30.789 + c * 0.9 * i));
      });
      const Volume volume = read_noting();
      ASSERT_EQ(volume.description().dimensions[2], 12);
      EXPECT_TRUE(volume.description().coordinates[2].empty());
      EXPECT_NEAR(volume.description().placement.spacing.z, 0.9, 0.2 * std::pow(10, -decimals));
      for (int i = 0; i < 12; ++i) EXPECT_EQ(value_at(volume, 0, 0, i), i);
      expect_near(world_of(volume, 0, 0, 11), {10.123, 20.456 - s * 9.9, 30.789 + c * 9.9},
                  2 * std::pow(10, -decimals));
      EXPECT_FALSE(contains(notes_, "sheared")) << notes_;
      EXPECT_EQ(contains(notes_, "rounding"), decimals < 3) << notes_;
    }
  }
  // What rounding does not explain is refused, and a slice that is missing is seen.
  write_slices(12, [&](auto& f, int i) {
    f.at((i == 5 ? "10.52" : "10.12") + std::string("\\20.5\\") + text(30 + 0.9 * i, 2));
  });
  EXPECT_TRUE(contains(error_of([&] { read_volume(folder_); }), "s105 is 0.4 mm beside the line"));
  write_slices(
      12, [&](auto& f, int i) { f.at("10.1\\20.5\\" + text(30 + 0.9 * (i < 6 ? i : i + 1), 1)); });
  EXPECT_FALSE(read_noting().description().coordinates[2].empty());
  // Many beside the line are no single stack; nobody is told to leave out one.
  write_slices(
      12, [&](auto& f, int i) { f.at(std::to_string(i % 3) + "\\20\\" + std::to_string(30 + i)); });
  const std::string beside = error_of([&] { read_volume(folder_); });
  EXPECT_TRUE(contains(beside, "slices are beside the line") && !contains(beside, "leave it out"))
      << beside;
}

TEST_F(DicomVolumesTest, SliceLocationStandsInForPositions) {
  write_slices(4, [](auto& f, int i) {
    f.without(0x00200032).set(0x00201041, std::to_string(40 - 2.5 * i));
  });
  const Volume volume = read_noting();
  EXPECT_NEAR(volume.description().placement.spacing.z, 2.5, 1e-9);
  expect_near(world_of(volume, 0, 0, 0), {0, 0, 32.5});
  for (int k = 0; k < 4; ++k) EXPECT_EQ(value_at(volume, 0, 0, k), 3 - k);
  EXPECT_TRUE(contains(notes_, "SliceLocation")) << notes_;
  // A gap is one; where positions are, they count.
  write_slices(4, [](auto& f, int i) {
    f.without(0x00200032).set(0x00201041, std::to_string(i < 2 ? i : i + 1));
  });
  EXPECT_EQ(read_noting().description().coordinates[2], (std::vector<double>{0, 1, 3, 4}));
  write_slices(4, [](auto& f, int i) { f.at(at(3 * i)).set(0x00201041, "7"); });
  EXPECT_NEAR(read_noting().description().placement.spacing.z, 3, 1e-9);
  EXPECT_EQ(notes_, "");
  // Two echoes at each.
  write_slices(6, [](auto& f, int i) {
    f.without(0x00200032)
        .set(0x00201041, std::to_string(i / 2))
        .set(0x00180086, std::to_string(i % 2));
  });
  expect_series({{0, 2, 4}, {1, 3, 5}}, "EchoNumbers");
}

TEST_F(DicomVolumesTest, WithoutAnOrientationNothingIsCalledLps) {
  write_slices(3, [](auto& f, int i) { f.at(at(3 * i)); });
  EXPECT_EQ(world_space(folder_), "LPS");
  EXPECT_TRUE(is_placed_in_lps(path("s101")));
  write_slices(3, [](auto& f, int i) { f.at(at(3 * i)).without(0x00200037); });
  EXPECT_EQ(world_space(folder_), "");
}

// Three phases of four slices, whose times are 300, 100 and 200 ms in the order of their numbers.
TEST_F(DicomVolumesTest, PhasesAreFoundByTheirTimes) {
  const std::array<int, 3> times{300, 100, 200};
  struct Tag {
    std::uint32_t tag;
    const char* unit;
  };
  for (const auto& [tag, unit] :
       {Tag{0x00181060, "ms (TriggerTime)"}, Tag{0x00200100, "TemporalPositionIdentifier"},
        Tag{0x00541300, "ms (FrameReferenceTime)"}}) {
    write_slices(12, [&](auto& f, int i) {
      f.at(at(30 + 3 * (i % 4)));
      f.set(tag, std::to_string(times[static_cast<std::size_t>(i / 4)]));
    });
    FieldSource source;
    source.file = folder_;
    EXPECT_EQ(source_times(source), (std::vector<double>{100, 200, 300}));
    for (std::size_t step = 0; step < 3; ++step) {
      ReadOptions options;
      options.time = times[step] + 10;
      notes_.clear();
      options.note = [this](const std::string& text) { notes_ += text + "\n"; };
      const Volume volume = read_volume(folder_, options);
      EXPECT_EQ(value_at(volume, 0, 0, 1), 4 * static_cast<double>(step) + 1);
      EXPECT_TRUE(contains(notes_, unit)) << notes_;
    }
    ReadOptions between;
    between.time = 125;
    between.time_between = TimeBetween::linear;
    EXPECT_EQ(value_at(read_volume(folder_, between), 0, 0, 1), 0.75 * 5 + 0.25 * 9);
    // By any of its files, and of one series as ever by its number.
    expect_of_file(300, 1);
    EXPECT_EQ(value_at(read_noting("1"), 0, 0, 0), 4);
  }
  // Times of the day, of which each slice has its own.
  write_slices(12, [&](auto& f, int i) {
    f.at(at(30 + 3 * (i % 4)));
    f.set(0x00200012, std::to_string(i / 4));
    f.set(0x00080032, "10150" + std::to_string(2 * (2 - i / 4)) + "." + std::to_string(i % 4 + 1));
  });
  FieldSource source;
  source.file = folder_;
  const double noon = 10 * 3600 + 15 * 60;
  EXPECT_EQ(source_times(source), (std::vector<double>{noon + 0.1, noon + 2.1, noon + 4.1}));
  // Echoes are no times.
  write_slices(8, [&](auto& f, int i) {
    f.at(at(30 + 3 * (i % 4)));
    f.set(0x00180086, std::to_string(i / 4 + 1));
    f.set(0x00181060, std::to_string(100 * (i / 4)));
  });
  EXPECT_TRUE(contains(error_of([&] { source_times(source); }), "DICOM series"));
  ReadOptions options;
  options.time = 100;
  EXPECT_TRUE(contains(error_of([&] { read_volume(folder_, options); }), "differ in time alone"));
}

}  // namespace
}  // namespace pellucid::test_dicom_volumes
