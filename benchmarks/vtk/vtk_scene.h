// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>

#include <string>

#include "pellucid/scene/scene.h"

namespace pellucid::bench {

/// Why VTK cannot show a scene as render() does; empty where it can.
std::string not_for_vtk(const Scene& scene);

/// VTK's volume for the scene, shown by the mapper.
///
/// VTK's opacity function O is the opacity of a layer as thick as the unit distance u, linear
/// between its points, so that an extinction τ is O = 1 - exp(-τ u). Each stretch of the scene's
/// transfer function gets further points, for O is not linear where τ is; u is one voxel. Grid
/// directions become the volume's matrix, for the mappers do not look at those of vtkImageData. A
/// shading becomes VTK's, whose only light is at the camera. Isosurfaces become the mapper's blend
/// mode of that name, which shows no medium.
vtkSmartPointer<vtkVolume> vtk_volume(const Scene& scene, vtkVolumeMapper* mapper);

/// The scene's values, not copied: the scene must outlive them.
vtkSmartPointer<vtkImageData> vtk_image(const Scene& scene);

/// The scene's camera, and a background that is clear.
vtkSmartPointer<vtkRenderer> vtk_renderer(const Scene& scene);

}  // namespace pellucid::bench
