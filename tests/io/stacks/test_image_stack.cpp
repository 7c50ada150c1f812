// SPDX-License-Identifier: Apache-2.0
#include <sys/time.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/image_files.h"

namespace pellucid::test_image_stack {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::counting_page;
using test::error_of;
using test::expect_counting;
using test::page_values;
using test::tiff;
using test::TiffFile;
using test::TiffPage;
using test::value_at;

class StackTest : public test::ScratchFolder {
 protected:
  static TiffPage page(int k, bool big_endian = false) {
    return counting_page<std::uint16_t>(k, 1, big_endian);
  }
  // slice09.tif, slice10.tif and slice11.tif.
  void write_numbered(const std::string& before = "slice") {
    for (int k = 0; k < 3; ++k) {
      const std::string number = std::to_string(k + 9);
      write(before + std::string(2 - number.size(), '0') + number + ".tif", tiff(page(k)));
    }
  }
  template <class Change>
  fs::path write_pages(const Change& change, const std::string& name = "pages.tif") {
    TiffFile file(false);
    for (int k = 0; k < 3; ++k) {
      TiffPage one = page(k);
      change(one, k);
      file.add(one);
    }
    return write(name, file.bytes());
  }
  template <class Value>
  void expect_type(std::uint32_t sample_format, const std::string& type) {
    SCOPED_TRACE(type);
    for (const bool big_endian : {false, true}) {
      TiffFile file(big_endian);
      for (int k = 0; k < 3; ++k) file.add(counting_page<Value>(k, sample_format, big_endian));
      expect_counting(read_volume(write("t.tif", file.bytes())), type);
    }
  }
  Volume read_noting(const fs::path& path, const ReadOptions& given = {}) {
    ReadOptions options = given;
    notes_.clear();
    options.note = [this](const std::string& text) { notes_ += text + "\n"; };
    return read_volume(path, options);
  }
  std::string refused(const fs::path& file) {
    return error_of([&] { read_volume(file); });
  }

  std::string notes_;
};

TEST_F(StackTest, AllTypesInBothByteOrders) {
  expect_type<std::uint8_t>(1, "u8");
  expect_type<std::int8_t>(2, "i8");
  expect_type<std::uint16_t>(1, "u16");
  expect_type<std::int16_t>(2, "i16");
  expect_type<std::uint32_t>(1, "u32");
  expect_type<std::int32_t>(2, "i32");
  expect_type<float>(3, "f32");
  expect_type<double>(3, "f64");
}

TEST_F(StackTest, NumberedFiles) {
  write_numbered();
  for (const fs::path& given :
       {path("slice09.tif"), path("slice10.tif"), path("slice%02d.tif"), folder_}) {
    SCOPED_TRACE(given.string());
    const Volume volume = read_noting(given);
    expect_counting(volume, "u16");
    EXPECT_TRUE(contains(notes_, "say nothing of distances; the spacing is 1")) << notes_;
  }
  ReadOptions options;
  options.spacing = Vec3<double>{1, 2, 3};
  EXPECT_EQ(read_noting(folder_, options).description().placement.spacing, (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(notes_, "");
  EXPECT_TRUE(contains(refused(path("slice%03d.tif")), "no file has a name"));
}

// 9 stands before 10 whatever the letters say.
TEST_F(StackTest, NumbersNeedNoZeros) {
  for (int k = 0; k < 3; ++k) write("a" + std::to_string(k + 9) + "b.tif", tiff(page(k)));
  expect_counting(read_volume(folder_), "u16");
  expect_counting(read_volume(path("a%db.tif")), "u16");
  expect_counting(read_volume(path("a11b.tif")), "u16");
  EXPECT_TRUE(contains(refused(path("a%03db.tif")), "no file has a name"));
  // A number that is filled up is not what %d writes.
  write("a09b.tif", tiff(page(0)));
  expect_counting(read_volume(path("a%db.tif")), "u16");
  EXPECT_TRUE(contains(refused(folder_), "have the same number"));
}

TEST_F(StackTest, AMissingNumberIsNamed) {
  for (const int k : {0, 1, 2, 4}) {
    write("s" + std::to_string(k) + ".tif", tiff(page(k % 3)));
  }
  const std::string text = refused(folder_);
  EXPECT_TRUE(contains(text, "by 2 from s2.tif to s4.tif, but elsewhere by 1")) << text;
  fs::remove(path("s1.tif"));
  EXPECT_EQ(read_volume(folder_).description().dimensions[2], 3);  // every second one
}

TEST_F(StackTest, OtherFilesInTheFolder) {
  write_numbered();
  write("readme.txt", "hello");
  read_noting(folder_);
  EXPECT_TRUE(contains(notes_, "1 file is no image")) << notes_;
  write("mask09.tif", tiff(page(0)));
  EXPECT_TRUE(contains(refused(folder_), "differ by more than a number"));
  expect_counting(read_volume(path("slice09.tif")), "u16");
}

TEST_F(StackTest, AnOddOneIsNamed) {
  write_numbered();
  write("slice10.tif", tiff(counting_page<std::uint8_t>(1, 1)));
  EXPECT_TRUE(contains(refused(folder_),
                       "slice10.tif is 5 x 4 of u8, but the first is 5 x 4 of "
                       "u16"));
  const fs::path pages = write_pages([](TiffPage& p, int k) {
    if (k == 2) p.fields[256] = {4};
  });
  EXPECT_TRUE(contains(refused(pages), "page 3 is 4 x 4 of u16"));
  write("slice10.tif", read(write_pages([](TiffPage&, int) {})));
  fs::remove(pages);
  EXPECT_TRUE(contains(refused(folder_), "slice10.tif has several pages"));
}

TEST_F(StackTest, ASingleImageIsNoVolume) {
  write("one.tif", tiff(page(0)));
  EXPECT_TRUE(contains(refused(path("one.tif")), "5 x 4 x 1"));
  ReadOptions options;
  options.centering = Centering::cell;
  EXPECT_EQ(read_volume(path("one.tif"), options).description().dimensions[2], 1);
}

TEST_F(StackTest, StripsTilesAndCompression) {
  // Three rows and one.
  expect_counting(read_volume(write_pages([](TiffPage& p, int) {
                    p.fields[278] = {3};
                    p.strips = {p.strips[0].substr(0, 30), p.strips[0].substr(30)};
                  })),
                  "u16");
  // zlib (8), and with differences from value to value (predictor 2).
  expect_counting(read_volume(write_pages([](TiffPage& p, int) {
                    p.fields[259] = {8};
                    p.strips = {test::deflated(p.strips[0], 15)};
                  })),
                  "u16");
  expect_counting(read_volume(write_pages([](TiffPage& p, int k) {
                    p.fields[259] = {8};
                    p.fields[317] = {2};
                    std::vector<std::uint16_t> steps(20, 1);
                    for (std::size_t row = 0; row < 4; ++row) {
                      steps[5 * row] =
                          static_cast<std::uint16_t>(20 * k + 5 * static_cast<int>(row));
                    }
                    p.strips = {test::deflated(test::bytes_of(steps), 15)};
                  })),
                  "u16");
  // Tiles of 16 × 16 that hang over.
  expect_counting(read_volume(write_pages([](TiffPage& p, int) {
                    p.tiled = true;
                    p.fields.erase(278);
                    p.fields[322] = p.fields[323] = {16};
                    std::string tile(512, '\x7f');
                    for (std::size_t row = 0; row < 4; ++row) {
                      tile.replace(32 * row, 10, p.strips[0], 10 * row, 10);
                    }
                    p.strips = {tile};
                  })),
                  "u16");
}

TEST_F(StackTest, ColorsAreComponents) {
  for (const bool planes : {false, true}) {
    const fs::path file = write_pages([&](TiffPage& p, int k) {
      p.fields[258] = {8, 8, 8};
      p.fields[262] = {2};
      p.fields[277] = {3};
      p.fields[284] = {planes ? 2U : 1U};
      std::string values;
      for (int i = 0; i < 60; ++i) {
        const int pixel = planes ? i % 20 : i / 3, sample = planes ? i / 20 : i % 3;
        values += static_cast<char>(20 * k + pixel + 60 * sample);
      }
      p.strips = {values};
      if (planes) p.strips = {values.substr(0, 20), values.substr(20, 20), values.substr(40)};
    });
    const std::vector<Volume> colors = read_components(file);
    ASSERT_EQ(colors.size(), 3u);
    for (int c = 0; c < 3; ++c) {
      for (int i = 0; i < 60; ++i) {
        ASSERT_EQ(value_at(colors[static_cast<std::size_t>(c)], i % 5, i / 5 % 4, i / 20),
                  i + 60 * c);
      }
    }
    ReadOptions options;
    options.component = 2;
    EXPECT_EQ(value_at(read_volume(file, options), 0, 0, 0), 120);
    EXPECT_TRUE(contains(refused(file), "colors (RGB)"));
  }
}

TEST_F(StackTest, SpacingIsTheFilesWhereItStatesAUnit) {
  const auto spacing = [&](std::uint32_t unit, double x, double y, const std::string& text = "") {
    return read_noting(write_pages([&](TiffPage& p, int) {
             p.fields[296] = {unit};
             p.rationals = {{282, x}, {283, y}};
             p.description = text;
           }))
        .description()
        .placement.spacing;
  };
  test::expect_near(spacing(3, 20, 40), {0.5, 0.25, 1});
  EXPECT_TRUE(contains(notes_, "spacing of pixels is the file's, in mm; the other is 1")) << notes_;
  test::expect_near(spacing(2, 254, 254), {0.1, 0.1, 1});
  test::expect_near(spacing(1, 20, 40), {1, 1, 1});
  test::expect_near(spacing(2, 72, 72), {1, 1, 1});  // of a screen
  test::expect_near(spacing(3, 0, 0), {1, 1, 1});
  test::expect_near(spacing(1, 4, 2, "ImageJ=1.53\nimages=3\nslices=3\nunit=micron\nspacing=3.0\n"),
                    {0.25, 0.5, 3});
  EXPECT_TRUE(contains(notes_, "pixels and slices is the file's, in micron")) << notes_;
  test::expect_near(spacing(1, 4, 2, "ImageJ=1.53\nimages=3\nslices=3\n"), {1, 1, 1});
}

// What is behind a strip belongs to another.
TEST_F(StackTest, StripsShorterThanTheirPixels) {
  for (const bool several : {false, true}) {
    const fs::path file = write_pages([&](TiffPage& one, int) {
      if (several) {
        one.fields[278] = {2};
        one.strips = {one.strips[0].substr(0, 10), one.strips[0].substr(20)};
      } else {
        one.strips[0].resize(10);
      }
    });
    EXPECT_TRUE(contains(refused(file), "other lengths than their pixels")) << refused(file);
  }
}

TEST_F(StackTest, PagesInACircle) {
  TiffFile file(false);
  for (int k = 0; k < 3; ++k) file.add(page(k));
  std::string bytes = file.bytes();
  const std::string first = bytes.substr(4, 4);
  bytes.replace(bytes.size() - 4, 4, first);
  write("c.tif", bytes);
  fs::resize_file(path("c.tif"), std::uintmax_t{1} << 32);
  // Seconds of a processor, not of a clock.
  const itimerval limit{{0, 0}, {20, 0}}, none{};
  setitimer(ITIMER_PROF, &limit, nullptr);
  EXPECT_TRUE(contains(refused(path("c.tif")), "in a circle"));
  setitimer(ITIMER_PROF, &none, nullptr);
}

TEST_F(StackTest, Png) {
  const auto write_png = [&](const auto& make) {
    for (int k = 0; k < 3; ++k) write("p" + std::to_string(k) + ".png", make(k));
  };
  write_png([](int k) { return test::png(5, 4, 8, 0, page_values<std::uint8_t>(k)); });
  expect_counting(read_volume(folder_), "u8");
  write_png([](int k) { return test::png(5, 4, 16, 0, page_values<std::uint16_t>(k, true)); });
  expect_counting(read_volume(path("p1.png")), "u16");
  write_png([](int k) {
    std::string values;
    for (int i = 0; i < 80; ++i) values += static_cast<char>(20 * k + i / 4 + 60 * (i % 4));
    return test::png(5, 4, 8, 6, values);
  });
  const std::vector<Volume> colors = read_components(path("p%d.png"));
  ASSERT_EQ(colors.size(), 4u);
  for (int c = 0; c < 4; ++c) {
    EXPECT_EQ(value_at(colors[static_cast<std::size_t>(c)], 4, 3, 2), (59 + 60 * c) % 256);
  }
  const auto refuse = [&](const std::string& bytes) {
    write("p0.png", bytes);
    return refused(path("p0.png"));
  };
  const std::string values = page_values<std::uint8_t>(0);
  EXPECT_TRUE(contains(refuse(test::png(5, 4, 8, 3, values)), "palette"));
  EXPECT_TRUE(contains(refuse(test::png(8, 4, 1, 0, "abcd")), "1 bits"));
  EXPECT_TRUE(contains(refuse(test::png(0, 4, 8, 0, "")), "0 x 4"));
  EXPECT_TRUE(contains(refuse("PNG"), "does not begin"));
  for (const char* name : {"p1.png", "p2.png"}) fs::remove(path(name));
  write("p1.png", test::png(5, 4, 8, 0, values));
  const std::string whole = test::png(5, 4, 8, 0, values);
  for (std::size_t length = 0; length < whole.size() - 4; ++length) {
    EXPECT_FALSE(refuse(whole.substr(0, length)).empty()) << length;
  }
  EXPECT_FALSE(refuse(test::png(2000000000, 2000000000, 8, 0, values)).empty());
}

TEST_F(StackTest, OtherKindsAreRefusedByName) {
  const auto refuse = [&](const auto& change) {
    return refused(write_pages([&](TiffPage& p, int) { change(p.fields); }));
  };
  EXPECT_TRUE(contains(refuse([](auto& f) {
                         f[258] = {8};
                         f[262] = {3};
                         f[320] = std::vector<std::uint32_t>(768, 7);
                       }),
                       "palette"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f[262] = {5}; }), "interpretation 5"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f[258] = {12}; }), "12 bits"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f[339] = {3}; }), "16 bits of floating point"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f[258] = {64}; }), "64 bits"));
}

TEST_F(StackTest, EveryTruncationIsAnError) {
  const std::string whole = read(write_pages([](TiffPage&, int) {}));
  ::testing::internal::CaptureStderr();
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write("cut.tif", whole.substr(0, length));
    EXPECT_FALSE(refused(path("cut.tif")).empty()) << length;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(StackTest, HugeSizesAreRefused) {
  for (const std::uint32_t rows : {0x7fffffffU, 0xffffffffU, 65535U, 0U}) {
    EXPECT_FALSE(refused(write_pages([&](TiffPage& p, int) {
                   p.fields[256] = p.fields[257] = {rows};
                   p.fields[278] = {1};
                 })).empty());
  }
}

}  // namespace
}  // namespace pellucid::test_image_stack
