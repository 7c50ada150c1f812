// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "benchmarks/meshes/mesh_contender.h"
#include "benchmarks/meshes/mesh_scenes.h"

namespace pellucid::bench {

/// A mesh as VTK's mappers want it, with what they make of it and keep.
struct VtkMesh;

/// `tetrahedra`: with one array of points; `bounds`: of those that cells use. Null where the
/// program was built without VTK.
std::shared_ptr<VtkMesh> vtk_mesh(const UnstructuredGrid& tetrahedra, const Box<double>& bounds);

/// VTK's mappers for unstructured data on the processor, through Render() without the drawing of
/// the picture, so that no display is needed. Its opacity is attenuation per unit distance here, so
/// that both functions are the scene's own. Rays go through the lower left corners of pixels there:
/// the camera is moved by half a pixel.
///
///   "VTK linear"   vtkUnstructuredGridVolumeRayCastMapper, vtkUnstructuredGridLinearRayIntegrator
///   "VTK default"  the same mapper with the integrator that it takes by itself
///   "VTK ZSweep"   vtkUnstructuredGridVolumeZSweepMapper, which knows no threads
///
/// Pictures have 8 bits. Of scenes with a parallel camera.
std::vector<MeshContender> vtk_mesh_contenders(const std::shared_ptr<VtkMesh>& mesh,
                                               const MeshScene& shown);

}  // namespace pellucid::bench
