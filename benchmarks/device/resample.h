// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/volume.h"

namespace pellucid::bench {

/// Returns the volume in the same box with `points` values along each axis, trilinear between the
/// given ones, in their own type: integers are rounded. Throws Error unless the values are points
/// of a uniform grid and there are at least two along each axis.
Volume resampled(const Volume& volume, int points);

}  // namespace pellucid::bench
