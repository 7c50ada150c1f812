// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_mgh {
namespace {

using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::MghFile;
using test::swapped_bytes_of;
using test::world_of;

class MghTest : public test::ScratchFolder {
 protected:
  Volume parse(const std::string& bytes, const std::string& name = "a.mgh") {
    ReadOptions options;
    notes_.clear();
    options.note = [this](const std::string& text) { notes_ += text + "\n"; };
    return read_volume(write(name, bytes), options);
  }
  std::string error(const MghFile& file) {
    write("a.mgh", file.with(swapped_bytes_of(counting())));
    return error_of([&] { read_volume(path("a.mgh")); });
  }
  template <class Value>
  void expect_type(std::int32_t code, const std::string& type) {
    SCOPED_TRACE(type);
    MghFile file;
    file.type = code;
    const std::string bytes = file.with(swapped_bytes_of(counting<Value>()));
    expect_counting(parse(bytes), type);
    expect_counting(parse(test::gzipped(bytes), "a.mgz"), type);
    expect_counting(parse(test::gzipped(bytes), "a.mgh.gz"), type);
    expect_counting(parse(bytes, "b.mgz"), type);  // some are not compressed
  }
  std::string notes_;
};

TEST_F(MghTest, TypesPlainAndCompressed) {
  expect_type<std::uint8_t>(0, "u8");
  expect_type<std::int32_t>(1, "i32");
  expect_type<float>(3, "f32");
  expect_type<std::int16_t>(4, "i16");
  expect_type<std::uint16_t>(10, "u16");
  EXPECT_EQ(notes_, "");
}

// nibabel: vox2ras = M diag(delta), with center - M diag(delta) dimensions / 2.
TEST_F(MghTest, DirectionsStandInLps) {
  const std::string values = swapped_bytes_of(counting());
  const Volume plain = parse(MghFile{}.with(values));
  expect_near(world_of(plain, 0, 0, 0), {-(10 - 2.5), -(20 - 4), 30 - 4.5});
  expect_near(world_of(plain, 4, 3, 2), {-(10 + 1.5), -(20 + 2), 30 + 1.5});
  EXPECT_TRUE(is_placed_in_lps(path("a.mgh")));
  // As FreeSurfer's own lie: x to the left, y down, z to the front.
  MghFile coronal;
  coronal.directions = {-1, 0, 0, 0, 0, -1, 0, 1, 0};
  const Volume turned = parse(coronal.with(values));
  expect_near(world_of(turned, 0, 0, 0), {-(10 + 2.5), -(20 - 4.5), 30 + 4});
  expect_near(world_of(turned, 4, 3, 2), {-(10 - 1.5), -(20 + 1.5), 30 - 2});
  // Oblique, and what stands behind the values: repetition time and tags.
  MghFile oblique;
  oblique.directions = {0.8F, 0.6F, 0, -0.6F, 0.8F, 0, 0, 0, 1};
  const Volume leaning = parse(oblique.with(values + std::string(40, 't')));
  expect_near(world_of(leaning, 1, 0, 0) - world_of(leaning, 0, 0, 0), {-0.8, -0.6, 0});
  expect_near(world_of(leaning, 0, 1, 0) - world_of(leaning, 0, 0, 0), {1.2, -1.6, 0});
  EXPECT_EQ(notes_, "");
}

// FreeSurfer: without directions the volume is coronal, of 1 mm, about the origin.
TEST_F(MghTest, WithoutDirectionsIsCoronalAndSaysSo) {
  for (const std::int16_t flag : {std::int16_t{0}, std::int16_t{-1}}) {
    MghFile file;
    file.good_ras = flag;
    const Volume volume = parse(file.with(swapped_bytes_of(counting())));
    expect_near(world_of(volume, 0, 0, 0), {-2.5, 1.5, 2});
    expect_near(world_of(volume, 4, 3, 2), {1.5, -0.5, -1});
    EXPECT_TRUE(contains(notes_, "goodRASFlag is 0")) << notes_;
    EXPECT_FALSE(is_placed_in_lps(path("a.mgh")));
  }
}

TEST_F(MghTest, FramesAreComponents) {
  MghFile file;
  file.dimensions[3] = 2;
  file.type = 4;
  std::vector<std::int16_t> values = counting<std::int16_t>();
  for (int i = 0; i < 60; ++i) values.push_back(static_cast<std::int16_t>(100 + i));
  write("a.mgz", test::gzipped(file.with(swapped_bytes_of(values))));
  const std::vector<Volume> frames = read_components(path("a.mgz"));
  ASSERT_EQ(frames.size(), 2u);
  expect_counting(frames[0], "i16");
  EXPECT_EQ(test::value_at(frames[1], 4, 3, 2), 159);
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.mgz")); }), "2 frames"));
}

TEST_F(MghTest, BadFilesAreRefused) {
  const auto refuse = [&](const auto& change) {
    MghFile file;
    change(file);
    return error(file);
  };
  for (const std::int32_t type : {2, 5, 6, 9, 77, -1}) {
    EXPECT_TRUE(contains(refuse([&](auto& f) { f.type = type; }), "data type")) << type;
  }
  EXPECT_TRUE(contains(refuse([](auto& f) { f.version = 2; }), "version 1"));
  refuse([](auto& f) { f.version = -1; });
  for (const std::int32_t bad : {0, -5, 1 << 30}) {
    for (std::size_t a = 0; a < 4; ++a) refuse([&](auto& f) { f.dimensions[a] = bad; });
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(contains(refuse([&](auto& f) { f.delta[1] = nan; }), "not finite"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.delta[1] = 0; }), "spacing along y"));
  EXPECT_TRUE(contains(refuse([&](auto& f) { f.center[1] = nan; }), "not finite"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.directions = {}; }), "no direction"));
  const std::string whole = MghFile{}.with(swapped_bytes_of(counting()));
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    write("cut.mgh", whole.substr(0, length));
    error_of([&] { read_volume(path("cut.mgh")); });
  }
  // A warp has an intent above the version.
  MghFile warp;
  warp.version = 1 | 1 << 8;
  parse(warp.with(swapped_bytes_of(counting())));
  EXPECT_TRUE(contains(notes_, "intent 1")) << notes_;
}

}  // namespace
}  // namespace pellucid::test_mgh
