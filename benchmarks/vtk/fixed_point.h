// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkImageData.h>
#include <vtkRenderer.h>

#include "benchmarks/frames/contender.h"
#include "pellucid/scene/scene.h"

namespace pellucid::bench {

/// vtkFixedPointVolumeRayCastMapper, through the steps of its Render() without the last, which
/// shows the picture in a window: what is timed is ray casting alone, and no display is needed. The
/// picture is taken as cast, with 15 bits.
Contender fixed_point_contender(const Scene& scene, vtkRenderer* renderer, vtkImageData* image,
                                int threads);

}  // namespace pellucid::bench
