// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pellucid/geometry/vec3.h"
#include "pellucid/scene/error.h"

namespace pellucid {

/// Format of the values of an image (PS3.3, C.7.6.3).
struct DicomFormat {
  int columns = 0, rows = 0;
  int samples = 1;  ///< at each pixel: 3 of colors
  int bits_allocated = 0, bits_stored = 0, high_bit = 0;
  bool is_signed = false;
  bool floating = false;        ///< of 32 or 64 bits
  bool plane_by_plane = false;  ///< samples one behind the other, not side by side
  bool operator==(const DicomFormat&) const = default;
};

/// A file with pixels.
struct DicomImage {
  std::filesystem::path file;
  std::string study, series, description, modality, transfer_syntax, photometric;
  std::int64_t series_number = 0;
  DicomFormat format;
  int frames = 1;
  bool big_endian = false, encapsulated = false;
  std::uintmax_t pixel_offset = 0, pixel_bytes = 0;
  std::string refused;             ///< why its pixels are not read; empty: they are
  std::string unit;                ///< of the values: "Gy", "HU"; empty: not said
  std::vector<std::string> notes;  ///< what is assumed of it, a line each
};

/// One plane of values: a file, or a frame of it.
struct DicomSlice {
  std::shared_ptr<const DicomImage> image;
  int frame = 0;                         ///< from 0
  std::optional<double> number;          ///< InstanceNumber
  std::optional<Vec3<double>> position;  ///< of the centre of the first pixel, mm, LPS
  std::array<int, 3> decimals{};         ///< behind the points of the position, or of the location
  std::optional<double> location;        ///< SliceLocation
  /// Unit vectors in which columns and rows are counted.
  std::optional<std::array<Vec3<double>, 2>> orientation;
  std::optional<std::array<double, 2>> spacing;  ///< from column to column, from row to row; mm
  std::optional<double> distance;                ///< SpacingBetweenSlices
  std::optional<double> thickness;               ///< SliceThickness
  double slope = 1, intercept = 0;
  std::vector<std::string> marks;  ///< as dicom_mark_values() returns them

  /// Names the slice in messages: the file, and the frame where there are several.
  std::string name() const;
};

/// A file that cannot be read, and the message that says why.
struct DamagedDicomFile {
  std::filesystem::path file;
  std::string why;
};

/// Files that turn out to be damaged when their pixels are read. There is one at least.
class DamagedDicom : public Error {
 public:
  explicit DamagedDicom(std::vector<DamagedDicomFile> files)
      : Error(files.front().why), files_(std::move(files)) {}
  const std::vector<DamagedDicomFile>& files() const noexcept { return files_; }

 private:
  std::vector<DamagedDicomFile> files_;
};

/// Returns the slices of one file; none where it is no DICOM file, or one without pixels. Throws
/// Error where its header is damaged or its pixels are cut off.
std::vector<DicomSlice> read_dicom_slices(const std::filesystem::path& file);

/// Returns the bytes of one frame, uncompressed.
std::uintmax_t dicom_frame_bytes(const DicomFormat& format);

/// Throws Error where an uncompressed image has fewer bytes than so many frames need.
void check_dicom_pixels(const DicomImage& image, int frames);

}  // namespace pellucid
