// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vtkSmartPointer.h>
#include <vtkType.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "settings.h"
#include "vtk_scene/mesh_layers.h"

class vtkCellArray;
class vtkDataArray;
class vtkUnstructuredGridVolumeMapper;
class vtkVolume;

namespace pellucid::plugin {

/// Data that pictures of a mesh share. Its tetrahedra are cut again if the grid or its values
/// changed.
struct KeptOfMeshes {
  std::shared_ptr<const MeshChannels> mesh;
  vtkSmartPointer<vtkDataArray> array;
  vtkMTimeType time = 0;
  std::uint64_t fingerprint = 0;      ///< of the values
  std::array<vtkIdType, 2> counts{};  ///< of points and cells
  vtkSmartPointer<vtkCellArray> cells;
  int made = 0;  ///< how often it was cut
  KeptMeshLooks looks;
};

/// Returns the layer of a volume, as vtk_scene::layer_of(); none if the mapper has no input, or one
/// of ghosts alone. Throws Error.
std::vector<TableLayer> layers_of(vtkUnstructuredGridVolumeMapper& mapper, vtkVolume& volume,
                                  double tolerance, KeptOfMeshes& kept, Notes& notes);

}  // namespace pellucid::plugin
