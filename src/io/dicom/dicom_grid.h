// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "dicom_slices.h"
#include "pellucid/io/read_volume.h"

namespace pellucid {

/// Sorts the slices of a series by where they stand along their normal, and says where their grid
/// stands: distances are those of the positions, whatever the thickness. Slices at uneven distances
/// make a rectilinear grid. `options.note` is told what is assumed. Throws Error where two slices
/// stand at one place, one is out of line, or nothing says where they are. `some_left_out`: files
/// of the folder are not read, and slices may be missing for that.
Volume::Description place_dicom_slices(std::vector<DicomSlice>& slices, const ReadOptions& options,
                                       const std::string& name, bool some_left_out = false);

}  // namespace pellucid
