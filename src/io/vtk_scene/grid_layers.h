// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ghost_cells.h"
#include "look.h"
#include "nearest_values.h"
#include "notes.h"
#include "pellucid/scene/channels.h"
#include "pellucid/scene/label_volume.h"
#include "pellucid/scene/layer.h"
#include "settings.h"

namespace pellucid::vtk_scene {

/// An image or a rectilinear grid, and the array of it that a mapper shows.
struct GridData {
  std::string class_name;  ///< VTK's, of the grid
  int components = 0;      ///< number of those of the array; 0: there is none
  int type = 0;            ///< VTK's number of the array's type
  std::string type_name{};
  std::vector<std::array<double, 2>> ranges{};  ///< ranges of the finite values of each component
  /// Returns the volume of a component.
  std::function<std::shared_ptr<const Volume>(int component)> volume{};
  std::optional<GhostCells> ghosts{};  ///< none: no cell is a ghost
};

/// A mask of vtkGPUVolumeRayCastMapper.
struct Mask {
  std::shared_ptr<const Volume> labels{};  ///< at the places of the data; null: there is none
  bool is_binary = false;                  ///< shows the volume where a label is not 0
  double blend = 1;                        ///< the share of a label's own color
};

/// A vtkVolume of a grid.
struct GridVolume {
  GridData data;
  PropertySettings property;
  MapperSettings mapper;
  Matrix matrix{};
  Mask mask{};
};

/// A layer with the opacity table that fit_tables() makes its function of anew; none: it keeps its
/// function.
struct TableLayer {
  Layer layer;
  std::optional<OpacityTable> table{};
};

/// Objects that pictures of a grid share.
struct KeptLooks {
  using MaskRecipe =
      std::pair<std::shared_ptr<const Volume>,
                std::vector<std::pair<std::int32_t, std::shared_ptr<const TransferFunction>>>>;

  Kept<std::vector<std::shared_ptr<const Volume>>, Channels> channels;
  KeptFunctions functions;
  Kept<DependentRecipe, MultivariateTransferFunction> dependent;
  Kept<std::shared_ptr<const Volume>, NearestValues> nearest;
  Kept<std::pair<LookRecipe, std::vector<ValueLook>>, LabelTable> label_tables;
  KeptCurves curves;
  Kept<Curve, GradientOpacity> gradients;
  Kept<MaskRecipe, LabelMask> masks;

  void keep_used();
};

/// Returns the layers of a volume: one for each component and each box of the mapper's cropping. A
/// grid of ghosts alone, or a component of weight 0, gives none. Dependent components are one
/// layer. Throws Error for what has no counterpart: functions of two variables, say.
/// `has_ambient_light`: whether a property's ambient part is seen (has_ambient_light()).
std::vector<TableLayer> layers_of(const GridVolume& volume, double tolerance,
                                  bool has_ambient_light, KeptLooks& kept, Notes& notes);

}  // namespace pellucid::vtk_scene
