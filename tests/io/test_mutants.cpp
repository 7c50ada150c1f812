// SPDX-License-Identifier: Apache-2.0
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "dicom_files.h"
#include "image_files.h"
#include "mutants.h"
#include "pellucid/io/read_volume.h"
#include "sanitized.h"

// Thousands of damaged files in a process of their own: each is read or refused by an Error, none
// ends the process, takes longer than seconds or more memory than it is given.
namespace pellucid {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::counting;

/// How many files of each kind; PELLUCID_TEST_MUTANTS sets another number.
std::uint64_t mutant_count() {
  const char* number = std::getenv("PELLUCID_TEST_MUTANTS");
  return number == nullptr ? 1000 : std::strtoull(number, nullptr, 10);
}

class MutantsTest : public test::ScratchFolder {
 protected:
  /// Writes each mutant as `file` and reads `input`.
  void survive(std::vector<std::string> seeds, const std::string& file, const fs::path& input) {
    test::Mutants mutants(std::move(seeds));
    auto* const at = static_cast<std::uint64_t*>(mmap(
        nullptr, sizeof(std::uint64_t), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
    ASSERT_NE(at, MAP_FAILED);
    const std::uint64_t count = mutant_count();
    for (std::uint64_t first = 0; first < count; first = *at + 1) {
      const pid_t child = fork();
      ASSERT_GE(child, 0);
      if (child == 0) read_all(mutants, first, count, file, input, at);
      int status = 0;
      waitpid(child, &status, 0);
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
      const std::string kept = "mutant-" + std::to_string(*at) + "-" + file;
      std::ofstream(kept, std::ios::binary) << mutants(*at);
      ADD_FAILURE() << "mutant " << *at << " (kept as " << kept << ") ended the process by "
                    << (WIFSIGNALED(status) ? "signal " : "status ")
                    << (WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
    }
    munmap(at, sizeof(std::uint64_t));
  }

 private:
  [[noreturn]] void read_all(test::Mutants& mutants, std::uint64_t first, std::uint64_t count,
                             const std::string& file, const fs::path& input, std::uint64_t* at) {
#ifndef PELLUCID_SANITIZED
    const rlimit memory{rlim_t{2} << 30, rlim_t{2} << 30};
    setrlimit(RLIMIT_AS, &memory);
#endif
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    constexpr unsigned seconds = 30;  // a sanitizer is slow
    for (*at = first; *at < count; ++*at) {
      write(file, mutants(*at));
      alarm(seconds);
      try {
        const std::vector<Volume> volumes = read_components(input);
        if (volumes.empty()) _exit(3);
      } catch (const Error&) {
        // As it should be. Anything else ends the process.
      }
    }
    _exit(0);
  }
};

test::DicomSliceFile dicom_slice(int k) {
  test::DicomSliceFile file;
  file.at("10\\20\\" + std::to_string(30 + 12 * k)).set(0x00281053, "1").set(0x00281052, "-9");
  file.pixels = std::string(40, static_cast<char>(k));
  return file;
}

TEST_F(MutantsTest, Dicom) {
  for (const int k : {0, 2}) write("slice" + std::to_string(k), dicom_slice(k).bytes());
  test::DicomSliceFile plain = dicom_slice(1), is_implicit = plain, big = plain, frames = plain;
  is_implicit.syntax = "1.2.840.10008.1.2";
  is_implicit.undefined_lengths = true;
  big.syntax = "1.2.840.10008.1.2.2";
  const test::DicomWriter w;
  frames.text[0x00280008] = {"IS", "2"};
  frames.pixels.resize(80);
  for (const char* place : {"1\\2\\3", "1\\2\\4"}) {
    frames.sequences[0x52009230].push_back(
        w.sequence(0x00209113, {w.element(0x00200032, "DS", place)}));
  }
  survive({plain.bytes(), is_implicit.bytes(), big.bytes(), frames.bytes()}, "slice1", folder_);
}

#ifdef PELLUCID_HAVE_GDCM
TEST_F(MutantsTest, CompressedDicom) {
  test::DicomSliceFile file = dicom_slice(0);
  file.syntax = "1.2.840.10008.1.2.5";
  file.encapsulated = true;
  file.pixels = test::fragments({test::run_length_encoded(std::vector<std::uint16_t>(20, 7))});
  write("slice1", dicom_slice(1).bytes());
  survive({file.bytes()}, "slice0", folder_);
}
#endif

TEST_F(MutantsTest, Tiff) {
  std::vector<std::string> seeds;
  for (const std::uint32_t compression : {1U, 8U}) {
    for (const bool tiled : {false, true}) {
      test::TiffFile file(tiled);
      for (int k = 0; k < 2; ++k) {
        test::TiffPage page = test::counting_page<std::uint16_t>(k, 1, tiled);
        if (tiled) {
          page.tiled = true;
          page.fields.erase(278);
          page.fields[322] = page.fields[323] = {16};
          page.strips[0].resize(512);
        }
        page.fields[259] = {compression};
        page.fields[317] = {compression == 8 ? 2U : 1U};
        if (compression == 8) page.strips[0] = test::deflated(page.strips[0], 15);
        file.add(page);
      }
      seeds.push_back(file.bytes());
    }
  }
  survive(seeds, "a.tif", path("a.tif"));
}

TEST_F(MutantsTest, Png) {
  write("a1.png", test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(1)));
  survive({test::png(5, 4, 8, 0, test::page_values<std::uint8_t>(0)),
           test::png(5, 4, 16, 0, test::page_values<std::uint16_t>(0, true)),
           test::png(5, 4, 8, 2, std::string(60, '\7'))},
          "a0.png", path("a0.png"));
}

TEST_F(MutantsTest, Mrc) {
  std::string header(1024, '\0');
  const auto put = [&](std::size_t word, auto value) {
    std::memcpy(&header[4 * (word - 1)], &value, 4);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    put(1 + i, std::int32_t{4});
    put(8 + i, std::int32_t{4});
    put(11 + i, 4.F);
    put(14 + i, 90.F);
    put(17 + i, static_cast<std::int32_t>(i + 1));
  }
  put(54, std::int32_t{0x4444});
  survive({header + std::string(64, '\1')}, "a.mrc", path("a.mrc"));
}

TEST_F(MutantsTest, Npy) {
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5), }";
  header.resize(118, ' ');
  survive({std::string("\x93NUMPY\1\0\x76\0", 10) + header + bytes_of(counting())}, "a.npy",
          path("a.npy"));
}

#ifdef PELLUCID_HAVE_ITK
TEST_F(MutantsTest, Nifti) {
  test::NiftiFile oblique;
  oblique.qform_code = 1;
  oblique.qform = {0.1F, 0.2F, 0.3F, 1, 2, 3};
  const std::string plain = test::NiftiFile{}.with(bytes_of(counting()));
  survive({plain, oblique.with(bytes_of(counting()))}, "a.nii", path("a.nii"));
  survive({test::gzipped(plain)}, "a.nii.gz", path("a.nii.gz"));
}

TEST_F(MutantsTest, Nrrd) {
  const std::string header =
      "NRRD0004\ntype: float\ndimension: 3\nsizes: 5 4 3\nendian: little\nspace: LPS\n"
      "space directions: (1,0,0) (0,2,0) (0,0,3)\nspace origin: (1,2,3)\nencoding: ";
  survive({header + "raw\n\n" + bytes_of(counting()),
           header + "gzip\n\n" + test::gzipped(bytes_of(counting())),
           header + "ascii\nkinds: domain domain domain\n\n1 2 3 4 5 6 7 8 9"},
          "a.nrrd", path("a.nrrd"));
}

TEST_F(MutantsTest, MetaImage) {
  const std::string header =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\nElementSpacing = 1 2 3\n"
      "DimSize = 5 4 3\nElementType = MET_FLOAT\n";
  survive({header + "ElementDataFile = LOCAL\n" + bytes_of(counting()),
           header + "CompressedData = True\nElementDataFile = LOCAL\n" +
               test::deflated(bytes_of(counting()), 15)},
          "a.mha", path("a.mha"));
}
#endif

}  // namespace
}  // namespace pellucid
