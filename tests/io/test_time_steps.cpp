// SPDX-License-Identifier: Apache-2.0

// Times of volumes: which there are, and which is read.

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "image_files.h"
#include "pellucid/io/read_volume.h"
#include "tests/io/arrays/net_cdf_files.h"
#include "tests/io/arrays/zarr_files.h"

namespace pellucid::test_time_steps {
namespace {

namespace fs = std::filesystem;

using test::bytes_of;
using test::contains;
using test::described_tiff;
using test::error_of;

class TimeSteps : public test::ScratchFolder {
 protected:
  std::string notes_of(const fs::path& file, ReadOptions options = {}) {
    std::string notes;
    options.note = [&](const std::string& text) { notes += text + "\n"; };
    read_components(file, options);
    return notes;
  }
  std::string notes_at(const fs::path& file, double time) {
    ReadOptions options;
    options.time = time;
    return notes_of(file, options);
  }
  void expect_times(const fs::path& file, const std::string& list) {
    const std::string notes = notes_of(file);
    EXPECT_TRUE(contains(notes, list + "); --time chooses one")) << notes;
  }
  void expect_step(const fs::path& file, double time, const std::string& text) {
    const std::string notes = notes_at(file, time);
    EXPECT_TRUE(contains(notes, text + "\n")) << notes;
    EXPECT_FALSE(contains(notes, "chooses one")) << notes;
  }
};

TEST_F(TimeSteps, Tiff) {
  const auto file = write(
      "a.tif", described_tiff(6, "ImageJ=1.53t\nimages=6\nslices=2\nframes=3\nfinterval=2.5\n"));
  expect_times(file, "3 times (0, 2.5, 5");
  expect_step(file, 2.5, "step 2 of 3 is read, time 2.5");
  expect_step(file, 4, "step 3 of 3 is read, time 5 (nearest to 4)");
  const auto movie = write("m.tif", described_tiff(3, "ImageJ=1.53t\nimages=3\nframes=3\n"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(movie); }), "is a movie, 3 times of a single"));
  EXPECT_TRUE(contains(error_of([&] { notes_at(movie, 1); }), "is a movie, 3 times of a single"));
  ReadOptions options;
  options.centering = Centering::cell;
  options.time = 1;
  EXPECT_TRUE(contains(notes_of(movie, options), "step 2 of 3 is read, time 1"));
}

TEST_F(TimeSteps, MoviesOfSinglePlanes) {
  const auto expect_movie = [&](const fs::path& file) {
    EXPECT_TRUE(contains(error_of([&] { read_volume(file); }), "is a movie, 3 times of a single"));
    ReadOptions options;
    options.time = 1;
    EXPECT_TRUE(contains(error_of([&] { read_volume(file, options); }), "is a movie"));
    options.centering = Centering::cell;
    EXPECT_EQ(read_volume(file, options).description().dimensions[2], 1);
  };
  test::ZarrStore store;
  store.shape = store.chunk = {3, 1, 2, 2};
  store.write_2(path("a.zarr/v"), bytes_of(std::vector<float>(12, 1)), 4);
  std::ofstream(path("a.zarr/.zgroup")) << "{\"zarr_format\": 2}";
  std::ofstream(path("a.zarr/v/.zattrs")) << R"({"_ARRAY_DIMENSIONS": ["time", "z", "y", "x"]})";
  expect_movie(path("a.zarr"));
#ifdef PELLUCID_HAVE_NETCDF
  test::ClassicFile classic;
  classic.axes = {{"time", 3}, {"z", 1}, {"y", 2}, {"x", 2}};
  classic.variables = {{"v", 'f', {"time", "z", "y", "x"}, std::vector<double>(12, 1)}};
  expect_movie(write("a.nc", classic.bytes()));
#endif
}

#ifdef PELLUCID_HAVE_NETCDF
TEST_F(TimeSteps, NetCdf) {
  test::ClassicFile classic;
  classic.axes = {{"time", 3}, {"z", 2}, {"y", 2}, {"x", 2}};
  classic.variables = {{"v", 'f', {"time", "z", "y", "x"}, std::vector<double>(24, 1)},
                       {"time", 'd', {"time"}, {0, 6, 18}}};
  const auto file = write("a.nc", classic.bytes());
  expect_times(file, "\"v\" holds 3 times (0, 6, 18");
  expect_step(file, 6, "step 2 of 3 is read, time 6");
  expect_step(file, 13, "step 3 of 3 is read, time 18 (nearest to 13)");
}
#endif

TEST_F(TimeSteps, Zarr) {
  test::ZarrStore store;
  store.shape = store.chunk = {14, 2, 2, 2};
  store.write_2(path("a.zarr/v"), bytes_of(std::vector<float>(112, 1)), 4);
  store.shape = store.chunk = {14};
  std::vector<float> hours(14);
  for (std::size_t i = 0; i < hours.size(); ++i) hours[i] = static_cast<float>(3 * i);
  store.write_2(path("a.zarr/time"), bytes_of(hours), 4);
  std::ofstream(path("a.zarr/.zgroup")) << "{\"zarr_format\": 2}";
  std::ofstream(path("a.zarr/time/.zattrs")) << R"({"_ARRAY_DIMENSIONS": ["time"]})";
  std::ofstream(path("a.zarr/v/.zattrs")) << R"({"_ARRAY_DIMENSIONS": ["time", "z", "y", "x"]})";
  expect_times(path("a.zarr"), "14 times (0, 3, 6, 9, 12, 15, 18, 21, 24, 27, ..., 39");
  expect_step(path("a.zarr"), 7, "step 3 of 14 is read, time 6 (nearest to 7)");
  expect_step(path("a.zarr"), 100, "step 14 of 14 is read, time 39 (nearest to 100)");
}

TEST_F(TimeSteps, AnErrorIsTheOneLine) {
  const auto file =
      write("a.tif", described_tiff(6, "ImageJ=1.53t\nimages=6\nslices=2\nframes=3\nparrot=1\n"));
  std::string notes;
  ReadOptions options;
  options.note = [&](const std::string& text) { notes += text + "\n"; };
  EXPECT_TRUE(contains(error_of([&] { read_volume(file, options); }), "holds 3 times"));
  EXPECT_EQ(notes, "");
  options.time = 1;
  read_volume(file, options);
  EXPECT_TRUE(contains(notes, "parrot")) << notes;
}

}  // namespace
}  // namespace pellucid::test_time_steps
