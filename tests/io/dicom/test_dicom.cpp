// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#ifdef PELLUCID_HAVE_GDCM
#include <gdcmImageChangeTransferSyntax.h>
#include <gdcmImageReader.h>
#include <gdcmImageWriter.h>
#endif

#include "dicom_files.h"
#include "pellucid/io/dicom_series.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_dicom {
namespace {

using test::bytes_of;
using test::contains;
using test::DicomSliceFile;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::value_at;
using test::world_of;

/// 20 values of a slice of `counting`, from 20 k on.
template <class Value>
std::vector<Value> slice_values(int k) {
  std::vector<Value> values(20);
  for (std::size_t i = 0; i < 20; ++i) {
    values[i] = static_cast<Value>(static_cast<std::size_t>(20 * k) + i);
  }
  return values;
}

class DicomTest : public test::ScratchFolder {
 protected:
  // Slice k of three stands at z = 30 + 12 k, in a file whose name says nothing.
  static DicomSliceFile slice(int k) {
    DicomSliceFile file;
    file.at("10\\20\\" + std::to_string(30 + 12 * k));
    file.set(0x00200013, std::to_string(k + 1));
    file.pixels = bytes_of(slice_values<std::uint16_t>(k));
    return file;
  }
  template <class Change>
  void write_series(const Change& change, const std::string& before = "") {
    static constexpr const char* names[] = {"c", "a", "b.txt"};
    for (int k = 0; k < 3; ++k) {
      DicomSliceFile file = slice(k);
      change(file, k);
      write(before + names[k], file.bytes());
    }
  }
  void write_series() {
    write_series([](DicomSliceFile&, int) {});
  }
  Volume read_noting(const ReadOptions& given = {}) {
    ReadOptions options = given;
    notes_.clear();
    options.note = [this](const std::string& text) { notes_ += text + "\n"; };
    return read_volume(folder_, options);
  }
  std::string refused() {
    return error_of([&] { read_volume(folder_); });
  }

  std::string notes_;
};

TEST_F(DicomTest, AFolderIsASeriesSortedByPosition) {
  write_series();
  const Volume volume = read_noting();
  expect_counting(volume, "u16");
  EXPECT_EQ(notes_, "");
  EXPECT_EQ(volume.description().name, folder_.string());
  // The distance of positions is 12, whatever the thickness of 8; the row spacing comes first.
  expect_near(world_of(volume, 4, 3, 2), {10 + 4, 20 + 3 * 2, 30 + 2 * 12});
}

TEST_F(DicomTest, AnyFileOfItLeadsToTheSeries) {
  write_series();
  write("z.dcm", "not DICOM");
  expect_counting(read_volume(path("a")), "u16");
  expect_counting(read_volume(path("b.txt")), "u16");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("z.dcm")); }), "has no pixels"));
}

TEST_F(DicomTest, SlicesThatGoDownAreTurned) {
  write_series([](DicomSliceFile& file, int k) {
    file.at("10\\20\\" + std::to_string(30 - 12 * k));
    file.set(0x00200037, "1\\0\\0\\0\\-1\\0");  // the normal is -z
  });
  const Volume volume = read_volume(folder_);
  expect_counting(volume, "u16");
  expect_near(world_of(volume, 4, 3, 2), {14, 20 - 6, 30 - 24});
}

TEST_F(DicomTest, TransferSyntaxes) {
  for (const char* syntax : {"1.2.840.10008.1.2", "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2"}) {
    SCOPED_TRACE(syntax);
    for (const bool undefined : {false, true}) {
      write_series([&](DicomSliceFile& file, int k) {
        file.syntax = syntax;
        file.undefined_lengths = undefined;
        // Sequences around, one within the other.
        const test::DicomWriter w = file.writer();
        file.sequences[0x00081140] = {
            w.element(0x00081150, "UI", "1.2") +
                w.sequence(0x00081199, {w.element(0x00280010, "US", w.number(99, 2))}),
            w.element(0x00281052, "DS", "77")};
        if (file.writer().big_endian) {
          file.pixels = test::swapped_bytes_of(slice_values<std::uint16_t>(k));
        }
      });
      expect_counting(read_volume(folder_), "u16");
    }
  }
  write_series([](DicomSliceFile& file, int) { file.syntax = "1.2.840.10008.1.2.1.99"; });
  EXPECT_TRUE(contains(refused(), "deflated"));
}

TEST_F(DicomTest, WithoutAPreamble) {
  for (const char* syntax : {"1.2.840.10008.1.2", "1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2"}) {
    SCOPED_TRACE(syntax);
    write_series([&](DicomSliceFile& file, int k) {
      file.preamble = false;
      file.syntax = syntax;
      if (file.writer().big_endian) {
        file.pixels = test::swapped_bytes_of(slice_values<std::uint16_t>(k));
      }
    });
    expect_counting(read_volume(folder_), "u16");
    expect_counting(read_volume(path("c")), "u16");
    // As the two standards before DICOM begin: with the length of the group.
    write_series([&](DicomSliceFile& file, int k) {
      file.preamble = false;
      file.syntax = syntax;
      file.text.erase(0x00080016);
      file.text[0x00080000] = {"UL", file.writer().number(100, 4)};
      file.text[0x00080010] = {"LO", "ACR-NEMA 2.0"};
      if (file.writer().big_endian) {
        file.pixels = test::swapped_bytes_of(slice_values<std::uint16_t>(k));
      }
    });
    expect_counting(read_volume(folder_), "u16");
  }
}

TEST_F(DicomTest, WithPartsOfThePreamble) {
  for (const char* syntax : {"1.2.840.10008.1.2", "1.2.840.10008.1.2.1"}) {
    const auto without = [&](std::size_t first, std::size_t count) {
      for (int k = 0; k < 3; ++k) {
        DicomSliceFile file = slice(k);
        file.syntax = syntax;
        write(std::to_string(k), file.bytes().erase(first, count));
      }
      expect_counting(read_volume(folder_), "u16");
      expect_counting(read_volume(path("1")), "u16");
    };
    without(0, 0);
    without(0, 132);  // begins with group 2
    without(0, 128);  // begins with "DICM"
    without(128, 4);  // the preamble alone
  }
  // Group 2 may say what the data set is not.
  write_series([&](DicomSliceFile& file, int) { file.syntax = "1.2.840.10008.1.2"; }, "implicit-");
  for (const char* name : {"implicit-a", "implicit-b.txt", "implicit-c"}) {
    std::string bytes = read(path(name));
    const std::string said("1.2.840.10008.1.2\0", 18);
    const std::size_t at = bytes.find(said);
    ASSERT_NE(at, std::string::npos);
    write(name, bytes.replace(at, 18, std::string("1.2.840.10008.1.2.", 18)));
  }
  for (const char* name : {"0", "1", "2"}) std::filesystem::remove(path(name));
  expect_counting(read_volume(folder_), "u16");
}

TEST_F(DicomTest, OtherFilesAreNotTakenForDicom) {
  const auto is_one = [&](const std::string& bytes) {
    write("x", bytes);
    return is_dicom(path("x"));
  };
  EXPECT_FALSE(is_one(""));
  EXPECT_FALSE(is_one("DICM"));
  EXPECT_FALSE(is_one("DICM is what this text is about, and nothing else of it is"));
  EXPECT_FALSE(is_one(std::string(4096, '\0')));
  EXPECT_FALSE(is_one(std::string(4096, '\x8')));
  // Values of 16 bits that are near 8.
  for (std::uint16_t first = 0; first < 16; ++first) {
    for (std::uint16_t step = 0; step < 4; ++step) {
      std::vector<std::uint16_t> values;
      for (std::uint16_t i = 0; i < 400; ++i) {
        values.push_back(static_cast<std::uint16_t>(first + step * (i / (1 + i % 3))));
      }
      EXPECT_FALSE(is_one(bytes_of(values))) << first << ", " << step;
    }
  }
}

TEST_F(DicomTest, WholeTypesStayWhole) {
  const auto type = [&](int bits, int stored, bool is_signed, const char* slope,
                        const char* intercept) {
    write_series([&](DicomSliceFile& file, int) {
      file.set(0x00280100, bits).set(0x00280101, stored).set(0x00280102, stored - 1);
      file.set(0x00280103, is_signed ? 1 : 0);
      file.set(0x00281053, slope).set(0x00281052, intercept);
      file.pixels = std::string(static_cast<std::size_t>(20 * bits / 8), '\1');
    });
    return std::string(type_name(read_volume(folder_).data()));
  };
  EXPECT_EQ(type(8, 8, false, "1", "0"), "u8");
  EXPECT_EQ(type(8, 8, true, "1", "0"), "i8");
  EXPECT_EQ(type(8, 8, false, "1", "-10"), "i16");
  EXPECT_EQ(type(16, 12, false, "1", "0"), "u16");
  EXPECT_EQ(type(16, 12, false, "1", "-1024"), "i16");
  EXPECT_EQ(type(16, 16, false, "1", "-1024"), "i32");
  EXPECT_EQ(type(16, 16, true, "1", "0"), "i16");
  EXPECT_EQ(type(16, 16, true, "1", "1"), "i32");
  EXPECT_EQ(type(32, 32, false, "1", "0"), "u32");
  EXPECT_EQ(type(32, 32, true, "1", "0"), "i32");
  EXPECT_EQ(type(32, 32, true, "1", "-1"), "f64");
  EXPECT_EQ(type(16, 12, false, "2", "0"), "f32");
  EXPECT_EQ(type(16, 12, false, "1", "0.5"), "f32");
  EXPECT_EQ(type(32, 32, false, "0.5", "0"), "f64");
}

TEST_F(DicomTest, SlopeAndIntercept) {
  write_series([](DicomSliceFile& file, int) { file.set(0x00281053, "1").set(0x00281052, "-30"); });
  EXPECT_EQ(value_at(read_volume(folder_), 4, 3, 2), 59 - 30);
  // Of each slice its own, as PET has them.
  write_series([](DicomSliceFile& file, int k) {
    file.set(0x00281053, std::to_string(k + 1) + ".5").set(0x00281052, "-30");
  });
  const Volume volume = read_volume(folder_);
  EXPECT_EQ(type_name(volume.data()), "f32");
  EXPECT_EQ(value_at(volume, 4, 3, 0), 1.5 * 19 - 30);
  EXPECT_EQ(value_at(volume, 4, 3, 2), 3.5 * 59 - 30);
  write_series([](DicomSliceFile& file, int) { file.set(0x00281053, "0"); });
  EXPECT_TRUE(contains(refused(), "slope"));
}

TEST_F(DicomTest, ScalesThatAreNoNumbersAreNamed) {
  for (const char* text : {"2,5", "abc"}) {
    write_series([&](DicomSliceFile& file, int) { file.set(0x00281053, text); });
    EXPECT_TRUE(contains(refused(), "RescaleSlope (0028,1053) is \"" + std::string(text)))
        << refused();
    write_series(
        [&](DicomSliceFile& file, int) { file.set(0x00281053, "1").set(0x00281052, text); });
    EXPECT_TRUE(contains(refused(), "RescaleIntercept (0028,1052) is")) << refused();
  }
}

// Bits above and below those of the value belong to others (overlays).
TEST_F(DicomTest, OnlyTheBitsOfTheValueCount) {
  const auto read_bits = [&](bool is_signed, int high_bit) {
    write_series([&](DicomSliceFile& file, int) {
      file.set(0x00280102, high_bit).set(0x00280103, is_signed ? 1 : 0);
      std::vector<std::uint16_t> values(20, 0xf801);  // in 12 bits 0x801 or 0xf80
      file.pixels = bytes_of(values);
    });
    return value_at(read_volume(folder_), 1, 1, 1);
  };
  EXPECT_EQ(read_bits(false, 11), 0x801);
  EXPECT_EQ(read_bits(true, 11), 0x801 - 0x1000);
  EXPECT_EQ(read_bits(false, 15), 0xf80);
  EXPECT_EQ(read_bits(true, 15), 0xf80 - 0x1000);
}

TEST_F(DicomTest, FloatPixels) {
  write_series([](DicomSliceFile& file, int k) {
    file.pixel_tag = 0x7fe00008;
    file.pixel_type = "OF";
    file.set(0x00280100, 32).without(0x00280101).without(0x00280102).without(0x00280103);
    file.pixels = bytes_of(slice_values<float>(k));
  });
  expect_counting(read_volume(folder_), "f32");
  write_series([](DicomSliceFile& file, int k) {
    file.pixel_tag = 0x7fe00009;
    file.pixel_type = "OD";
    file.set(0x00280100, 64).set(0x00280101, 999);
    file.pixels = bytes_of(slice_values<double>(k));
  });
  expect_counting(read_volume(folder_), "f64");
}

TEST_F(DicomTest, ColorsAreComponents) {
  for (const bool planes : {false, true}) {
    write_series([&](DicomSliceFile& file, int k) {
      file.set(0x00280002, 3).set(0x00280100, 8).set(0x00280101, 8).set(0x00280102, 7);
      file.set(0x00280004, "RGB").set(0x00280006, planes ? 1 : 0);
      file.pixels.clear();
      for (int i = 0; i < 60; ++i) {
        const int pixel = planes ? i % 20 : i / 3, sample = planes ? i / 20 : i % 3;
        file.pixels += static_cast<char>(20 * k + pixel + 60 * sample);
      }
    });
    const std::vector<Volume> colors = read_components(folder_);
    ASSERT_EQ(colors.size(), 3u);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < 60; ++i) {
        ASSERT_EQ(value_at(colors[static_cast<std::size_t>(c)], i % 5, i / 5 % 4, i / 20),
                  i + 60 * c);
      }
    }
    EXPECT_TRUE(contains(refused(), "colors (RGB)"));
  }
}

TEST_F(DicomTest, ObliqueSlicesStandAsTheyLie) {
  const double c = std::cos(0.5), s = std::sin(0.5);
  const auto text = [](double x) { return std::to_string(x); };
  write_series([&](DicomSliceFile& file, int k) {
    file.set(0x00200037, text(c) + "\\0\\" + text(s) + "\\0\\1\\0");  // normal (-s, 0, c)
    file.at(text(10 - 12 * k * s) + "\\20\\" + text(30 + 12 * k * c));
  });
  const Volume volume = read_noting();
  expect_near(world_of(volume, 4, 3, 2), {10 + 4 * c - 24 * s, 26, 30 + 4 * s + 24 * c}, 1e-4);
  EXPECT_NEAR(volume.description().placement.spacing.z, 12, 1e-4);
  EXPECT_EQ(notes_, "");
}

TEST_F(DicomTest, ATiltedGantryIsKeptAndTold) {
  write_series([](DicomSliceFile& file, int k) {
    file.at("10\\" + std::to_string(20 + 3 * k) + "\\" + std::to_string(30 + 12 * k));
  });
  const Volume volume = read_noting();
  expect_near(world_of(volume, 4, 3, 2), {14, 20 + 6 + 6, 54});
  EXPECT_TRUE(contains(notes_, "sheared by 14.036"));  // atan(3 / 12)
}

TEST_F(DicomTest, UnevenSlicesMakeARectilinearGrid) {
  const auto gap = [](DicomSliceFile& file, int k) {
    file.at("10\\20\\" + std::to_string(k == 2 ? 30 + 36 : 30 + 12 * k));
  };
  write_series(gap);
  const Volume volume = read_noting();
  EXPECT_EQ(volume.description().coordinates[2], (std::vector<double>{0, 12, 36}));
  EXPECT_TRUE(contains(notes_, "12 mm from c to a")) << notes_;
  expect_near(volume.world_corners()[7], {14, 26, 66});
  ReadOptions options;
  options.spacing = Vec3<double>{1, 2, 12};
  EXPECT_TRUE(read_noting(options).description().coordinates[2].empty());
  options = {};
  options.centering = Centering::cell;
  EXPECT_TRUE(contains(error_of([&] { read_volume(folder_, options); }), "uneven"));
  // What rounding to two digits does is none.
  write_series([](DicomSliceFile& file, int k) {
    const char* const heights[] = {"0.00", "0.63", "1.25"};
    file.at(std::string("10\\20\\") + heights[k]);
  });
  EXPECT_TRUE(read_noting().description().coordinates[2].empty());
  EXPECT_NEAR(volume.description().placement.spacing.x, 1, 1e-12);
  // Decimals are those of z, whatever x has.
  write_series([](DicomSliceFile& file, int k) {
    const char* const heights[] = {"0.0", "0.6", "1.3"};
    file.at(std::string("10.123456\\20\\") + heights[k]);
  });
  notes_.clear();
  EXPECT_TRUE(read_noting().description().coordinates[2].empty());
  EXPECT_TRUE(contains(notes_, "up to 0.05 mm off even distances")) << notes_;
  write_series([](DicomSliceFile& file, int k) {
    const char* const heights[] = {"0.0", "0.6", "1.3001"};
    file.at(std::string("10.1\\20\\") + heights[k]);
  });
  EXPECT_EQ(read_noting().description().coordinates[2].size(), 3u);
}

TEST_F(DicomTest, PlacesThatContradictAreRefused) {
  write_series([](DicomSliceFile& file, int k) {
    if (k == 2) file.at("10\\20\\42");
  });
  const std::string twice = refused();
  EXPECT_TRUE(contains(twice, "same place")) << twice;
  EXPECT_TRUE(contains(twice, "a and b.txt") || contains(twice, "b.txt and a")) << twice;
  write_series([](DicomSliceFile& file, int k) {
    if (k == 1) file.at("11\\20\\42");
  });
  EXPECT_TRUE(contains(refused(), "a is 1 mm beside the line"));
}

TEST_F(DicomTest, SlicesThatLackWhatOthersHaveAreLeftOut) {
  const auto left_out = [&](const auto& change) {
    write_series([&](DicomSliceFile& file, int k) {
      if (k == 2) change(file);
    });
    EXPECT_EQ(read_noting().description().dimensions[2], 2);
    EXPECT_TRUE(contains(notes_, "1 file is left out: " + path("b.txt").string())) << notes_;
    // Asked for by name, it is told why it cannot be read.
    EXPECT_FALSE(error_of([&] { read_volume(path("b.txt")); }).empty());
    return notes_;
  };
  const auto has = [&](const std::string& text, const auto& change) {
    const std::string notes = left_out(change);
    EXPECT_TRUE(contains(notes, text)) << notes;
  };
  has("no usable position", [](auto& f) { f.without(0x00200032); });
  has("no usable position", [](auto& f) { f.at("10\\x\\54"); });
  has("no usable orientation", [](auto& f) { f.set(0x00200037, "1\\0\\0\\0\\1"); });
  has("no usable spacing", [](auto& f) { f.set(0x00280030, "2\\-1"); });
  has("RescaleSlope (0028,1053) is \"2,5\"", [](auto& f) { f.set(0x00281053, "2,5"); });
  has("17 bits end at bit 11", [](auto& f) { f.set(0x00280101, 17); });
}

TEST_F(DicomTest, WhatIsMissingIsTold) {
  write_series([](DicomSliceFile& file, int) { file.without(0x00200037).without(0x00280030); });
  const Volume volume = read_noting();
  expect_near(world_of(volume, 4, 3, 2), {14, 23, 54});
  EXPECT_TRUE(contains(notes_, "orientation") && contains(notes_, "PixelSpacing")) << notes_;

  const auto without_places = [](DicomSliceFile& file, int) { file.without(0x00200032); };
  write_series(without_places);
  const Volume numbered = read_noting();
  expect_counting(numbered, "u16");
  expect_near(world_of(numbered, 4, 3, 2), {4, 6, 16});
  EXPECT_TRUE(contains(notes_, "order of their numbers") && contains(notes_, "thickness, 8 mm"))
      << notes_;
  write_series([&](DicomSliceFile& file, int k) {
    without_places(file, k);
    file.set(0x00180088, "3.5");
  });
  EXPECT_EQ(read_noting().description().placement.spacing.z, 3.5);
  EXPECT_TRUE(contains(notes_, "SpacingBetweenSlices, 3.5 mm")) << notes_;
  write_series([&](DicomSliceFile& file, int k) {
    without_places(file, k);
    file.set(0x00200013, "1");
  });
  EXPECT_TRUE(contains(refused(), "nothing says how they lie"));
}

TEST_F(DicomTest, SeveralSeriesAreListedAndChosen) {
  write_series([](DicomSliceFile& file, int) { file.set(0x00200011, "7"); });
  write_series(
      [](DicomSliceFile& file, int k) {
        file.set(0x0020000e, "1.2.3.99").set(0x00200011, "2").set(0x0008103e, "other\nname");
        file.pixels = bytes_of(slice_values<std::uint16_t>(k + 1));
      },
      "other-");
  write("notes.txt", "hello");
  const std::vector<DicomSeries> list = list_dicom_series(folder_);
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0].uid, "1.2.3.99");
  EXPECT_EQ(list[0].description, "other?name");
  EXPECT_EQ(list[0].slices, 3);
  EXPECT_EQ(list[1].description, "by hand");
  const std::string text = refused();
  EXPECT_TRUE(contains(text, "2 DICOM series, 1: other?name (MR, 3 slices of 5 x 4), 2: by hand"))
      << text;
  ReadOptions options;
  for (const auto& [chosen, first] : std::vector<std::pair<std::string, int>>{
           {"1", 20}, {"2", 0}, {"1.2.3.99", 20}, {"99", 20}, {"1.2.3.4", 0}, {".4", 0}}) {
    options.series = chosen;
    EXPECT_EQ(value_at(read_volume(folder_, options), 0, 0, 0), first) << chosen;
  }
  for (const char* none : {"3", "0", "1.2", "", "-1", "99999999999999999999999"}) {
    options.series = none;
    EXPECT_TRUE(contains(error_of([&] { read_volume(folder_, options); }), "none of its series"))
        << none;
  }
  options.series = "2";
  EXPECT_EQ(value_at(read_volume(path("other-a"), options), 0, 0, 0), 0);
  EXPECT_EQ(value_at(read_volume(path("other-a")), 0, 0, 0), 20);
  read_noting(options);
  EXPECT_TRUE(contains(notes_, "1 file holds no DICOM image")) << notes_;
  write("a.npy", "x");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.npy"), options); }), "no DICOM"));
}

TEST_F(DicomTest, OtherSizesAndOrientationsAreOtherSeries) {
  write_series();
  DicomSliceFile scout = slice(0);
  scout.set(0x00200037, "1\\0\\0\\0\\0\\-1");
  write("scout", scout.bytes());
  EXPECT_EQ(list_dicom_series(folder_).size(), 2u);
  DicomSliceFile large = slice(0);
  large.set(0x00280010, 8).pixels.resize(80);
  write("large", large.bytes());
  EXPECT_EQ(list_dicom_series(folder_).size(), 3u);
  ReadOptions options;
  options.series = "1.2.3.4";
  EXPECT_TRUE(contains(error_of([&] { read_volume(folder_, options); }), "more than one"));
}

DicomSliceFile frames_of_one_file() {
  DicomSliceFile file;
  const test::DicomWriter w = file.writer();
  file.without(0x00200032).without(0x00200037).without(0x00280030);
  file.text[0x00280008] = {"IS", "3"};
  file.sequences[0x52009229] = {
      w.sequence(0x00209116, {w.element(0x00200037, "DS", "1\\0\\0\\0\\1\\0")}) +
      w.sequence(0x00289110, {w.element(0x00280030, "DS", "2\\1")}) +
      w.sequence(0x00289145,
                 {w.element(0x00281052, "DS", "0") + w.element(0x00281053, "DS", "1")})};
  for (const int k : {2, 0, 1}) {  // not in their order
    file.sequences[0x52009230].push_back(w.sequence(
        0x00209113, {w.element(0x00200032, "DS", "10\\20\\" + std::to_string(30 + 12 * k))}));
    file.pixels += bytes_of(slice_values<std::uint16_t>(k));
  }
  return file;
}

TEST_F(DicomTest, FramesWithPlacesAreSlices) {
  write("enhanced", frames_of_one_file().bytes());
  const Volume volume = read_noting();
  expect_counting(volume, "u16");
  expect_near(world_of(volume, 4, 3, 2), {14, 26, 54});
  EXPECT_EQ(notes_, "");
}

/// Planes of dose in one file, 12 apart from z = 30 on, at these offsets as it says.
DicomSliceFile dose_of_one_file(const std::string& offsets) {
  DicomSliceFile file;
  file.text[0x00080060] = {"CS", "RTDOSE"};
  file.text[0x00080016] = {"UI", "1.2.840.10008.5.1.4.1.1.481.2"};
  file.text[0x00280008] = {"IS", "3"};
  file.text[0x00280009] = {"AT", file.writer().tag(0x3004000c)};
  file.text[0x30040002] = {"CS", "GY"};
  file.text[0x30040004] = {"CS", "PHYSICAL"};
  file.text[0x3004000a] = {"CS", "PLAN"};
  file.text[0x3004000c] = {"DS", offsets};
  file.text[0x3004000e] = {"DS", "0.25"};
  file.set(0x00280100, 32).set(0x00280101, 32).set(0x00280102, 31);
  for (int k = 0; k < 3; ++k) file.pixels += bytes_of(slice_values<std::uint32_t>(k));
  return file;
}

TEST_F(DicomTest, ADoseStandsAtItsOffsetsInGray) {
  struct Case {
    const char *offsets, *orientation;
    std::array<double, 3> heights;  // of frames, z
  };
  const char *axial = "1\\0\\0\\0\\1\\0", *feet_first = "-1\\0\\0\\0\\1\\0",
             *prone = "-1\\0\\0\\0\\-1\\0";
  const Case cases[] = {
      {"0\\12\\24", axial, {30, 42, 54}},     {"30\\42\\54", axial, {30, 42, 54}},
      {"0\\-12\\-24", axial, {30, 18, 6}},    {"30\\18\\6", axial, {30, 18, 6}},
      {"0\\12\\24", prone, {30, 42, 54}},     {"30\\42\\54", prone, {30, 42, 54}},
      {"0\\12\\24", feet_first, {30, 18, 6}}, {"30\\42\\54", feet_first, {30, 42, 54}},
      {"0\\12\\36", axial, {30, 42, 66}},     {"30.00\\20\\6", axial, {30, 20, 6}}};
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(c.offsets) + ", " + c.orientation);
    DicomSliceFile file = dose_of_one_file(c.offsets);
    file.set(0x00200037, c.orientation);
    write("dose", file.bytes());
    const Volume volume = read_noting();
    EXPECT_EQ(type_name(volume.data()), "f64");
    ASSERT_EQ(volume.description().dimensions, (std::array<int, 3>{5, 4, 3}));
    EXPECT_TRUE(contains(notes_, "radiation dose in Gy, DoseSummationType PLAN")) << notes_;
    for (int index = 0; index < 3; ++index) {
      const int frame = static_cast<int>(value_at(volume, 0, 0, index) / 0.25) / 20;
      EXPECT_EQ(value_at(volume, 4, 3, index), 0.25 * (20 * frame + 19));
      const auto& coordinates = volume.description().coordinates[2];
      const Vec3<double> place = coordinates.empty()
                                     ? world_of(volume, 0, 0, index)
                                     : volume.description().placement.origin +
                                           volume.description().placement.direction.column[2] *
                                               coordinates[static_cast<std::size_t>(index)];
      expect_near(place, {10, 20, c.heights[static_cast<std::size_t>(frame)]});
    }
  }
  EXPECT_EQ(dicom_unit(folder_), "Gy");
}

TEST_F(DicomTest, DosesOfOtherKinds) {
  const auto noted = [&](const auto& change) {
    DicomSliceFile file = dose_of_one_file("0\\12\\24");
    change(file);
    write("dose", file.bytes());
    read_noting();
    return notes_;
  };
  const std::string relative = noted([](auto& f) { f.text[0x30040002].second = "RELATIVE"; });
  EXPECT_TRUE(contains(relative, "relative to a reference")) << relative;
  EXPECT_EQ(dicom_unit(folder_), "relative");
  const std::string unscaled = noted([](auto& f) { f.without(0x3004000e); });
  EXPECT_TRUE(contains(unscaled, "without DoseGridScaling")) << unscaled;
  EXPECT_EQ(dicom_unit(folder_), "");
  const std::string elsewhere = noted([](auto& f) { f.text[0x3004000c].second = "5\\17\\29"; });
  EXPECT_TRUE(contains(elsewhere, "begins with 5, neither with 0")) << elsewhere;
  expect_near(world_of(read_volume(folder_), 4, 3, 2), {14, 26, 54});
  noted([](auto& f) {
    f.set(0x00280100, 16).set(0x00280101, 16).set(0x00280102, 15);
    f.pixels.clear();
    for (int k = 0; k < 3; ++k) f.pixels += bytes_of(slice_values<std::uint16_t>(k));
  });
  EXPECT_EQ(type_name(read_volume(folder_).data()), "f32");
  EXPECT_EQ(value_at(read_volume(folder_), 4, 3, 2), 59 * 0.25);

  const auto refuse = [&](const auto& change) {
    DicomSliceFile file = dose_of_one_file("0\\12\\24");
    change(file);
    write("dose", file.bytes());
    return refused();
  };
  const std::string short_vector = refuse([](auto& f) { f.text[0x3004000c].second = "0\\12"; });
  EXPECT_TRUE(contains(short_vector, "has 2 numbers, but there are 3 frames")) << short_vector;
  EXPECT_TRUE(
      contains(refuse([](auto& f) { f.text[0x3004000c].second = "0\\x\\24"; }), "no number"));
  EXPECT_TRUE(
      contains(refuse([](auto& f) { f.text[0x3004000c].second = "0\\12\\12"; }), "same place"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.text[0x3004000e].second = "1,5"; }),
                       "DoseGridScaling (3004,000E) is \"1,5\""));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.without(0x3004000c); }), "no GridFrameOffsetVector"));
  const std::string single = refuse([](auto& f) {
    f.text[0x00280008].second = "1";
    f.text[0x3004000c].second = "0";
  });
  EXPECT_TRUE(contains(single, "a single plane of dose, and a volume needs two")) << single;
}

TEST_F(DicomTest, FramesAtOffsetsOfOtherVectors) {
  const auto frames = [] {
    DicomSliceFile file;
    file.text[0x00280008] = {"IS", "3"};
    for (int k = 0; k < 3; ++k) file.pixels += bytes_of(slice_values<std::uint16_t>(k));
    return file;
  };
  const auto reads = [&](const DicomSliceFile& file, double last) {
    write("frames", file.bytes());
    const Volume volume = read_noting();
    const int top = last > 30 ? 2 : 0;
    EXPECT_EQ(value_at(volume, 4, 3, top), 59);
    expect_near(world_of(volume, 4, 3, top), {14, 26, last});
  };
  const test::DicomWriter w;
  DicomSliceFile locations = frames();
  locations.text[0x00182005] = {"DS", "7\\19\\31"};
  reads(locations, 54);
  locations.text[0x00280009] = {"AT", w.tag(0x00182005)};
  reads(locations, 54);

  // Nuclear medicine: the place is that of a detector, distances may be negative.
  DicomSliceFile tomography = frames();
  tomography.without(0x00200032).without(0x00200037);
  tomography.sequences[0x00540022] = {w.element(0x00200032, "DS", "10\\20\\30") +
                                      w.element(0x00200037, "DS", "1\\0\\0\\0\\1\\0")};
  tomography.text[0x00280009] = {"AT", w.tag(0x00540010) + w.tag(0x00540080)};
  tomography.text[0x00540010] = {"US", w.number(1, 2) + w.number(1, 2) + w.number(1, 2)};
  tomography.text[0x00540080] = {"US", w.number(1, 2) + w.number(2, 2) + w.number(3, 2)};
  tomography.set(0x00180088, "12");
  reads(tomography, 54);
  EXPECT_EQ(notes_, "");
  tomography.set(0x00180088, "-12");
  reads(tomography, 6);
  tomography.without(0x00180088).set(0x00180050, "4");
  reads(tomography, 38);
  EXPECT_TRUE(contains(notes_, "thickness, 4 mm")) << notes_;
  tomography.text[0x00540010].second = w.number(1, 2) + w.number(2, 2) + w.number(2, 2);
  write("frames", tomography.bytes());
  EXPECT_TRUE(contains(refused(), "are of 2 energy windows")) << refused();

  DicomSliceFile even = frames();
  even.set(0x00180088, "12");
  reads(even, 54);
  EXPECT_TRUE(contains(notes_, "SpacingBetweenSlices apart, 12 mm")) << notes_;
  even.text[0x00181063] = {"DS", "33"};
  even.text[0x00280009] = {"AT", w.tag(0x00181063)};
  write("frames", even.bytes());
  EXPECT_TRUE(contains(refused(), "a film")) << refused();
}

TEST_F(DicomTest, OtherKindsAreRefusedByName) {
  const auto refuse = [&](const auto& change) {
    write_series([&](DicomSliceFile& file, int) { change(file); });
    return refused();
  };
  EXPECT_TRUE(contains(refuse([](auto& f) {
                         f.text[0x00280008] = {"IS", "3"};
                       }),
                       "3 frames have no positions"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.set(0x00280004, "PALETTE COLOR"); }), "palette"));
  EXPECT_TRUE(
      contains(refuse([](auto& f) { f.set(0x00280004, "YBR_FULL_422").set(0x00280002, 3); }),
               "YBR_FULL_422"));
  EXPECT_TRUE(contains(refuse([](auto& f) {
                         f.text[0x00080008] = {"CS", "ORIGINAL\\PRIMARY\\M\\MOSAIC"};
                       }),
                       "mosaic"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.set(0x00280100, 1); }), "1 bits"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.set(0x00280100, 12); }), "12 bits"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.set(0x00280101, 17); }), "17 bits end at bit 11"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.set(0x00280102, 16); }), "end at bit 16"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.set(0x00280010, 0); }), "5 x 0 pixels"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.sequences[0x00283000] = {""}; }), "lookup table"));
  DicomSliceFile frames = frames_of_one_file();
  frames.sequences[0x52009230].pop_back();
  for (const char* name : {"a", "b.txt", "c"}) std::filesystem::remove(path(name));
  write("frames", frames.bytes());
  EXPECT_TRUE(contains(refused(), "3 frames, but places for 2"));
}

TEST_F(DicomTest, EmptyFoldersAndFilesWithoutPixels) {
  EXPECT_FALSE(is_dicom(folder_));
  EXPECT_TRUE(contains(refused(), "no DICOM file"));
  DicomSliceFile report = slice(0);
  const std::string bytes = report.bytes();
  write("report", bytes.substr(0, bytes.size() - 12 - report.pixels.size()));
  EXPECT_TRUE(is_dicom(folder_));
  EXPECT_TRUE(contains(refused(), "no DICOM file with pixels"));
}

TEST_F(DicomTest, EveryTruncatedFileIsLeftOut) {
  write_series();
  const std::string whole = slice(1).bytes();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write("a", whole.substr(0, length));
    const Volume rest = read_noting();
    EXPECT_EQ(rest.description().dimensions[2], 2) << length;
    EXPECT_EQ(value_at(rest, 4, 3, 1), 59) << length;
    EXPECT_EQ(std::ranges::count(notes_, '\n'), 1) << notes_;
    // Cut between two elements, or in the first bytes, nothing is wrong with what is left.
    const bool told = contains(notes_, "1 file is left out: " + path("a").string()) ||
                      contains(notes_, "1 file holds no DICOM image and is left out");
    EXPECT_TRUE(told) << length << ": " << notes_;
    EXPECT_FALSE(error_of([&] { read_volume(path("a")); }).empty()) << length;
  }
}

TEST_F(DicomTest, DamagedFilesAreLeftOutCountedAndNamed) {
  write_series();
  for (int k = 3; k < 9; ++k) write("more" + std::to_string(k), slice(k).bytes());
  write("more4", slice(4).bytes().substr(0, 200));
  write("more6", slice(6).bytes().substr(0, slice(6).bytes().size() - 1));
  write("more7", std::string(128, '\0') + "DICM" + std::string(300, '\x7f'));
  const Volume volume = read_noting();
  EXPECT_EQ(volume.description().coordinates[2], (std::vector<double>{0, 12, 24, 36, 60, 96}));
  EXPECT_TRUE(contains(notes_, "3 files are left out; the first: " + path("more4").string()))
      << notes_;
  EXPECT_TRUE(contains(notes_, "a file that is left out may belong there")) << notes_;
  EXPECT_EQ(list_dicom_series(folder_).size(), 1u);
  std::string told;
  list_dicom_series(folder_, [&](const std::string& note) { told += note; });
  EXPECT_TRUE(contains(told, "3 files are left out")) << told;

  // With a file of the series asked for by name.
  EXPECT_EQ(read_volume(path("more3")).description().dimensions[2], 6);
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("more6")); }), "has 39 bytes of pixels"));
  // With nothing but damaged files.
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    write(entry.path().filename().string(), slice(0).bytes().substr(0, 200));
  }
  EXPECT_TRUE(contains(refused(), "no DICOM file with pixels that can be read; 9 files"))
      << refused();
}

TEST_F(DicomTest, OtherFilesOfTheFolderAreLeftOut) {
  write_series();
  write("empty.dcm", "");
  write("notes.txt", "hello");
  write("picture.jpg", "\xff\xd8\xff\xe0 JFIF");
  write("zeros", std::string(4096, '\0'));
  std::string noise;
  for (unsigned i = 0; i < 4096; ++i) noise += static_cast<char>((i * 2654435761U) >> 13);
  write("noise", noise);
  DicomSliceFile directory = slice(0);  // without pixels, as a DICOMDIR
  const std::string bytes = directory.bytes();
  write("DICOMDIR", bytes.substr(0, bytes.size() - 12 - directory.pixels.size()));
  expect_counting(read_noting(), "u16");
  EXPECT_TRUE(contains(notes_, "5 files hold no DICOM image and are left out")) << notes_;
  EXPECT_TRUE(contains(notes_, "1 file is left out: " + path("empty.dcm").string() + ": is empty"))
      << notes_;
  write("noise.DCM", noise);
  read_noting();
  EXPECT_TRUE(contains(notes_, "2 files are left out; the first: ")) << notes_;
}

TEST_F(DicomTest, HostileLengthsAreRefused) {
  const test::DicomWriter w;
  const std::string start =
      std::string(128, '\0') + "DICM" + w.element(0x00020010, "UI", "1.2.840.10008.1.2.1");
  const auto refuse = [&](const std::string& bytes) {
    write("a", start + bytes);
    return error_of([&] { read_volume(path("a")); });
  };
  EXPECT_TRUE(contains(refuse(w.element(0x00091010, "OB", "abcd", 0xfffffff0)), "more than there"));
  EXPECT_TRUE(contains(refuse(w.element(0x00091010, "SQ", "abcd", 0x7ffffff0)), "more than there"));
  EXPECT_TRUE(contains(
      refuse(w.element(0x00091010, "OB", std::string("abcd\0\0\0\0", 8), 0xffffffff)), "no type"));
  EXPECT_TRUE(contains(refuse(w.tag(0x00091010) + "1?" + w.number(9, 2)), "no type"));
  std::string nested;
  for (int i = 0; i < 100; ++i) {
    nested +=
        w.element(0x00091010, "SQ", "", 0xffffffff) + w.tag(0xfffee000) + w.number(0xffffffff, 4);
  }
  EXPECT_TRUE(contains(refuse(nested), "too deep"));
  DicomSliceFile huge = slice(0);
  huge.set(0x00280010, 65535).set(0x00280011, 65535);
  write("a", huge.bytes());
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a")); }), "cut off"));
}

#ifdef PELLUCID_HAVE_GDCM
TEST_F(DicomTest, RunLengthsAreDecodedByGdcm) {
  const auto compress = [](DicomSliceFile& file, int k) {
    file.syntax = "1.2.840.10008.1.2.5";
    file.encapsulated = true;
    file.pixels = test::fragments({test::run_length_encoded(slice_values<std::uint16_t>(k))});
  };
  ::testing::internal::CaptureStderr();
  write_series(compress);
  expect_counting(read_volume(folder_), "u16");
  write_series([&](DicomSliceFile& file, int k) {
    compress(file, k);
    file.set(0x00281052, "-10").set(0x00281053, "1");
  });
  EXPECT_EQ(value_at(read_volume(folder_), 4, 3, 2), 49);
  // Less than it should hold.
  write_series([&](DicomSliceFile& file, int k) {
    compress(file, k);
    file.pixels =
        test::fragments({test::run_length_encoded(std::vector<std::uint16_t>(k == 1 ? 9 : 20, 1))});
  });
  EXPECT_EQ(read_noting().description().dimensions[2], 2);
  EXPECT_TRUE(
      contains(notes_, "1 file is left out: " + path("a").string() + ": GDCM cannot decompress"))
      << notes_;
  EXPECT_EQ(std::ranges::count(notes_, '\n'), 1) << notes_;
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a")); }), "GDCM cannot decompress"));
  write_series([&](DicomSliceFile& file, int k) {
    compress(file, k);
    file.pixels = test::fragments({test::run_length_encoded(std::vector<std::uint16_t>(9, 1))});
  });
  EXPECT_TRUE(contains(refused(), "3 files are left out; the first: ")) << refused();
  // Cut off within a fragment.
  write_series(compress);
  const std::string cut = read(path("b.txt"));
  write("b.txt", cut.substr(0, cut.size() - 20));
  EXPECT_EQ(read_noting().description().dimensions[2], 2);
  EXPECT_TRUE(contains(notes_, "(FFFE,E000)")) << notes_;
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// Compressed by GDCM, as other programs do it: what reads them is another part of it. Its encoder
// of JPEG 2000 writes beyond its buffer for images of 5 × 4.
TEST_F(DicomTest, JpegIsDecodedByGdcm) {
  constexpr int columns = 64, rows = 48, slices = 3;
  const auto value = [](int x, int y, int z) { return 2 * x + y + 20 * z; };
  const auto write_slices = [&]<class Value>(Value) {
    write_series([&](DicomSliceFile& file, int k) {
      constexpr int bits = 8 * sizeof(Value);
      file.set(0x00280010, rows).set(0x00280011, columns);
      file.set(0x00280100, bits).set(0x00280101, bits).set(0x00280102, bits - 1);
      std::vector<Value> values;
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) values.push_back(static_cast<Value>(value(x, y, k)));
      }
      file.pixels = bytes_of(values);
    });
  };
  const auto compress = [&](gdcm::TransferSyntax::TSType syntax) {
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
      gdcm::ImageReader reader;
      reader.SetFileName(entry.path().c_str());
      ASSERT_TRUE(reader.Read());
      gdcm::ImageChangeTransferSyntax change;
      change.SetTransferSyntax(syntax);
      change.SetInput(reader.GetImage());
      ASSERT_TRUE(change.Change());
      gdcm::ImageWriter writer;
      writer.SetFile(reader.GetFile());
      writer.SetImage(change.GetOutput());
      writer.SetFileName(entry.path().c_str());
      ASSERT_TRUE(writer.Write());
      EXPECT_TRUE(contains(read(entry.path()), gdcm::TransferSyntax::GetTSString(syntax)));
    }
  };
  const auto expect_values = [&](const std::string& type, double tolerance) {
    const Volume volume = read_volume(folder_);
    EXPECT_EQ(type_name(volume.data()), type);
    ASSERT_EQ(volume.description().dimensions, (std::array<int, 3>{columns, rows, slices}));
    for (int i = 0; i < columns * rows * slices; ++i) {
      const int x = i % columns, y = i / columns % rows, z = i / columns / rows;
      ASSERT_NEAR(value_at(volume, x, y, z), value(x, y, z), tolerance) << i;
    }
  };
  using gdcm::TransferSyntax;
  for (const auto syntax :
       {TransferSyntax::JPEGLosslessProcess14, TransferSyntax::JPEGLosslessProcess14_1,
        TransferSyntax::JPEGLSLossless, TransferSyntax::JPEG2000Lossless}) {
    SCOPED_TRACE(TransferSyntax::GetTSString(syntax));
    write_slices(std::uint16_t{});
    compress(syntax);
    expect_values("u16", 0);
  }
  write_slices(std::uint8_t{});
  compress(TransferSyntax::JPEGBaselineProcess1);
  expect_values("u8", 6);
}
#endif

}  // namespace
}  // namespace pellucid::test_dicom
