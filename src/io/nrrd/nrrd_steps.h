// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "nrrd_fields.h"
#include "volumes/volume_steps.h"

namespace pellucid::nrrd {

/// Returns the steps in time of a header as it stands in the file; no times where it has none. The
/// axis that holds them, `components_axis` (from 1; 0: the fourth), is one of kind "time", one that
/// runs along the time of its space, or one whose steps 3D Slicer numbers ("axis 0 index values",
/// MultiVolume.FrameLabels).
VolumeSteps steps_of(const Header& header, std::size_t components_axis);

}  // namespace pellucid::nrrd
