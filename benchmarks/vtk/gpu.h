// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkImageData.h>
#include <vtkRenderer.h>

#include "benchmarks/frames/contender.h"
#include "pellucid/scene/scene.h"

namespace pellucid::bench {

/// Whether an OpenGL context can be made here, and by whom it is ("llvmpipe …"). Once it has failed
/// the answer stays.
bool opengl_works(std::string* renderer_name);

/// vtkGPUVolumeRayCastMapper at fixed steps and vtkSmartVolumeMapper at its default, into a target
/// of floats. Timed from Render() to the end of all drawing, after a frame that warms up.
std::vector<Contender> gpu_contenders(const Scene& scene, vtkImageData* image);

}  // namespace pellucid::bench
