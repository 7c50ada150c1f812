// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "benchmarks/light/subject.h"
#include "benchmarks/support/frame_arguments.h"

/// VTK's GPU mapper in the same light as ours, at finer and finer steps. Its normal has length 1
/// wherever there is a gradient, so flatness is 0. Its light shines along the camera, so the camera
/// is parallel.
namespace pellucid::bench {

/// How far VTK is from the exact picture, in light and without: with the subject's function, and
/// with one that rises evenly over all values, which VTK's tables hold well.
void compare_light_with_vtk(const Subject& subject, const FrameArguments& arguments);

/// Time and difference of an opaque isosurface in light, ours at 1/512 and VTK's blend mode.
void compare_surface_with_vtk(const Subject& subject, const FrameArguments& arguments);

}  // namespace pellucid::bench
