// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "functions.h"
#include "kept.h"
#include "notes.h"
#include "pellucid/io/transfer_function_description.h"
#include "pellucid/scene/label_volume.h"
#include "pellucid/scene/light.h"
#include "pellucid/scene/multivariate_transfer_function.h"
#include "pellucid/scene/transfer_function.h"

namespace pellucid::vtk_scene {

/// Meaning of the opacities of a property of VTK.
enum class OpacityMeaning {
  per_unit_distance,  ///< that of a layer as thick as the unit distance: images and rectilinear
                      ///< grids
  extinction,         ///< opacity / unit distance is the extinction: unstructured grids
  projected,          ///< of a ray, at the one number that it shows
  summed,             ///< opacity times the place in the data's range, per unit distance: a depth
  averaged            ///< of a ray; its color is grey: opacity times the place in the data's range
};

/// Recipe of a transfer function. Functions of equal recipes are equal.
struct LookRecipe {
  std::vector<JoinedPoint> points;  ///< opacity and color
  OpacityMeaning meaning = OpacityMeaning::per_unit_distance;
  double unit_distance = 1;
  double weight = 1;     ///< multiplies the extinction
  double tolerance = 0;  ///< that opacities are converted for; of sums, of a ray
  std::array<double, 2>
      range{};        ///< least and largest of the data, where they are averaged or summed
  double length = 0;  ///< that of the longest ray in the unit distance's unit, for sums
  double opacity_deviation = 0, color_deviation = 0;  ///< FittedCurve::deviation of the points

  bool operator==(const LookRecipe&) const = default;
};

/// Returns the part of a tolerance that the functions of one layer of several may take: errors of
/// layers that overlap add, and double beside other layers.
constexpr double function_share(std::size_t layers) noexcept {
  return layers > 1 ? 0.5 / static_cast<double>(layers) : 1;
}
/// Returns the part of a tolerance that the functions of sums may take.
constexpr double sum_tolerance(double tolerance) noexcept {
  return tolerance / 8;
}

/// Returns the function. The opacity of a projected one is extinction / largest extinction: a point
/// beyond all data makes the largest one 1. Throws Error as TransferFunction and
/// transfer_function_from_opacity_table() do.
TransferFunction function_of(const LookRecipe& recipe);
/// Returns the recipe's opacity table; none if its opacities mean something else.
std::optional<OpacityTable> opacity_table_of(const LookRecipe& recipe);
/// Ranges for ramps in the place of functions without nodes.
struct LookRamps {
  RampRange opacity{}, color{};
};
/// Returns the recipe of a component's colors and opacities, as the reader reads them. A unit
/// distance of 0 is one that is short beside the data, as in VTK, which shows what absorbs as
/// opaque; one that is no positive number is 1, VTK's default. `notes` say so. `size`: of the data,
/// in the unit distance's unit.
LookRecipe look_recipe(const ComponentSettings& component, OpacityMeaning meaning, double tolerance,
                       double size, const LookRamps& ramps, FunctionReader& reader, Notes& notes);

/// Recipe of a function of dependent components: the last component has the opacity. Colors are
/// those of the first of two, or of each of the first three of four, of which each has a color
/// three times as bright, for a third of the extinction.
struct DependentRecipe {
  LookRecipe opacity;
  std::vector<FittedCurve> colors;

  bool operator==(const DependentRecipe&) const = default;
};
std::shared_ptr<const MultivariateTransferFunction> dependent_function(
    const DependentRecipe& recipe);

/// The opacity and the color of a value.
struct ValueLook {
  double opacity = 0;
  Rgb<double> color{};

  bool operator==(const ValueLook&) const = default;
};
/// Returns the looks of values, as labels 0, 1, ..., per unit distance of the recipe.
LabelTable label_table(const LookRecipe& recipe, const std::vector<ValueLook>& looks);

using KeptFunctions = Kept<LookRecipe, TransferFunction>;

/// Returns how a component reflects light; none where it is not shaded. VTK's normals have length 1
/// wherever the gradient is not 0, so that the flatness is 0. Numbers beyond what a Shading takes
/// are brought into it; those that are none are VTK's defaults.
std::optional<Shading> shading_of(const PropertySettings& property, std::size_t component,
                                  Notes& notes);
/// Returns a gradient opacity by the change per voxel, from 0 on.
FittedCurve gradient_curve(const FunctionSettings& function, const RampRange& ramp,
                           FunctionReader& reader);
/// Returns it as the scene has it.
GradientOpacity gradient_opacity_of(const Curve& curve);

/// Window and level of VTK's final color: a color becomes scale · color + bias · opacity.
struct FinalColors {
  double scale = 1, bias = 0;
};
/// Returns what brings colors from level - window / 2 to level + window / 2 to 0 to 1. What is no
/// window is left out, and `notes` say so.
FinalColors final_colors(double window, double level, Notes& notes);

}  // namespace pellucid::vtk_scene
