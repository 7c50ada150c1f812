// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "grid_layers.h"
#include "pellucid/scene/mesh_channels.h"

namespace pellucid::vtk_scene {

/// A vtkVolume of an unstructured grid.
struct MeshVolume {
  std::shared_ptr<const MeshChannels> mesh;  ///< of the array that is shown
  PropertySettings property;                 ///< of one component
  MapperSettings mapper;
  Matrix matrix{};
};

/// Objects that pictures of a mesh share.
struct KeptMeshLooks {
  KeptFunctions functions;
  KeptCurves curves;
};

/// Throws Error for arrays of several components, of which none is chosen, and for no array.
void check_mesh_array(int components, const std::string& class_name);
/// Returns the layer of a volume. Opacity / unit distance is the extinction, as VTK's mappers of
/// unstructured grids take it. Throws Error.
Layer layer_of(const MeshVolume& volume, double tolerance, KeptMeshLooks& kept, Notes& notes);

}  // namespace pellucid::vtk_scene
