// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/clip.h"
#include "real.h"

namespace pellucid::reference {

/// A part of a ray, world arc length.
struct RayPart {
  Real begin, end;
};

/// Returns the parts of a ray (direction of length 1) at t >= 0 that all clips keep, front to back.
std::vector<RayPart> kept_parts(const RealRay& ray, const std::vector<const Clip*>& clips);

}  // namespace pellucid::reference
