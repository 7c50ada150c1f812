// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_volume.h"

#include <string>

#include "volume_files.h"

namespace pellucid {
namespace {

using test::contains;
using test::counting;
using test::error_of;

class ReadVolumeTest : public test::ScratchFolder {};

ReadOptions raw_options() {
  ReadOptions options;
  options.dimensions = {5, 4, 3};
  options.type = "f32";
  return options;
}

TEST_F(ReadVolumeTest, MissingFilesFoldersAndDevices) {
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("none.nii")); }), "none.nii: no such file"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(folder_); }), "is a folder"));
  EXPECT_TRUE(contains(error_of([&] { read_volume("/dev/zero"); }), "not a regular file"));
  EXPECT_TRUE(contains(error_of([&] { read_volume(""); }), "no such file"));
}

TEST_F(ReadVolumeTest, AnUnknownExtensionNamesTheKnownOnes) {
  for (const char* name : {"brain.dat", "brain", "nii", "brain.gz", "brain.nii.bz2"}) {
    write(name, "bytes");
    const std::string text = error_of([&] { read_volume(path(name)); });
    for (const char* known :
         {".nii", ".nii.gz", ".hdr", ".img.gz", ".nrrd", ".nhdr", ".mha", ".mhd", ".npy", ".raw"}) {
      EXPECT_TRUE(contains(text, known)) << text;
    }
  }
}

TEST_F(ReadVolumeTest, ExtensionsInAnyCase) {
  write("a.RAW", test::bytes_of(counting()));
  test::expect_counting(read_volume(path("a.RAW"), raw_options()), "f32");
  write("a.Npy", "no such thing");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.Npy")); }), "numpy"));
}

TEST_F(ReadVolumeTest, HeaderlessDataOfAnyName) {
  write("matrix.dat", test::bytes_of(counting()));
  test::expect_counting(read_volume(path("matrix.dat"), raw_options()), "f32");
}

TEST_F(ReadVolumeTest, FilesAreReadAsMemoryIs) {
  ReadOptions options = raw_options();
  options.skip_bytes = 3;
  options.big_endian = true;
  write("a.raw", "abc" + test::swapped_bytes_of(counting()));
  const Volume volume = read_volume(path("a.raw"), options);
  test::expect_counting(volume, "f32");
  EXPECT_EQ(volume.description().name, path("a.raw").string());

  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5), }";
  header.resize(118, ' ');
  write("a.npy", std::string("\x93NUMPY\1\0\x76\0", 10) + header + test::bytes_of(counting()));
  test::expect_counting(read_volume(path("a.npy")), "f32");
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("a.npy"), raw_options()); }), "headerless"));
}

// A sparse file of the size that the options promise. It could be mapped, but what is built over it
// has no place in any machine's memory.
TEST_F(ReadVolumeTest, MoreThanTheMemoryIsRefused) {
  ReadOptions options = raw_options();
  options.dimensions = {16384, 8192, 8192};
  options.type = "f64";
  write("huge.raw", "");
  std::error_code error;
  std::filesystem::resize_file(path("huge.raw"), std::uintmax_t{1} << 43, error);
  if (error) GTEST_SKIP() << "the file system has no sparse files of this size";
  EXPECT_TRUE(contains(error_of([&] { read_volume(path("huge.raw"), options); }), "memory"));
}

#ifndef PELLUCID_HAVE_ITK
TEST_F(ReadVolumeTest, WithoutItkTheReasonIsSaid) {
  write("a.nrrd", "NRRD0004\n");
  write("a.mha", "NDims = 3\n");
  for (const char* name : {"a.nrrd", "a.mha"}) {
    const std::string error = error_of([&] { read_volume(path(name)); });
    EXPECT_TRUE(contains(error, "pellucid_itk.so")) << error;
    EXPECT_TRUE(contains(error, "libinsighttoolkit5-dev")) << error;
  }
}
#endif

}  // namespace
}  // namespace pellucid
