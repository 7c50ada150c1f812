// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "volume_files.h"

// Whether the values of a file are mapped or read, as the system sees it.
namespace pellucid::test_in_place {
namespace {

using test::bytes_of;
using test::counting;
using test::expect_counting;

bool is_mapped(const std::filesystem::path& file) {
  std::ifstream maps("/proc/self/maps");
  std::string line;
  while (std::getline(maps, line)) {
    if (line.ends_with(file.string())) return true;
  }
  return false;
}

class InPlace : public test::ScratchFolder {
 protected:
  void SetUp() override {
    test::ScratchFolder::SetUp();
    if (!std::filesystem::exists("/proc/self/maps")) GTEST_SKIP() << "no /proc/self/maps";
  }
  /// Reads 0 … 59 and says whether `values`, the file that holds them, is mapped meanwhile.
  bool maps(const std::string& name, const std::string& bytes, const std::string& type,
            const ReadOptions& options = {}, const std::string& values = "") {
    const std::filesystem::path file = write(name, bytes);
    const std::filesystem::path held = values.empty() ? file : path(values);
    std::optional<Volume> volume = read_volume(file, options);
    expect_counting(*volume, type);
    const bool mapped = is_mapped(held);
    std::optional<Volume> copy = volume;
    volume.reset();
    EXPECT_EQ(is_mapped(held), mapped);
    expect_counting(*copy, type);
    copy.reset();
    EXPECT_FALSE(is_mapped(held)) << "nobody needs it any more";
    return mapped;
  }
};

ReadOptions raw(const std::string& type, std::size_t skip = 0) {
  ReadOptions options;
  options.dimensions = {5, 4, 3};
  options.type = type;
  options.skip_bytes = skip;
  return options;
}

TEST_F(InPlace, RawInTheOrderAndPlaceOfMemory) {
  EXPECT_TRUE(maps("a.raw", bytes_of(counting()), "f32", raw("f32")));
  EXPECT_TRUE(maps("b.raw", "1234" + bytes_of(counting()), "f32", raw("f32", 4)));
  EXPECT_TRUE(maps("c.raw", "123" + bytes_of(counting<std::uint8_t>()), "u8", raw("u8", 3)));
  // Across the end of a page of memory.
  EXPECT_TRUE(maps("d.raw", std::string(8184, 'x') + bytes_of(counting<double>()), "f64",
                   raw("f64", 8184)));
}

TEST_F(InPlace, RawOutOfPlaceOrOrderIsRead) {
  EXPECT_FALSE(maps("a.raw", "12" + bytes_of(counting()), "f32", raw("f32", 2)));
  EXPECT_FALSE(maps("b.raw", "1234" + bytes_of(counting<double>()), "f64", raw("f64", 4)));
  ReadOptions big = raw("i16");
  big.big_endian = true;
  EXPECT_FALSE(maps("c.raw", test::swapped_bytes_of(counting<std::int16_t>()), "i16", big));
  // One byte has no order.
  big.type = "u8";
  EXPECT_TRUE(maps("d.raw", bytes_of(counting<std::uint8_t>()), "u8", big));
}

TEST_F(InPlace, Npy) {
  for (const bool fortran : {false, true}) {
    // The last axis is the fastest in C, the first in Fortran.
    ReadOptions options;
    if (fortran) options.axes = "xyz";
    std::string header = "{'descr': '<f4', 'fortran_order': ";
    header += fortran ? "True, 'shape': (5, 4, 3)}" : "False, 'shape': (3, 4, 5)}";
    header.resize(118, ' ');
    const std::string magic("\x93NUMPY\1\0\x76\0", 10);
    EXPECT_TRUE(maps("a.npy", magic + header + bytes_of(counting()), "f32", options));
    header.replace(header.find('<'), 1, ">");
    EXPECT_FALSE(
        maps("b.npy", magic + header + test::swapped_bytes_of(counting()), "f32", options));
  }
}

#ifdef PELLUCID_HAVE_ITK

TEST_F(InPlace, Nifti) {
  test::NiftiFile file;
  const std::string values = bytes_of(counting());
  EXPECT_TRUE(maps("a.nii", file.with(values), "f32"));
  EXPECT_FALSE(maps("a.nii.gz", test::gzipped(file.with(values)), "f32"));
  file.magic = std::string("ni1\0", 4);
  file.vox_offset = 0;
  write("p.img", values);
  EXPECT_TRUE(maps("p.hdr", file.header(), "f32", {}, "p.img"));
  // What is to be scaled becomes another type.
  file = {};
  file.datatype = 4;
  file.bitpix = 16;
  file.slope = 0.5;
  std::vector<std::int16_t> twice(60);
  for (std::size_t i = 0; i < 60; ++i) twice[i] = static_cast<std::int16_t>(2 * i);
  EXPECT_FALSE(maps("s.nii", file.with(bytes_of(twice)), "f32"));
}

TEST_F(InPlace, ScaledValuesOfMoreThanOnePart) {
  test::NiftiFile file;
  file.dim = {3, 50, 51, 52, 1, 1, 1, 1};
  file.datatype = 4;
  file.bitpix = 16;
  file.slope = 0.5;
  file.intercept = 3;
  std::vector<std::int16_t> stored(50 * 51 * 52);
  for (std::size_t i = 0; i < stored.size(); ++i) stored[i] = static_cast<std::int16_t>(i * 7);
  const std::string bytes = file.with(bytes_of(stored));
  for (const auto& written : {write("s.nii", bytes), write("s.nii.gz", test::gzipped(bytes))}) {
    const Volume volume = read_volume(written);
    const auto& values = std::get<DataArray<float>>(volume.data());
    ASSERT_EQ(values.size(), stored.size());
    for (std::size_t i = 0; i < stored.size(); ++i) {
      ASSERT_EQ(values[i], 0.5f * static_cast<float>(stored[i]) + 3) << i;
    }
  }
}

TEST_F(InPlace, MetaImage) {
  const auto header = [](const std::string& more) {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" +
           more + "DimSize = 5 4 3\nElementType = MET_UCHAR\nElementDataFile = ";
  };
  const std::string values = bytes_of(counting<std::uint8_t>());
  EXPECT_TRUE(maps("a.mha", header("") + "LOCAL\n" + values, "u8"));
  write("v.raw", values);
  EXPECT_TRUE(maps("b.mhd", header("") + "v.raw\n", "u8", {}, "v.raw"));
  write("w.raw", "1234567" + values);
  EXPECT_TRUE(maps("c.mhd", header("HeaderSize = -1\n") + "w.raw\n", "u8", {}, "w.raw"));
  EXPECT_FALSE(maps(
      "d.mha", header("CompressedData = True\n") + "LOCAL\n" + test::deflated(values, 15), "u8"));
  for (int k = 0; k < 3; ++k) {
    write("s" + std::to_string(k) + ".raw", values.substr(static_cast<std::size_t>(20 * k), 20));
  }
  EXPECT_FALSE(maps("e.mhd", header("") + "s%d.raw 0 2 1\n", "u8", {}, "s1.raw"));
}

TEST_F(InPlace, Nrrd) {
  const auto header = [](const std::string& more, const std::string& type = "uchar") {
    return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: 5 4 3\nspacings: 1 1 1\n" + more;
  };
  const std::string values = bytes_of(counting<std::uint8_t>());
  EXPECT_TRUE(maps("a.nrrd", header("encoding: raw\n\n") + values, "u8"));
  EXPECT_TRUE(maps("b.nrrd", header("encoding: raw\nbyte skip: 7\n\n") + "1234567" + values, "u8"));
  EXPECT_TRUE(
      maps("c.nrrd", header("encoding: raw\nbyte skip: -1\n\n") + "1234567" + values, "u8"));
  write("v.raw", values);
  EXPECT_TRUE(maps("d.nhdr", header("encoding: raw\ndata file: v.raw\n\n"), "u8", {}, "v.raw"));
  write("w.raw", "1234" + bytes_of(counting()));
  const std::string skips = "endian: little\nencoding: raw\nbyte skip: 4\ndata file: w.raw\n\n";
  EXPECT_TRUE(maps("e.nhdr", header(skips, "float"), "f32", {}, "w.raw"));
  // "space directions" without a space, which the header is mended for.
  std::string mended = header("encoding: raw\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n\n");
  mended.erase(mended.find("spacings"), 16);
  EXPECT_TRUE(maps("f.nrrd", mended + values, "u8"));

  EXPECT_FALSE(maps("g.nrrd", header("encoding: gzip\n\n") + test::gzipped(values), "u8"));
  write("lines.raw", "one line\n" + values);
  EXPECT_FALSE(maps("h.nhdr", header("encoding: raw\nline skip: 1\ndata file: lines.raw\n\n"), "u8",
                    {}, "lines.raw"));
  const std::string big = "endian: big\nencoding: raw\n\n";
  EXPECT_FALSE(maps("i.nrrd", header(big, "float") + test::swapped_bytes_of(counting()), "f32"));
}

#endif

}  // namespace
}  // namespace pellucid::test_in_place
