// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

namespace pellucid {

/// The versions of the header: of 348 bytes without a mark, of 348 bytes, of 540 bytes.
enum class NiftiVersion { analyze, one, two };

/// The fields of a header as they are written, whatever its version. Sources: nifti1.h and nifti2.h
/// (https://nifti.nimh.nih.gov); for Analyze dbh.h of Mayo, and SPM for `origin`.
struct NiftiFields {
  NiftiVersion version = NiftiVersion::one;
  bool big_endian = false;
  bool single_file = true;  ///< header and values in one file
  std::array<std::int64_t, 8> dim{};
  int datatype = 0, intent = 0;
  std::array<double, 8> pixdim{};
  double time_offset = 0;  ///< toffset; 0 in Analyze
  double vox_offset = 0;
  double slope = 0, intercept = 0;
  int units = 0;
  int qform_code = 0, sform_code = 0;
  std::array<double, 6> qform{};   ///< quaternion b, c, d, offset x, y, z
  std::array<double, 12> sform{};  ///< three rows
  // Of Analyze alone.
  int orient = 0;
  std::array<int, 3> origin{};  ///< the voxel at the world's origin, from 1, as SPM has it
  bool has_ranges = false;      ///< whether glmax, glmin and cal_max, cal_min say a scale (SPM2)
};

/// Reads the header of a .nii or .hdr file, compressed or not. Throws Error for a file that begins
/// like none of the three.
NiftiFields read_nifti_fields(const std::filesystem::path& path);

}  // namespace pellucid
