// SPDX-License-Identifier: Apache-2.0
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "pellucid/io/read_volume.h"
#include "tests/io/mutants/sanitized.h"
#include "volume_files.h"

// How much memory reading a volume takes at most: the data once, in its own type.
#ifndef PELLUCID_SANITIZED

namespace pellucid::test_peak_memory {
namespace {

constexpr std::size_t kibi = 1024;
constexpr std::size_t megabytes_of_data = 64;

/// "VmHWM" and the like of /proc/self/status, in KiB; 0 where there is none.
std::size_t status_of_process(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string line;
  while (std::getline(status, line)) {
    if (line.starts_with(name + ":")) return std::stoul(line.substr(name.size() + 1));
  }
  return 0;
}

/// What the peak of memory rises by, in a child process of its own, in KiB. What `prepare` leaves
/// behind does not count: the code of libraries that are called for the first time.
std::size_t peak_of(const std::function<void()>& prepare, const std::function<void()>& work) {
  int ends[2];
  if (pipe(ends) != 0) return 0;
  const pid_t child = fork();
  if (child == 0) {
    std::size_t rise = 0;
    try {
      prepare();
      const std::size_t before = status_of_process("VmRSS");
      work();
      rise = status_of_process("VmHWM") - before;
    } catch (...) {
    }
    _exit(write(ends[1], &rise, sizeof rise) == sizeof rise ? 0 : 1);
  }
  std::size_t rise = 0;
  close(ends[1]);
  if (read(ends[0], &rise, sizeof rise) != sizeof rise) rise = 0;
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return rise;
}

class PeakMemory : public test::ScratchFolder {
 protected:
  void SetUp() override {
    test::ScratchFolder::SetUp();
    if (status_of_process("VmHWM") == 0) GTEST_SKIP() << "the peak of memory is not known";
  }
  /// `head`, and behind it so many MiB of data that is neither constant nor hard to compress.
  void write_large(const std::string& name, const std::string& head, std::size_t mebibytes,
                   bool packed = false) const {
    std::vector<char> part(kibi * kibi);
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<char>(i / 5 % 101);
    // "T" writes as it is.
    gzFile file = gzopen(path(name).c_str(), packed ? "wb1" : "wbT");
    if (!head.empty()) gzwrite(file, head.data(), static_cast<unsigned>(head.size()));
    for (std::size_t i = 0; i < mebibytes; ++i) {
      part[i] = 1;
      gzwrite(file, part.data(), static_cast<unsigned>(part.size()));
    }
    gzclose(file);
  }
  void expect_once(const std::string& name, const ReadOptions& options = {}) const {
    const std::size_t rise = peak_of(
        [&] {
          if (component_count(path(name), options) != 1) throw 0;
        },
        [&] {
          const Volume volume = read_volume(path(name), options);
          const Histogram histogram = volume.histogram(256);
          if (histogram.count.size() != 256) throw 0;
        });
    // Less would mean that the data was not looked at.
    EXPECT_GE(rise, megabytes_of_data * kibi * 9 / 10) << name;
    EXPECT_LE(rise, megabytes_of_data * kibi * 11 / 10) << name;
  }
};

ReadOptions raw(const std::string& type, const std::array<int, 3>& dimensions, bool big_endian) {
  ReadOptions options;
  options.type = type;
  options.dimensions = dimensions;
  options.big_endian = big_endian;
  return options;
}

TEST_F(PeakMemory, MappedOrReadTheDataIsThereOnce) {
  write_large("a.raw", "", megabytes_of_data);
  expect_once("a.raw", raw("u8", {512, 512, 256}, false));
  expect_once("a.raw", raw("u16", {512, 256, 256}, false));
  expect_once("a.raw", raw("u16", {512, 256, 256}, true));  // read, and turned in place
  std::string header = "{'descr': '<i4', 'fortran_order': False, 'shape': (256, 256, 256), }";
  header.resize(118, ' ');
  write_large("a.npy", std::string("\x93NUMPY\1\0\x76\0", 10) + header, megabytes_of_data);
  expect_once("a.npy");
}

#ifdef PELLUCID_HAVE_VTK

// The process that calls VTK hands its values over in place.
TEST_F(PeakMemory, VtkImages) {
  const std::uint64_t bytes = megabytes_of_data * kibi * kibi;
  const std::string extent = "\"0 511 0 511 0 255\"";
  write_large("a.vti",
              "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
              "header_type=\"UInt64\"><ImageData WholeExtent=" +
                  extent + " Origin=\"0 0 0\" Spacing=\"1 1 1\"><Piece Extent=" + extent +
                  "><PointData><DataArray type=\"UInt8\" Name=\"v\" format=\"appended\" "
                  "offset=\"0\"/></PointData></Piece></ImageData><AppendedData encoding=\"raw\">_" +
                  test::bytes_of(std::vector{bytes}),
              megabytes_of_data);
  std::ofstream(path("a.vti"), std::ios::binary | std::ios::app) << "</AppendedData></VTKFile>";
  expect_once("a.vti");
}

#endif

#ifdef PELLUCID_HAVE_ITK

TEST_F(PeakMemory, CompressedDataIsInflatedIntoItsPlace) {
  test::NiftiFile file;
  file.dim = {3, 512, 512, 256, 1, 1, 1, 1};
  file.datatype = 2;
  file.bitpix = 8;
  write_large("a.nii.gz", file.with(""), megabytes_of_data, true);
  expect_once("a.nii.gz");
  write_large("a.nii", file.with(""), megabytes_of_data);
  expect_once("a.nii");
  // Scaled: 32 MiB of 16 bits become 64 of float.
  file.dim = {3, 256, 256, 256, 1, 1, 1, 1};
  file.datatype = 4;
  file.bitpix = 16;
  file.slope = 0.5;
  write_large("s.nii.gz", file.with(""), megabytes_of_data / 2, true);
  expect_once("s.nii.gz");
}

TEST_F(PeakMemory, Nrrd) {
  const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 512 512 256\nspacings: 1 1 1\nencoding: ";
  write_large("a.nrrd", header + "raw\n\n", megabytes_of_data);
  expect_once("a.nrrd");
  write_large("a.raw.gz", "", megabytes_of_data, true);
  write("b.nhdr", header + "gzip\ndata file: a.raw.gz\n\n");
  expect_once("b.nhdr");
}

#endif

}  // namespace
}  // namespace pellucid::test_peak_memory

#endif
