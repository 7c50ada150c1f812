// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "benchmarks/meshes/segment_integrator.h"

namespace pellucid::bench {

/// VTK's integrators of one segment, as its mappers call them: linear and partially pre-integrated.
/// Empty where the program was built without VTK.
std::vector<SegmentIntegrator> vtk_segment_integrators();

}  // namespace pellucid::bench
