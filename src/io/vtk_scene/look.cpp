// SPDX-License-Identifier: Apache-2.0
#include "look.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pellucid/scene/opacity_table.h"

namespace pellucid::vtk_scene {
namespace {

/// Beyond all data, which are at most 2.1e37.
constexpr double beyond_data = 2.05e37;

TransferFunction table(const LookRecipe& recipe) {
  const OpacityTable table = *opacity_table_of(recipe);
  double largest_color = 1;
  for (const OpacityPoint& p : table.points) {
    largest_color = std::max({largest_color, p.color.r, p.color.g, p.color.b});
  }
  const TransferFunction function = transfer_function_from_opacity_table(
      table.points, table.unit_distance,
      required_relative_error(opacity_table_tolerance(recipe.tolerance), largest_color));
  return {function.points(), function.relative_error() + table.extinction_deviation,
          table.color_deviation};
}

/// Chords that stand for the product of two lines.
constexpr int chords = 64;

/// Returns opaque grey, as VTK shows averages: exact where the opacity is constant.
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
  return {std::move(points), 0, std::expm1(recipe.opacity_deviation)};
}

/// The largest number of chords of a product between two of its corners.
constexpr double max_chords = 4096;

/// Extinctions whose depth is VTK's sum: a chain of chords of the product of opacity and place. The
/// product of two lines is off a chord by a quarter of the product of their changes, at most.
TransferFunction sums(const LookRecipe& recipe) {
  const double low = recipe.range[0], high = std::max(recipe.range[1], std::nextafter(low, 1e300));
  const double scale = recipe.weight / recipe.unit_distance;
  const double wanted =
      recipe.tolerance / std::max(scale * recipe.length, std::numeric_limits<double>::min());
  Curve opacities;
  for (const JoinedPoint& p : recipe.points) {
    const double a = std::clamp(p.a, 0.0, 1.0);
    opacities.push_back({p.x, {a, a, a}});
  }
  const auto joint = joined(opacities, {{low, {0, 0, 0}}, {high, {1, 1, 1}}});
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < joint.size(); ++i) {
    const auto add = [&](double x, double a, double place) {
      points.push_back({x, scale * a * place, {}});
    };
    if (i > 0 && joint[i - 1].x < joint[i].x) {
      const JoinedPoint &from = joint[i - 1], &to = joint[i];
      const double change = std::abs((to.a - from.a) * (to.b.r - from.b.r)) / 4;
      const double count = std::ceil(std::min(std::sqrt(change / wanted), max_chords));
      for (int k = 1; k < count; ++k) {
        const double share = k / count, x = from.x + share * (to.x - from.x);
        if (!(points.back().value < x && x < to.x)) continue;
        add(x, from.a + share * (to.a - from.a), from.b.r + share * (to.b.r - from.b.r));
      }
    }
    add(joint[i].x, joint[i].a, joint[i].b.r);
  }
  return {std::move(points), recipe.opacity_deviation};
}

/// Share of a size that is shorter than the data can resolve.
constexpr double shortest_share = 1e-6;

double unit_distance(double of_property, double size, Notes& notes) {
  if (of_property > 0 && std::isfinite(of_property)) {
    return std::clamp(of_property, smallest_unit_distance, largest_unit_distance);
  }
  if (of_property == 0) {
    notes.add("a unit distance of 0 makes all opaque that absorbs; set a positive one");
    return std::max(shortest_share * size, smallest_unit_distance);
  }
  notes.add("a unit distance is no positive number, and taken as 1; set a positive one");
  return 1;
}

}  // namespace

std::optional<OpacityTable> opacity_table_of(const LookRecipe& recipe) {
  if (recipe.meaning != OpacityMeaning::per_unit_distance) return std::nullopt;
  OpacityTable table;
  for (const JoinedPoint& p : recipe.points) {
    table.points.push_back({p.x, std::clamp(p.a, 0.0, 1.0), p.b});
  }
  table.unit_distance = std::clamp(recipe.unit_distance / recipe.weight, smallest_unit_distance,
                                   largest_unit_distance);
  table.extinction_deviation = recipe.opacity_deviation;
  table.color_deviation = recipe.color_deviation;
  return table;
}

TransferFunction function_of(const LookRecipe& recipe) {
  if (recipe.meaning == OpacityMeaning::per_unit_distance) return table(recipe);
  if (recipe.meaning == OpacityMeaning::averaged) return averages(recipe);
  if (recipe.meaning == OpacityMeaning::summed) return sums(recipe);
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
  return {std::move(points), recipe.opacity_deviation, recipe.color_deviation};
}

std::shared_ptr<const MultivariateTransferFunction> dependent_function(
    const DependentRecipe& recipe) {
  const int channels = recipe.colors.size() == 1 ? 2 : 4;
  const double share = 1.0 / static_cast<double>(recipe.colors.size());
  std::vector<ChannelTransferFunction> tables;
  for (std::size_t c = 0; c < recipe.colors.size(); ++c) {
    std::vector<TransferFunction::Point> points;
    for (const CurvePoint& p : recipe.colors[c].points) points.push_back({p.x, share, p.y});
    tables.push_back(
        {static_cast<int>(c), TransferFunction(std::move(points), 0, recipe.colors[c].deviation)});
  }
  return std::make_shared<const MultivariateTransferFunction>(
      channels, std::vector<GaussianPrimitive>(), std::move(tables),
      ChannelTransferFunction{channels - 1, function_of(recipe.opacity)});
}

LabelTable label_table(const LookRecipe& recipe, const std::vector<ValueLook>& looks) {
  std::vector<LabelStyle> styles;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const double opacity = looks[i].opacity;
    if (!(opacity > 0)) continue;
    const double depth = opacity < 1 ? -std::log1p(-opacity) : opaque_extinction;
    styles.push_back({static_cast<std::int32_t>(i),
                      {},
                      looks[i].color,
                      std::min(depth, opaque_extinction) * recipe.weight / recipe.unit_distance});
  }
  if (styles.empty()) styles.push_back({0, {}, {}, 0});
  return LabelTable(std::move(styles));
}

LookRecipe look_recipe(const ComponentSettings& component, OpacityMeaning meaning, double tolerance,
                       double size, const LookRamps& ramps, FunctionReader& reader, Notes& notes) {
  const bool is_extinction = meaning == OpacityMeaning::extinction;
  const FittedCurve opacities =
      reader.opacities(component.opacity,
                       is_extinction ? std::numeric_limits<double>::infinity() : 1, ramps.opacity);
  const FittedCurve colors = reader.colors(component, ramps.color);
  LookRecipe recipe;
  recipe.points = joined(opacities.points, colors.points);
  recipe.meaning = meaning;
  recipe.unit_distance = unit_distance(component.unit_distance, size, notes);
  recipe.tolerance = tolerance;
  recipe.opacity_deviation = opacities.deviation;
  recipe.color_deviation = colors.deviation;
  return recipe;
}

std::optional<Shading> shading_of(const PropertySettings& property, std::size_t component,
                                  Notes& notes) {
  const auto& reflection = property.components.at(component).reflection;
  if (!reflection) return std::nullopt;
  const auto number = [&](double value, double least, double most, double otherwise) {
    if (value >= least && value <= most) return value;
    notes.add("a number of the shading is beyond its range, and brought into it");
    return std::isnan(value) ? otherwise : std::clamp(value, least, most);
  };
  Shading shading;
  shading.ambient = number(reflection->ambient, 0, 1000, 0.1);
  shading.diffuse = number(reflection->diffuse, 0, 1000, 0.7);
  shading.specular = number(reflection->specular, 0, 1000, 0.2);
  // Next to (r·v)^power, |n·h|^(4 power) of light.h has highlights of the same width.
  const double power = (property.has_phong_highlights ? 4 : 1) * reflection->power;
  // Below 1 highlights are as wide as at 1, but for VTK's own 0 to 1.
  shading.power = power >= 0 && power < 1 ? 1 : number(power, 1, 1000, 10);
  shading.flatness = 0;
  return shading;
}

FittedCurve gradient_curve(const FunctionSettings& function, const RampRange& ramp,
                           FunctionReader& reader) {
  FittedCurve curve = reader.opacities(function, std::numeric_limits<double>::infinity(), ramp);
  // Magnitudes begin at 0.
  if (curve.points.front().x >= 0) return curve;
  Curve from_zero{{0, value_at(curve.points, 0)}};
  for (const CurvePoint& point : curve.points) {
    if (point.x > 0) from_zero.push_back(point);
  }
  curve.points = std::move(from_zero);
  return curve;
}

GradientOpacity gradient_opacity_of(const Curve& curve) {
  std::vector<GradientOpacity::Point> points;
  for (const CurvePoint& p : curve) points.push_back({p.x, std::max(p.y.r, 0.0)});
  return GradientOpacity(std::move(points), GradientOpacity::Unit::voxel);
}

FinalColors final_colors(double window, double level, Notes& notes) {
  const double scale = 1 / window, bias = 0.5 - level / window;
  if (std::isfinite(scale) && std::isfinite(bias)) return {scale, bias};
  notes.add("the window of the final color is no width, and left out");
  return {};
}

}  // namespace pellucid::vtk_scene
