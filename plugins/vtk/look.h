// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "curves.h"
#include "kept.h"
#include "pellucid/scene/light.h"
#include "pellucid/scene/transfer_function.h"

class vtkVolumeProperty;

namespace pellucid::plugin {

/// How VTK means the opacities of a property.
enum class OpacityMeaning {
  per_unit_distance,  ///< of a layer as thick as the unit distance: images and rectilinear grids
  extinction,         ///< opacity / unit distance is the extinction: unstructured grids
  projected,          ///< of a ray, at the one number that it shows
  averaged            ///< of a ray; its color is grey: opacity times the place in the data's range
};

/// What a transfer function is made of. Functions of equal recipes are equal.
struct LookRecipe {
  std::vector<JoinedPoint> points;  ///< opacity and color
  OpacityMeaning meaning = OpacityMeaning::per_unit_distance;
  double unit_distance = 1;
  double weight = 1;              ///< multiplies the extinction
  double tolerance = 0;           ///< that opacities are converted for
  std::array<double, 2> range{};  ///< of the data, where they are averaged

  bool operator==(const LookRecipe&) const = default;
};

/// Returns the function. The opacity of a projected one is extinction / largest extinction: a point
/// beyond all data makes the largest one 1. Throws Error as TransferFunction and
/// transfer_function_from_opacity_table() do.
TransferFunction function_of(const LookRecipe& recipe);
/// Returns the recipe of a component's colors and opacities.
LookRecipe look_recipe(vtkVolumeProperty& property, int component, OpacityMeaning meaning,
                       double tolerance);

using KeptFunctions = Kept<LookRecipe, TransferFunction>;

/// Returns how a component reflects light; none where it is not shaded. VTK's normals have length 1
/// wherever the gradient is not 0, so that the flatness is 0.
std::optional<Shading> shading_of(vtkVolumeProperty& property, int component);
/// Returns the gradient opacity of a component, by the change per voxel; empty where it has none.
Curve gradient_curve(vtkVolumeProperty& property, int component);
/// Returns it as the scene has it.
GradientOpacity gradient_opacity_of(const Curve& curve);

}  // namespace pellucid::plugin
