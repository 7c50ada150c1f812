// SPDX-License-Identifier: Apache-2.0
#include "look.h"

#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>

#include "pellucid/io/transfer_function_description.h"
#include "pellucid/scene/opacity_table.h"

namespace pellucid::plugin {
namespace {

/// Beyond all data, which are at most 2.1e37.
constexpr double beyond_data = 2.05e37;

TransferFunction table(const LookRecipe& recipe) {
  std::vector<OpacityPoint> points;
  double largest_color = 1;
  for (const JoinedPoint& p : recipe.points) {
    points.push_back({p.x, std::clamp(p.a, 0.0, 1.0), p.b});
    largest_color = std::max({largest_color, p.b.r, p.b.g, p.b.b});
  }
  return transfer_function_from_opacity_table(
      points, recipe.unit_distance / recipe.weight,
      required_relative_error(opacity_table_tolerance(recipe.tolerance), largest_color));
}

/// Chords that stand for the product of two lines.
constexpr int chords = 64;

/// Opaque grey, as VTK shows averages: exact where the opacity is constant.
TransferFunction averages(const LookRecipe& recipe) {
  const double low = recipe.range[0], high = std::max(recipe.range[1], std::nextafter(low, 1e300));
  Curve opacities;
  for (const JoinedPoint& p : recipe.points) opacities.push_back({p.x, {p.a, p.a, p.a}});
  Curve places{{low, {}}, {high, {}}};
  for (int k = 1; k < chords; ++k) places.push_back({low + k * (high - low) / chords, {}});
  std::ranges::sort(places, {}, &CurvePoint::x);
  std::vector<TransferFunction::Point> points;
  for (const JoinedPoint& p : joined(opacities, places)) {
    const double grey =
        std::clamp(p.a, 0.0, 1.0) * std::clamp((p.x - low) / (high - low), 0.0, 1.0);
    points.push_back({p.x, 1, {grey, grey, grey}});
  }
  return TransferFunction(std::move(points));
}

}  // namespace

TransferFunction function_of(const LookRecipe& recipe) {
  if (recipe.meaning == OpacityMeaning::per_unit_distance) return table(recipe);
  if (recipe.meaning == OpacityMeaning::averaged) return averages(recipe);
  std::vector<TransferFunction::Point> points;
  const bool projected = recipe.meaning == OpacityMeaning::projected;
  const double scale = projected ? 1 : recipe.weight / recipe.unit_distance;
  for (const JoinedPoint& p : recipe.points) {
    const double opacity = projected ? std::clamp(p.a, 0.0, 1.0) : std::max(p.a, 0.0);
    points.push_back({p.x, opacity * scale, p.b});
  }
  if (projected && points.back().value < beyond_data) {
    points.push_back({beyond_data, points.back().extinction, points.back().color});
    points.push_back({beyond_data, 1, points.back().color});
  }
  return TransferFunction(std::move(points));
}

LookRecipe look_recipe(vtkVolumeProperty& property, int component, OpacityMeaning meaning,
                       double tolerance) {
  return {joined(curve_of(*property.GetScalarOpacity(component)), color_curve(property, component)),
          meaning, property.GetScalarOpacityUnitDistance(component), 1, tolerance};
}

std::optional<Shading> shading_of(vtkVolumeProperty& property, int component) {
  if (property.GetShade(component) == 0) return std::nullopt;
  Shading shading;
  shading.ambient = property.GetAmbient(component);
  shading.diffuse = property.GetDiffuse(component);
  shading.specular = property.GetSpecular(component);
  shading.power = std::clamp(property.GetSpecularPower(component), 1.0, 1000.0);
  shading.flatness = 0;
  return shading;
}

Curve gradient_curve(vtkVolumeProperty& property, int component) {
  if (property.GetDisableGradientOpacity(component) != 0) return {};
  if (!property.HasGradientOpacity(component)) return {};
  return curve_of(*property.GetGradientOpacity(component));
}

GradientOpacity gradient_opacity_of(const Curve& curve) {
  std::vector<GradientOpacity::Point> points;
  for (const CurvePoint& p : curve) {
    if (p.x >= 0) points.push_back({p.x, std::max(p.y.r, 0.0)});
  }
  return GradientOpacity(std::move(points), GradientOpacity::Unit::voxel);
}

}  // namespace pellucid::plugin
