// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nifti_fields.h"
#include "pellucid/scene/volume.h"
#include "volumes/volume_source.h"

namespace pellucid {

/// Values as a header of NIfTI or Analyze describes them.
struct NiftiHeader {
  NiftiVersion version = NiftiVersion::one;
  bool single_file = true;  ///< header and values in one file
  std::array<std::int64_t, 3> dimensions{};
  ValueLayout layout;
  std::string holds;                ///< what its several components are
  std::vector<double> times;        ///< times of its steps; empty: its components are none
  std::string time_unit;            ///< "s"; empty: it says none
  double slope = 1, intercept = 0;  ///< value = slope · stored + intercept; 1, 0: as stored
  std::array<double, 3> spacing{};  ///< as written, maybe not positive
  double unit = 1;                  ///< of lengths, in millimetres
  /// The affine map of the sform, where there is one, its world turned from RAS to LPS, in the
  /// file's unit.
  std::optional<GridPlacement> sform;
  std::optional<GridPlacement> qform;  ///< as the sform
  std::array<int, 3> origin{};         ///< of Analyze: the voxel at the world's origin, from 1
  std::vector<std::string> notes;      ///< what a reader should know, a line each
};

/// Reads and checks the header of a .nii or .hdr file, compressed or not. Throws Error.
NiftiHeader read_nifti_header(const std::filesystem::path& path);

/// The two files of a .hdr/.img pair, whichever of them is given; twice the path for one file.
struct NiftiFiles {
  std::filesystem::path header, values;
};
NiftiFiles find_nifti_files(const std::filesystem::path& path);

}  // namespace pellucid
