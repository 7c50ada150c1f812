// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "ghost_cells.h"
#include "grid_data.h"
#include "vtk_scene/fit_tables.h"
#include "vtk_scene/grid_layers.h"

class vtkDataSet;
class vtkImageData;
class vtkVolume;
class vtkVolumeMapper;

namespace pellucid::plugin {

/// A mask of vtkGPUVolumeRayCastMapper: labels at the points of the volume.
struct MaskImage {
  vtkImageData* labels = nullptr;  ///< null: none
  bool is_binary = false;          ///< shows the volume where a label is not 0
  double blend = 1;                ///< the share of a label's own color
};

/// Data that pictures of a grid share.
struct KeptOfGrids {
  KeptGrids volumes, labels;
  KeptLooks looks;
  KeptFits fits;
  KeptOwnCells own_cells;

  void keep_used();
};

/// Returns the layers of a volume, as vtk_scene::layers_of(). No data give none. Throws Error.
std::vector<TableLayer> layers_of(vtkVolumeMapper& mapper, vtkDataSet* data, vtkVolume& volume,
                                  const MaskImage& mask, double tolerance, bool has_ambient_light,
                                  KeptOfGrids& kept, Notes& notes);

}  // namespace pellucid::plugin
