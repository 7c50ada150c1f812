// SPDX-License-Identifier: Apache-2.0
#include "dicom_values.h"
#include "pellucid/scene/error.h"

#ifndef PELLUCID_HAVE_GDCM

namespace pellucid {

std::vector<std::byte> decode_dicom(const DicomImage& image) {
  throw Error(image.file.string() +
              ": its pixels are compressed, and this build has no GDCM, which decompresses them; "
              "decompress it, with gdcmconv --raw or dcmdjpeg");
}

}  // namespace pellucid

#else

#include <gdcmImageReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <exception>
#include <mutex>

#include "memory_limit.h"

namespace pellucid {

namespace {

// GDCM tells on stderr what it thinks of a file; a library has nothing to say there. The switches
// are the whole program's, so one file is read at a time.
class Silence {
 public:
  Silence()
      : lock_(mutex()),
        debug_(gdcm::Trace::GetDebugFlag()),
        warning_(gdcm::Trace::GetWarningFlag()),
        error_(gdcm::Trace::GetErrorFlag()) {
    set(false, false, false);
  }
  ~Silence() { set(debug_, warning_, error_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  static void set(bool debug, bool warning, bool error) {
    gdcm::Trace::SetDebug(debug);
    gdcm::Trace::SetWarning(warning);
    gdcm::Trace::SetError(error);
  }
  std::lock_guard<std::mutex> lock_;
  bool debug_, warning_, error_;
};

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

std::vector<std::byte> decode(const DicomImage& image, std::uintmax_t bytes) {
  gdcm::ImageReader reader;
  reader.SetFileName(image.file.c_str());
  if (!reader.Read()) return {};
  const gdcm::Image& decoded = reader.GetImage();
  const DicomFormat& format = image.format;
  const auto side = [&](unsigned axis) {
    return static_cast<std::uintmax_t>(decoded.GetDimension(axis));
  };
  const std::uintmax_t frames = decoded.GetNumberOfDimensions() > 2 ? side(2) : 1;
  if (side(0) != static_cast<std::uintmax_t>(format.columns) ||
      side(1) != static_cast<std::uintmax_t>(format.rows) ||
      frames != static_cast<std::uintmax_t>(image.frames) ||
      decoded.GetPixelFormat().GetBitsAllocated() != format.bits_allocated ||
      decoded.GetPixelFormat().GetSamplesPerPixel() != format.samples ||
      decoded.GetBufferLength() != bytes) {
    throw Error(image.file.string() +
                ": its compressed pixels are of another size or type than its header says");
  }
  std::vector<std::byte> values(bytes);
  if (!decoded.GetBuffer(reinterpret_cast<char*>(values.data()))) return {};
  const bool planes = format.samples > 1 && decoded.GetPlanarConfiguration() == 1;
  return planes ? side_by_side(values, format, image.frames) : values;
}

}  // namespace

std::vector<std::byte> decode_dicom(const DicomImage& image) {
  const std::string name = image.file.string();
  const DicomFormat& format = image.format;
  const std::uintmax_t bytes =
      std::uintmax_t{static_cast<unsigned>(format.columns)} * static_cast<unsigned>(format.rows) *
      static_cast<unsigned>(format.samples) * static_cast<unsigned>(format.bits_allocated / 8) *
      static_cast<unsigned>(image.frames);
  // Decompressed, and once more with colors side by side.
  check_memory(2 * bytes, name + ": its pixels");
  const Silence silence;
  std::vector<std::byte> values;
  try {
    values = decode(image, bytes);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    values.clear();
  }
  if (values.empty()) {
    throw Error(name + ": cannot decompress its pixels (transfer syntax " + image.transfer_syntax +
                "); decompress the file with another program, or get it again");
  }
  return values;
}

}  // namespace pellucid

#endif
