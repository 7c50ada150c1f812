// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/read_volume.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "pellucid/io/dicom_series.h"
#include "pellucid/io/read_mesh.h"
#include "volume_files.h"

namespace pellucid::test_read_volume {
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

// Opening a pipe that nobody writes to waits for ever, and a device may have no end.
TEST_F(ReadVolumeTest, PipesAndDevicesAreRefusedAtOnce) {
  const auto expect_refused = [](const std::string& what, const auto& call) {
    const std::string text = error_of(call);
    EXPECT_TRUE(contains(text, what) && contains(text, "not a regular file")) << text;
  };
  const std::string extensions =
      volume_extensions() + " .vtu .pvtu .vts .vtm .pvd .ex2 .xyz .dat .x";
  for (std::size_t at = 0; at < extensions.size();) {
    const std::size_t end = std::min(extensions.find(' ', at), extensions.size());
    const std::filesystem::path pipe = path("a" + extensions.substr(at, end - at));
    SCOPED_TRACE(pipe);
    at = end + 1;
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    expect_refused("a pipe", [&] { read_volume(pipe); });
    expect_refused("a pipe", [&] { list_arrays(pipe); });
    expect_refused("a pipe", [&] { component_count(pipe, raw_options()); });
    expect_refused("a pipe", [&] { read_mesh(pipe); });
    is_mesh_file(pipe);
    is_dicom(pipe);
  }
  std::filesystem::create_symlink("/dev/zero", path("zero.npy"));
  expect_refused("a device", [&] { read_volume(path("zero.npy")); });
  EXPECT_FALSE(is_mesh_file(path("zero.npy")));
}

TEST_F(ReadVolumeTest, PipesThatOtherFilesNameAreRefusedAtOnce) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  const auto refused = [&](const std::string& name, const std::string& text) {
    write(name, text);
    const std::string message = error_of([&] { read_volume(path(name)); });
    EXPECT_TRUE(contains(message, "not a regular file")) << message;
  };
  refused("a.dat", "RawFile: pipe\nResolution: 5 4 3\nFormat: FLOAT\n");
#ifdef PELLUCID_HAVE_ITK
  const std::string nrrd = "NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 3\nendian: little\n";
  refused("a.nhdr", nrrd + "encoding: raw\ndata file: pipe\n");
  refused("b.nhdr", nrrd + "encoding: gzip\ndata file: pipe\n");
  refused("c.nhdr", nrrd + "encoding: raw\ndata file: LIST\npipe\npipe\npipe\n");
  refused("a.mhd",
          "ObjectType = Image\nNDims = 3\nDimSize = 5 4 3\nElementType = MET_FLOAT\n"
          "ElementDataFile = pipe\n");
#endif
#ifdef PELLUCID_HAVE_VTK
  refused("a.pvti",
          "<VTKFile type=\"PImageData\"><PImageData WholeExtent=\"0 4 0 3 0 2\">"
          "<Piece Extent=\"0 4 0 3 0 2\" Source=\"pipe\"/></PImageData></VTKFile>");
#endif
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
}  // namespace pellucid::test_read_volume
