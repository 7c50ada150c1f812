// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Puts positions along the axis, those of the values or of the faces of cells by the
/// description's centering, into its placement, whose direction is there already. Where they are
/// uniform, to `rounding` (the largest relative error of each) and a millionth of their distance,
/// the axis becomes uniform, else rectilinear. Where they descend the axis is turned round. Throws
/// Error where they do neither throughout, or one is not finite.
void place_axis(Volume::Description& description, int axis, std::vector<double> positions,
                double rounding);

}  // namespace pellucid
