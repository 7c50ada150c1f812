// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dicom_elements.h"
#include "pellucid/geometry/vec3.h"

namespace pellucid {

/// Positions of the frames of a file that has one position for all of them.
struct DicomFrameOffsets {
  std::vector<double> offset;  ///< of each frame from the first, mm; empty where `refused` is not
  bool along_z = false;        ///< offsets run along the patient's z axis, else along the normal
  std::string refused;         ///< why the positions are not known; empty: they are
  std::string note;            ///< what is assumed; empty: nothing
};

/// Reads them from the vector that the file has: GridFrameOffsetVector of a dose (PS3.3,
/// C.8.8.3.2), SliceLocationVector, SliceVector of nuclear medicine (C.8.4.15); else frames stand
/// SpacingBetweenSlices apart. `normal` is the direction of the planes' normal, `position` that of
/// the first frame where the file has one.
DicomFrameOffsets dicom_frame_offsets(const DicomDataSet& data, int frames,
                                      const Vec3<double>& normal,
                                      const std::optional<Vec3<double>>& position);

}  // namespace pellucid
