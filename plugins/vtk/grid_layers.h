// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "ghost_cells.h"
#include "grid_data.h"
#include "look.h"
#include "nearest_values.h"
#include "notes.h"
#include "pellucid/scene/channels.h"
#include "pellucid/scene/label_volume.h"
#include "pellucid/scene/layer.h"

class vtkDataSet;
class vtkImageData;
class vtkVolume;
class vtkVolumeMapper;

namespace pellucid::plugin {

/// A mask of vtkGPUVolumeRayCastMapper: labels at the points of the volume.
struct Mask {
  vtkImageData* labels = nullptr;  ///< null: none
  bool is_binary = false;          ///< shows the volume where a label is not 0
  double blend = 1;                ///< the share of a label's own color
};

/// Data that pictures of a grid share.
struct KeptOfGrids {
  using MaskRecipe =
      std::pair<std::shared_ptr<const Volume>,
                std::vector<std::pair<std::int32_t, std::shared_ptr<const TransferFunction>>>>;

  KeptGrids volumes, labels;
  Kept<std::vector<std::shared_ptr<const Volume>>, Channels> channels;
  KeptFunctions functions;
  Kept<DependentRecipe, MultivariateTransferFunction> dependent;
  Kept<std::shared_ptr<const Volume>, NearestValues> nearest;
  Kept<std::pair<LookRecipe, std::vector<ValueLook>>, LabelTable> label_tables;
  KeptCurves curves;
  Kept<Curve, GradientOpacity> gradients;
  Kept<MaskRecipe, LabelMask> masks;
  KeptOwnCells own_cells;

  void keep_used();
};

/// Returns the layers of a volume: one for each component and each box of the mapper's cropping. No
/// data, or a component of weight 0, gives none. Dependent components are one layer. Throws Error
/// for what has no counterpart: functions of two variables, say.
/// `has_ambient_light`: whether a property's ambient part is seen (has_ambient_light()).
std::vector<Layer> layers_of(vtkVolumeMapper& mapper, vtkDataSet* data, vtkVolume& volume,
                             const Mask& mask, double tolerance, bool has_ambient_light,
                             KeptOfGrids& kept, Notes& notes);

}  // namespace pellucid::plugin
