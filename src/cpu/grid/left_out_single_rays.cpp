// SPDX-License-Identifier: Apache-2.0
//
// Stands in for single_rays.cpp in builds for a first picture (PELLUCID_FIRST_PICTURE).
#include "pellucid/scene/internal/left_out.h"
#include "single_rays.h"

namespace pellucid {

bool has_single_rays() noexcept {
  return false;
}

std::vector<RayResult> trace_single_rays(const SingleRays&, const std::vector<RayPart>&,
                                         const RayTolerance&, const std::stop_token&) {
  throw left_out("what follows rays one by one");
}

}  // namespace pellucid
