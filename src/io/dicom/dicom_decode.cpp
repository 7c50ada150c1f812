// SPDX-License-Identifier: Apache-2.0
#include "dicom_values.h"
#include "pellucid/scene/error.h"

#ifndef PELLUCID_HAVE_GDCM

namespace pellucid {

std::shared_ptr<const std::byte> decode_dicom(const DicomImage& image) {
  throw Error(image.file.string() +
              ": its pixels are compressed, and this build has no GDCM, which decompresses them; "
              "decompress it, with gdcmconv --raw or dcmdjpeg");
}

}  // namespace pellucid

#else

#include <gdcmImageReader.h>

#include <algorithm>
#include <span>

#include "files/input_file.h"
#include "files/memory_limit.h"
#include "process/child_process.h"

namespace pellucid {

namespace {

// RGBRGB… out of R…G…B… frame by frame.
std::vector<std::byte> side_by_side(const std::vector<std::byte>& planes, const DicomFormat& format,
                                    int frames) {
  const auto size = static_cast<std::size_t>(format.bits_allocated / 8);
  const auto samples = static_cast<std::size_t>(format.samples);
  const std::size_t pixels =
      static_cast<std::size_t>(format.columns) * static_cast<std::size_t>(format.rows);
  std::vector<std::byte> result(planes.size());
  for (std::size_t frame = 0; frame < static_cast<std::size_t>(frames); ++frame) {
    const std::size_t begin = frame * pixels * samples;
    for (std::size_t s = 0; s < samples; ++s) {
      for (std::size_t i = 0; i < pixels; ++i) {
        const auto from =
            planes.begin() + static_cast<std::ptrdiff_t>((begin + s * pixels + i) * size);
        std::copy_n(from, size,
                    result.begin() + static_cast<std::ptrdiff_t>((begin + i * samples + s) * size));
      }
    }
  }
  return result;
}

// Whether the values were written to `to`.
bool decode(const DicomImage& image, std::span<std::byte> to) {
  gdcm::ImageReader reader;
  reader.SetFileName(image.file.c_str());
  if (!reader.Read()) return false;
  const gdcm::Image& decoded = reader.GetImage();
  const DicomFormat& format = image.format;
  const auto is = [&](unsigned axis, int side) {
    return decoded.GetDimension(axis) == static_cast<unsigned>(side);
  };
  const bool has_frames =
      decoded.GetNumberOfDimensions() > 2 ? is(2, image.frames) : image.frames == 1;
  if (!is(0, format.columns) || !is(1, format.rows) || !has_frames ||
      decoded.GetPixelFormat().GetBitsAllocated() != format.bits_allocated ||
      decoded.GetPixelFormat().GetSamplesPerPixel() != format.samples ||
      decoded.GetBufferLength() != to.size() ||
      !decoded.GetBuffer(reinterpret_cast<char*>(to.data()))) {
    return false;
  }
  if (format.samples > 1 && decoded.GetPlanarConfiguration() == 1) {
    const std::vector<std::byte> planes(to.begin(), to.end());
    std::ranges::copy(side_by_side(planes, format, image.frames), to.begin());
  }
  return true;
}

}  // namespace

std::shared_ptr<const std::byte> decode_dicom(const DicomImage& image) {
  const std::string name = image.file.string();
  const DicomFormat& format = image.format;
  std::uintmax_t bytes = static_cast<std::uintmax_t>(format.bits_allocated / 8);
  for (const int factor : {format.columns, format.rows, format.samples, image.frames}) {
    bytes *= static_cast<std::uintmax_t>(factor);
  }
  // Where they are decompressed, and planes beside them.
  check_memory(2 * bytes, name + ": its pixels");
  // GDCM 3.0.21 crashes on damaged files, some 8 of 1000 (docs/reference/limitations.md).
  return run_in_child(
      bytes, [&](std::span<std::byte> to) { return decode(image, to); },
      check_input_file(image.file));
}

}  // namespace pellucid

#endif
