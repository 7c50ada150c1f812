// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "benchmarks/frames/contender.h"
#include "pellucid/scene/scene.h"

namespace pellucid::bench {

struct VtkContenders {
  std::vector<Contender> list;
  std::string left_out;  ///< what cannot run here and why; empty: nothing
};

/// VTK's mappers for structured data on the processor, made to show the same scene as render():
///
///   "VTK fixed point"  vtkFixedPointVolumeRayCastMapper
///   "VTK GPU mapper"   vtkGPUVolumeRayCastMapper, into a target of floats
///   "VTK smart"        vtkSmartVolumeMapper as it is by default; its one setting is its step
///
/// The latter two need OpenGL and so a display: Mesa's software renderer under Xvfb serves.
/// `threads` is for all of VTK, and for Mesa where the first call of the program sets it.
VtkContenders vtk_contenders(const Scene& scene, const std::vector<double>& steps, int threads);

/// "VTK 9.1.0", or "" where the program was built without it.
std::string vtk_version();

}  // namespace pellucid::bench
