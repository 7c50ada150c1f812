// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/volume_files.h"

namespace pellucid::test_nifti {
namespace {

using test::bytes_of;
using test::contains;
using test::counting;
using test::error_of;
using test::expect_counting;
using test::expect_near;
using test::NiftiFile;
using test::world_of;

class NiftiTest : public test::ScratchFolder {
 protected:
  Volume parse(const std::string& bytes, const ReadOptions& options = {}) {
    return read_volume(write("a.nii", bytes), options);
  }
  Volume parse(const NiftiFile& file) { return parse(file.with(bytes_of(counting()))); }
  std::string error(const std::string& bytes, const char* name = "a.nii") {
    write(name, bytes);
    return error_of([&] { read_volume(path(name)); });
  }
  std::string error(const NiftiFile& file) { return error(file.with(bytes_of(counting()))); }

  template <class Value>
  void expect_type(std::int16_t datatype, const std::string& type) {
    SCOPED_TRACE(type);
    NiftiFile file;
    file.datatype = datatype;
    file.bitpix = static_cast<std::int16_t>(8 * sizeof(Value));
    expect_counting(parse(file.with(bytes_of(counting<Value>()))), type);
    file.big_endian = true;
    expect_counting(parse(file.with(test::swapped_bytes_of(counting<Value>()))), type);
    expect_counting(
        read_volume(
            write("z.nii.gz", test::gzipped(file.with(test::swapped_bytes_of(counting<Value>()))))),
        type);
  }
};

TEST_F(NiftiTest, AllTypesInBothByteOrdersPlainAndCompressed) {
  expect_type<std::uint8_t>(2, "u8");
  expect_type<std::int8_t>(256, "i8");
  expect_type<std::uint16_t>(512, "u16");
  expect_type<std::int16_t>(4, "i16");
  expect_type<std::uint32_t>(768, "u32");
  expect_type<std::int32_t>(8, "i32");
  expect_type<float>(16, "f32");
  expect_type<double>(64, "f64");
  // Whole numbers of 64 bits in the smallest type that holds them.
  expect_type<std::int64_t>(1024, "u8");
  expect_type<std::uint64_t>(1280, "u8");
}

TEST_F(NiftiTest, TypesThatAreNotReadAreNamed) {
  NiftiFile file;
  for (const auto& [code, word] :
       std::initializer_list<std::pair<std::int16_t, const char*>>{{128, "RGB"},
                                                                   {2304, "RGB"},
                                                                   {32, "complex"},
                                                                   {1792, "complex"},
                                                                   {1536, "1536"},
                                                                   {1, "type 1 "},
                                                                   {0, "type 0 "},
                                                                   {77, "77"}}) {
    file.datatype = code;
    EXPECT_TRUE(contains(error(file.with(std::string(4096, '\0'))), word)) << code;
  }
}

// nifti1.h: value = scl_slope · stored + scl_inter, unless scl_slope is 0.
TEST_F(NiftiTest, SlopeAndInterceptAreApplied) {
  NiftiFile file;
  file.datatype = 2;
  file.bitpix = 8;
  const std::string values = bytes_of(counting<std::uint8_t>());
  file.slope = 0.25F;
  file.intercept = -3;
  const Volume scaled = parse(file.with(values));
  EXPECT_EQ(type_name(scaled.data()), "f32");
  EXPECT_EQ(test::value_at(scaled, 1, 2, 2), 0.25 * 51 - 3);
  NiftiFile of_64_bits = file;
  of_64_bits.bitpix = 64;
  for (const std::int16_t datatype : {std::int16_t{1024}, std::int16_t{1280}}) {
    of_64_bits.datatype = datatype;
    for (const bool big : {false, true}) {
      of_64_bits.big_endian = big;
      const std::vector<std::int64_t> numbers = counting<std::int64_t>();
      const Volume whole =
          parse(of_64_bits.with(big ? test::swapped_bytes_of(numbers) : bytes_of(numbers)));
      EXPECT_EQ(type_name(whole.data()), "f64");
      EXPECT_EQ(test::value_at(whole, 1, 2, 2), 0.25 * 51 - 3);
    }
  }
  file.slope = 1;
  EXPECT_EQ(test::value_at(parse(file.with(values)), 1, 2, 2), 51 - 3);
  file.slope = 0;
  expect_counting(parse(file.with(values)), "u8");
  file.slope = std::numeric_limits<float>::quiet_NaN();
  expect_counting(parse(file.with(values)), "u8");
  file.slope = 1;
  file.intercept = 0;
  expect_counting(parse(file.with(values)), "u8");

  // 32-bit integers need a double after scaling.
  file.datatype = 8;
  file.bitpix = 32;
  file.intercept = 1;
  const Volume wide = parse(file.with(bytes_of(std::vector<std::int32_t>(60, 2147483646))));
  EXPECT_EQ(type_name(wide.data()), "f64");
  EXPECT_EQ(test::value_at(wide, 0, 0, 0), 2147483647.0);
}

// NIfTI is RAS, the world here LPS: x and y change their sign, z does not.
TEST_F(NiftiTest, QformStandsInLps) {
  NiftiFile file;
  file.qform_code = 1;
  file.qform = {0, 0, 0, 10, 20, 30};
  const Volume plain = parse(file);
  expect_near(world_of(plain, 0, 0, 0), {-10, -20, 30});
  expect_near(world_of(plain, 1, 0, 0), {-11, -20, 30});
  expect_near(world_of(plain, 0, 1, 0), {-10, -22, 30});
  expect_near(world_of(plain, 4, 3, 2), {-14, -26, 36});
  // A quarter turn about z, b = c = 0, d = √½: i goes to +y (anterior), j to −x (left).
  file.qform = {0, 0, static_cast<float>(std::sqrt(0.5)), 10, 20, 30};
  const Volume turned = parse(file);
  expect_near(world_of(turned, 1, 0, 0), {-10, -21, 30});
  expect_near(world_of(turned, 0, 1, 0), {-8, -20, 30});
  // pixdim[0] = −1 turns the third axis round.
  file.qform = {0, 0, 0, 10, 20, 30};
  file.pixdim[0] = -1;
  expect_near(world_of(parse(file), 0, 0, 1), {-10, -20, 27});
}

TEST_F(NiftiTest, TwoMapsThatDifferAreTold) {
  std::string notes;
  ReadOptions options;
  options.note = [&](const std::string& note) { notes += note; };
  NiftiFile file;
  file.qform_code = file.sform_code = 1;
  file.qform = {0, 0, static_cast<float>(std::sqrt(0.5)), 10, 20, 30};
  file.sform = {0, -2, 0, 10, 1, 0, 0, 20, 0, 0, 3, 30};
  parse(file.with(bytes_of(counting())), options);
  EXPECT_EQ(notes, "");
  file.sform[3] = 10.01F;
  const Volume volume = parse(file.with(bytes_of(counting())), options);
  EXPECT_LT(world_of(volume, 0, 0, 0).x, -10.005);
  EXPECT_TRUE(contains(notes, "the sform is used")) << notes;
}

// The sform where there is one, else the qform, as nibabel, FSL and SPM have it.
TEST_F(NiftiTest, TheSformComesFirstAndTheQformSecond) {
  for (std::int16_t qform = 0; qform <= 4; ++qform) {
    for (std::int16_t sform = 0; sform <= 4; ++sform) {
      SCOPED_TRACE(std::to_string(qform) + ", " + std::to_string(sform));
      NiftiFile file;
      file.qform_code = qform;
      file.sform_code = sform;
      file.qform = {0, 0, 0, 10, 20, 30};
      file.sform = {1, 0, 0, 11, 0, 2, 0, 22, 0, 0, 3, 33};
      const double x = sform > 0 ? -11 : qform > 0 ? -10 : -2;  // about the origin without either
      EXPECT_EQ(world_of(parse(file), 0, 0, 0).x, x);
      if (sform == 0) continue;
      // Sheared, and without a length along y.
      file.sform[1] = 0.1F;
      EXPECT_EQ(world_of(parse(file), 0, 0, 0).x, -11);
      if (qform == 0) continue;
      file.sform[1] = file.sform[5] = 0;
      EXPECT_EQ(world_of(parse(file), 0, 0, 0).x, -10);
    }
  }
}

// Quaternions that rounding left longer than 1 are half a turn.
TEST_F(NiftiTest, QuaternionsThatAreTooLongAreHalfATurn) {
  NiftiFile file;
  file.qform_code = 1;
  file.qform = {0, 1.00001F, 0, 10, 20, 30};
  expect_near(world_of(parse(file), 4, 3, 2), {-(10 - 4), -(20 + 6), 30 - 6});
}

TEST_F(NiftiTest, SformStandsInLps) {
  NiftiFile file;
  file.sform_code = 2;
  // i → superior, j → right, k → anterior; steps 1, 2, 3.
  file.sform = {0, 2, 0, 10, 0, 0, 3, 20, 1, 0, 0, 30};
  const Volume volume = parse(file);
  expect_near(world_of(volume, 0, 0, 0), {-10, -20, 30});
  expect_near(world_of(volume, 1, 0, 0), {-10, -20, 31});
  expect_near(world_of(volume, 0, 1, 0), {-12, -20, 30});
  expect_near(world_of(volume, 0, 0, 1), {-10, -23, 30});
}

// One image with its axes in eight orders, as nifti_space of the conformance files: the letters say
// where the indices grow to.
TEST_F(NiftiTest, EightOrdersOfAxesAreOneImage) {
  const std::array<int, 3> sides{5, 4, 3};  // to the right, anterior, superior
  const std::array<double, 3> steps{1, 2, 3}, corner{10, 20, 30};
  for (const std::string order : {"RAS", "LAS", "LPS", "LPI", "PSR", "AIL", "SAR", "IRP"}) {
    SCOPED_TRACE(order);
    std::array<std::size_t, 3> axis{};
    std::array<bool, 3> turned{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t letter = std::string("RASLPI").find(order[a]);
      axis[a] = letter % 3;
      turned[a] = letter >= 3;
    }
    NiftiFile file;
    file.sform_code = 1;
    std::array<double, 3> origin = corner;
    for (std::size_t a = 0; a < 3; ++a) {
      file.dim[a + 1] = static_cast<std::int16_t>(sides[axis[a]]);
      file.pixdim[a + 1] = static_cast<float>(steps[axis[a]]);
      file.sform[4 * axis[a] + a] =
          static_cast<float>(turned[a] ? -steps[axis[a]] : steps[axis[a]]);
      if (turned[a]) origin[axis[a]] += steps[axis[a]] * (sides[axis[a]] - 1);
    }
    for (std::size_t a = 0; a < 3; ++a) file.sform[4 * a + 3] = static_cast<float>(origin[a]);
    // The value at (i, j, k) to the right, anterior, superior is i + 5 j + 20 k.
    std::vector<float> values;
    std::array<int, 3> index{};
    for (index[2] = 0; index[2] < file.dim[3]; ++index[2]) {
      for (index[1] = 0; index[1] < file.dim[2]; ++index[1]) {
        for (index[0] = 0; index[0] < file.dim[1]; ++index[0]) {
          std::array<int, 3> at{};
          for (std::size_t a = 0; a < 3; ++a) {
            at[axis[a]] = turned[a] ? sides[axis[a]] - 1 - index[a] : index[a];
          }
          values.push_back(static_cast<float>(at[0] + 5 * at[1] + 20 * at[2]));
        }
      }
    }
    const Volume volume = parse(file.with(bytes_of(values)));
    for (int k = 0; k < file.dim[3]; ++k) {
      for (int j = 0; j < file.dim[2]; ++j) {
        for (int i = 0; i < file.dim[1]; ++i) {
          const int value = static_cast<int>(test::value_at(volume, i, j, k));
          expect_near(world_of(volume, i, j, k),
                      {-(10.0 + value % 5), -(20.0 + value / 5 % 4 * 2), 30.0 + value / 20 * 3});
        }
      }
    }
  }
}

TEST_F(NiftiTest, ObliqueSformStandsAsItLies) {
  const double angle = 0.3, c = std::cos(angle), s = std::sin(angle);
  NiftiFile file;
  file.sform_code = 1;
  const std::array<double, 12> m{c, -2 * s, 0, 10, s, 2 * c, 0, 20, 0, 0, 3, 30};
  for (std::size_t i = 0; i < 12; ++i) file.sform[i] = static_cast<float>(m[i]);
  expect_near(world_of(parse(file), 4, 3, 2),
              {-(c * 4 - 2 * s * 3 + 10), -(s * 4 + 2 * c * 3 + 20), 36});
}

TEST_F(NiftiTest, ShearedSformStandsAsItLies) {
  NiftiFile file;
  file.sform_code = 1;
  file.sform = {1, 0.5F, 0, 10, 0, 2, 0.25F, 20, 0, 0, 3, 30};
  const Volume volume = parse(file);
  expect_near(world_of(volume, 0, 1, 0), {-10.5, -22, 30});
  expect_near(world_of(volume, 4, 3, 2), {-(4 + 1.5 + 10), -(6 + 0.5 + 20), 36});
  expect_counting(volume, "f32");
}

TEST_F(NiftiTest, SformWithOtherSpacingThanPixdim) {
  NiftiFile file;
  file.sform_code = 1;
  file.sform = {1.5F, 0, 0, 10, 0, 2.5F, 0, 20, 0, 0, 3.5F, 30};
  expect_near(world_of(parse(file), 4, 3, 2), {-16, -27.5, 37});
}

TEST_F(NiftiTest, SingularSformIsRefused) {
  NiftiFile file;
  file.sform_code = 1;
  file.sform = {1, 0, 0, 10, 0, 0, 0, 20, 0, 0, 3, 30};
  EXPECT_TRUE(contains(error(file), "gives axis y no length"));
  file.sform = {1, 1, 0, 10, 0, 0, 0, 20, 0, 0, 3, 30};
  error(file);
}

TEST_F(NiftiTest, OrientationsThatAreNotFiniteAreRefused) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (std::size_t i = 0; i < 12; ++i) {
      NiftiFile file;
      file.sform_code = 1;
      file.sform = {1, 0, 0, 10, 0, 2, 0, 20, 0, 0, 3, 30};
      file.sform[i] = bad;
      EXPECT_TRUE(contains(error(file), "sform"));
      if (i >= 6) continue;
      file.sform_code = 0;
      file.qform_code = 1;
      file.qform[i] = bad;
      EXPECT_TRUE(contains(error(file), "qform"));
    }
  }
}

TEST_F(NiftiTest, MetresAndMicrometresBecomeMillimetres) {
  NiftiFile file;
  file.qform_code = 1;
  file.qform = {0, 0, 0, 10, 20, 30};
  file.units = 1;
  expect_near(world_of(parse(file), 4, 3, 2), {-14e3, -26e3, 36e3}, 1e-2);
  file.units = 3;
  expect_near(world_of(parse(file), 4, 3, 2), {-14e-3, -26e-3, 36e-3}, 1e-8);
}

TEST_F(NiftiTest, SpacingMustBePositive) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {0.F, -2.F, nan, inf}) {
    NiftiFile file;
    file.pixdim[2] = bad;
    EXPECT_TRUE(contains(error(file), "spacing")) << bad;
    ReadOptions options;
    options.spacing = Vec3<double>{1, 2, 3};
    if (bad == 0) {
      expect_near(world_of(parse(file.with(bytes_of(counting())), options), 0, 1, 0),
                  world_of(parse(NiftiFile{}), 0, 1, 0));
    }
  }
}

TEST_F(NiftiTest, OptionsReplaceWhatTheFileSays) {
  ReadOptions options;
  options.spacing = Vec3<double>{4, 5, 6};
  options.origin = Vec3<double>{7, 8, 9};
  options.centering = Centering::cell;
  NiftiFile file;
  file.qform_code = 1;
  const Volume volume = parse(file.with(bytes_of(counting())), options);
  expect_near(world_of(volume, 1, 1, 1), {7 - 4, 8 - 5, 9 + 6});
  EXPECT_EQ(volume.description().centering, Centering::cell);
  options = {};
  options.skip_bytes = 1;
  EXPECT_TRUE(
      contains(error_of([&] { parse(file.with(bytes_of(counting())), options); }), "headerless"));
}

TEST_F(NiftiTest, PairsByEitherHalf) {
  NiftiFile file;
  file.magic = std::string("ni1\0", 4);
  file.vox_offset = 0;
  const std::string values = bytes_of(counting());
  write("p.hdr", file.header());
  write("p.img", values);
  write("q.hdr.gz", test::gzipped(file.header()));
  write("q.img.gz", test::gzipped(values));
  write("m.hdr", file.header());
  write("m.img.gz", test::gzipped(values));
  for (const char* name : {"p.hdr", "p.img", "q.hdr.gz", "q.img.gz", "m.hdr", "m.img.gz"}) {
    SCOPED_TRACE(name);
    expect_counting(read_volume(path(name)), "f32");
  }
  file.vox_offset = 5;
  write("o.hdr", file.header());
  write("o.img", "12345" + values);
  expect_counting(read_volume(path("o.hdr")), "f32");
  write("lone.hdr", file.header());
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("lone.hdr")); }), "lone.img is missing"));
  write("alone.img", values);
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("alone.img")); }), "alone.hdr is missing"));
}

TEST_F(NiftiTest, AxesBeyondTheThirdMustBeOne) {
  NiftiFile file;
  file.dim[0] = 5;
  expect_counting(parse(file), "f32");
  const std::string two = bytes_of(counting()) + bytes_of(counting());
  file.dim[4] = 2;
  EXPECT_TRUE(contains(error(file.with(two)), "2 time steps"));
  file.dim[4] = 1;
  file.dim[5] = 2;
  EXPECT_TRUE(contains(error(file.with(two)), "2 components"));
  file.dim = {2, 5, 12, 1, 1, 1, 1, 1};
  EXPECT_TRUE(contains(error(file), "2 axes"));
  file.dim = {3, 5, 12, 1, 1, 1, 1, 1};
  EXPECT_TRUE(contains(error(file), "along z"));  // a slice spans no cell
  for (const std::int16_t bad : {std::int16_t{0}, std::int16_t{8}, std::int16_t{-1}}) {
    file.dim = {bad, 5, 4, 3, 1, 1, 1, 1};
    error(file);
    file.dim = {3, 5, bad, 3, 1, 1, 1, 1};
    error(file);
  }
}

TEST_F(NiftiTest, EveryTruncationIsAnError) {
  const std::string whole = NiftiFile{}.with(bytes_of(counting()));
  for (std::size_t length = 0; length < whole.size(); length += length < 340 ? 31 : 1) {
    error(whole.substr(0, length));
  }
  const std::string packed = test::gzipped(whole);
  for (std::size_t length = 0; length < packed.size(); ++length) {
    error(packed.substr(0, length), "a.nii.gz");
  }
}

TEST_F(NiftiTest, ADamagedChecksumIsAnError) {
  std::string packed = test::gzipped(NiftiFile{}.with(bytes_of(counting())));
  packed[packed.size() - 6] = static_cast<char>(packed[packed.size() - 6] ^ 1);
  error(packed, "a.nii.gz");
}

// As bgzip and pigz write: many members one after the other.
TEST_F(NiftiTest, SeveralGzipMembersAreOne) {
  const std::string whole = NiftiFile{}.with(bytes_of(counting()));
  std::string packed;
  for (std::size_t at = 0; at < whole.size(); at += 100) {
    packed += test::gzipped(whole.substr(at, 100));
  }
  expect_counting(read_volume(write("m.nii.gz", packed)), "f32");
}

TEST_F(NiftiTest, WhereTheValuesBeginIsChecked) {
  NiftiFile file;
  file.vox_offset = 0;  // as some programs write; means 352
  expect_counting(parse(file), "f32");
  file.vox_offset = 360;
  expect_counting(parse(file.header() + std::string(12, 'x') + bytes_of(counting())), "f32");
  EXPECT_TRUE(contains(error(file), "begin at byte 360"));
  for (const float bad : {-1.F, 100.F, 352.5F, 1e30F, std::numeric_limits<float>::quiet_NaN()}) {
    file.vox_offset = bad;
    EXPECT_TRUE(contains(error(file), "damaged"));
  }
}

// ITK would give zeros here.
TEST_F(NiftiTest, NanIsKeptAndInfinityRefused) {
  std::vector<float> values = counting();
  values[31] = std::numeric_limits<float>::quiet_NaN();
  const Volume volume = parse(NiftiFile{}.with(bytes_of(values)));
  EXPECT_EQ(volume.statistics().nan, 1u);
  EXPECT_TRUE(std::isnan(test::value_at(volume, 1, 2, 1)));
  values[31] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(contains(error(NiftiFile{}.with(bytes_of(values))), "infinite"));
}

TEST_F(NiftiTest, OtherKindsOfFilesAreNamed) {
  NiftiFile file;
  file.size = 0;
  EXPECT_TRUE(contains(error(file), "like a NIfTI"));
  EXPECT_TRUE(contains(error(std::string(1000, 'x')), "like a NIfTI"));
  file.size = 348;
  file.dim = {3, 32767, 32767, 32767, 1, 1, 1, 1};
  EXPECT_TRUE(contains(error(file), "cut off"));
  EXPECT_TRUE(contains(error(test::gzipped(file.with("")), "a.nii.gz"), "memory"));
  error(test::gzipped(file.with("")), "a.nii.gz");
}

TEST_F(NiftiTest, NothingIsPrinted) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  NiftiFile file;
  parse(file);
  file.datatype = 1;
  error(file);
  file.datatype = 16;
  file.sform_code = 1;  // singular
  error(file);
  file.dim[0] = 9;
  error(file);
  error("");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace pellucid::test_nifti
