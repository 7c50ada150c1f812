// SPDX-License-Identifier: Apache-2.0
//
// NIfTI without orientation, Analyze 7.5 and NIfTI-2.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_nifti_two {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::NiftiFile;
using test::NiftiTwoFile;
using test::world_of;

class NiftiTwoTest : public test::ScratchFolder {
 protected:
  Volume parse(const std::string& bytes, const std::string& name = "a.nii") {
    ReadOptions options;
    notes_.clear();
    options.note = [this](const std::string& text) { notes_ += text + "\n"; };
    return read_volume(write(name, bytes), options);
  }
  std::string error(const std::string& bytes, const char* name = "a.nii") {
    write(name, bytes);
    return error_of([&] { read_volume(path(name)); });
  }
  std::string notes_;
};

// The middle is at the origin, x runs to the left, y to anterior, z to superior: nibabel's
// get_base_affine() gives diag(-1, 2, 3) and (2, -3, -3) of this grid.
TEST_F(NiftiTwoTest, WithoutCodesIsPlacedAboutTheOriginAndSaysSo) {
  const Volume volume = parse(NiftiFile{}.with(bytes_of(counting())));
  expect_near(world_of(volume, 0, 0, 0), {-2, 3, -3});
  expect_near(world_of(volume, 4, 3, 2), {2, -3, 3});
  EXPECT_TRUE(contains(notes_, "states no orientation (qform_code and sform_code are 0)"))
      << notes_;
  EXPECT_EQ(world_space(path("a.nii")), "");
  EXPECT_FALSE(is_placed_in_lps(path("a.nii")));

  expect_near(world_of(parse(NiftiTwoFile{}.with(bytes_of(counting()))), 4, 3, 2), {2, -3, 3});
  EXPECT_TRUE(contains(notes_, "states no orientation")) << notes_;

  for (const bool is_qform : {true, false}) {
    NiftiFile file;
    (is_qform ? file.qform_code : file.sform_code) = 4;
    file.sform = {1, 0, 0, 10, 0, 2, 0, 20, 0, 0, 3, 30};
    parse(file.with(bytes_of(counting())));
    EXPECT_EQ(notes_, "");
    EXPECT_TRUE(is_placed_in_lps(path("a.nii")));
    EXPECT_EQ(outline_volume(path("a.nii")).space, "LPS");
  }
  // In meters, and with a spacing that is given.
  NiftiFile meters;
  meters.units = 1;
  expect_near(world_of(parse(meters.with(bytes_of(counting()))), 4, 3, 2), {2e3, -3e3, 3e3});
  ReadOptions options;
  options.spacing = Vec3<double>{2, 2, 2};
  expect_near(world_of(read_volume(path("a.nii"), options), 0, 0, 0), {-4, 3, -2});
}

TEST_F(NiftiTwoTest, AnalyzeIsPlacedAsSpmDoes) {
  NiftiFile file;
  file.magic = std::string(4, '\0');
  file.vox_offset = 0;
  file.units = 0;
  const std::string values = bytes_of(counting());
  write("a.img", values);
  const Volume volume = parse(file.header(), "a.hdr");
  expect_counting(volume, "f32");
  expect_near(world_of(volume, 0, 0, 0), {-2, 3, -3});
  EXPECT_TRUE(contains(notes_, "Analyze 7.5 states no orientation")) << notes_;
  EXPECT_FALSE(is_placed_in_lps(path("a.hdr")));

  // SPM's origin, counted from 1: bytes 253 on, in either byte order.
  for (const bool big : {false, true}) {
    file.big_endian = big;
    std::string header = file.header();
    for (std::size_t a = 0; a < 3; ++a) {
      file.put(header, 253 + 2 * a, static_cast<std::int16_t>(a + 2));
    }
    write("a.img", big ? test::swapped_bytes_of(counting()) : values);
    const Volume spm = parse(header, "a.hdr");
    expect_counting(spm, "f32");
    expect_near(world_of(spm, 1, 2, 3), {0, 0, 0});
    expect_near(world_of(spm, 0, 0, 0), {-1, 4, -9});
    // One far away is none.
    file.put(header, 253, std::int16_t{300});
    expect_near(world_of(parse(header, "a.hdr"), 0, 0, 0), {-2, 3, -3});
    header[252] = 3;
    parse(header, "a.hdr");
    EXPECT_TRUE(contains(notes_, "orient 3")) << notes_;
  }
  file.big_endian = false;
  write("a.img", values);
  file.slope = 2;
  const Volume scaled = parse(file.header(), "a.hdr");
  EXPECT_EQ(test::value_at(scaled, 4, 3, 2), 118);
  file.slope = 0;
  file.dim = {4, 5, 4, 3, 0, 0, 0, 0};
  expect_counting(parse(file.header(), "a.hdr"), "f32");
  write("a.mat", "x");
  parse(file.header(), "a.hdr");
  EXPECT_TRUE(contains(notes_, "a.mat beside it")) << notes_;
  EXPECT_TRUE(contains(error(file.with(values)), "lacks the mark of NIfTI"));
  file.magic = std::string("ni1\0", 4);
  file.dim = NiftiFile{}.dim;
  const std::string apart = error(file.with(values));
  EXPECT_TRUE(contains(apart, "values are in a file of their own")) << apart;
}

TEST_F(NiftiTwoTest, NiftiTwoInBothByteOrdersPlainAndCompressed) {
  for (const bool big : {false, true}) {
    NiftiTwoFile file;
    file.big_endian = big;
    file.sform_code = 1;
    file.sform = {1, 0, 0, 10, 0, 2, 0, 20, 0, 0, 3, 30};
    const auto with = [&](const auto& values) {
      return file.with(big ? test::swapped_bytes_of(values) : bytes_of(values));
    };
    const Volume volume = parse(with(counting()));
    expect_counting(volume, "f32");
    expect_near(world_of(volume, 4, 3, 2), {-14, -26, 36});
    EXPECT_EQ(notes_, "");
    expect_counting(parse(test::gzipped(with(counting())), "a.nii.gz"), "f32");
    file.datatype = 4;
    expect_counting(parse(with(counting<std::int16_t>())), "i16");
    file.slope = 0.5;
    file.intercept = 3;
    EXPECT_EQ(test::value_at(parse(with(counting<std::int16_t>())), 4, 3, 2), 59 * 0.5 + 3);
    file.slope = std::numeric_limits<double>::quiet_NaN();
    expect_counting(parse(with(counting<std::int16_t>())), "i16");
    file.sform_code = 0;
    file.qform_code = 1;
    file.qform = {0, 0, std::sqrt(0.5), 10, 20, 30};
    expect_near(world_of(parse(with(counting<std::int16_t>())), 1, 0, 0), {-10, -21, 30}, 1e-12);
    file.vox_offset = 560;
    expect_counting(parse(file.header() + std::string(20, 'x') +
                          (big ? test::swapped_bytes_of(counting<std::int16_t>())
                               : bytes_of(counting<std::int16_t>()))),
                    "i16");
    file.dim = {4, 5, 4, 3, 2, 1, 1, 1};
    file.vox_offset = 0;
    std::vector<std::int16_t> two = counting<std::int16_t>();
    for (int i = 0; i < 60; ++i) two.push_back(static_cast<std::int16_t>(100 + i));
    const std::vector<Volume> steps = read_components(write("t.nii", with(two)));
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_EQ(test::value_at(steps[1], 4, 3, 2), 159);
  }
  NiftiTwoFile pair;
  pair.magic = std::string("ni2\0\r\n\x1a\n", 8);
  pair.vox_offset = 0;
  write("p.img", bytes_of(counting()));
  expect_counting(read_volume(write("p.hdr", pair.header())), "f32");
  expect_counting(read_volume(path("p.img")), "f32");
}

TEST_F(NiftiTwoTest, BadNiftiTwoIsRefused) {
  const std::string values = bytes_of(counting());
  const auto refuse = [&](const auto& change) {
    NiftiTwoFile file;
    change(file);
    return error(file.with(values));
  };
  EXPECT_TRUE(contains(refuse([](auto& f) { f.intent = 3001; }), "CIFTI-2"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.intent = 1008; }), "points of a surface"));
  EXPECT_TRUE(
      contains(refuse([](auto& f) { f.magic = std::string("n+2\0\n\n\x1a\n", 8); }), "as text"));
  EXPECT_TRUE(contains(refuse([](auto& f) { f.magic = std::string(8, '\0'); }), "n+2"));
  for (const std::int64_t bad : {std::int64_t{0}, std::int64_t{-4}, std::int64_t{1} << 40,
                                 std::numeric_limits<std::int64_t>::max()}) {
    refuse([&](auto& f) { f.dim[2] = bad; });
    refuse([&](auto& f) { f.dim = {4, 5, 4, 3, bad, 1, 1, 1}; });
    refuse([&](auto& f) { f.vox_offset = bad == 0 ? 3 : bad; });
  }
  refuse([](auto& f) { f.dim[0] = 9; });
  refuse([](auto& f) { f.pixdim[1] = -1; });
  const std::string whole = NiftiTwoFile{}.with(values);
  for (std::size_t length = 0; length < whole.size(); length += length < 530 ? 23 : 1) {
    error(whole.substr(0, length));
  }
}

TEST_F(NiftiTwoTest, IntentsAndUnitsAreTold) {
  NiftiTwoFile file;
  file.qform_code = 1;
  file.intent = 1002;
  parse(file.with(bytes_of(counting())));
  EXPECT_TRUE(contains(notes_, "labels (intent_code 1002)")) << notes_;
  file.intent = 0;
  file.units = 5;
  parse(file.with(bytes_of(counting())));
  EXPECT_TRUE(contains(notes_, "xyzt_units 5")) << notes_;
  file.units = 0;
  parse(file.with(bytes_of(counting())));
  EXPECT_TRUE(contains(notes_, "xyzt_units 0")) << notes_;
  // Vectors "of RGB", which may be directions that are shown as colors, behind one step of time.
  file.intent = 2003;
  file.dim = {5, 5, 4, 3, 1, 3, 1, 1};
  const std::string three = bytes_of(counting()) + bytes_of(counting()) + bytes_of(counting());
  EXPECT_TRUE(contains(error(file.with(three)), "3 components (axis 5)"));
  EXPECT_EQ(read_components(path("a.nii")).size(), 3u);
}

}  // namespace
}  // namespace pellucid::test_nifti_two
