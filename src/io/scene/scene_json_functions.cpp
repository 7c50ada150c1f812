// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/presets.h"
#include "pellucid/scene/srgb.h"
#include "scene_json_parts.h"

namespace pellucid::scene_json {
namespace {

/// A number of points of a function, with what messages say of it.
struct Strength {
  const char* name;
  const char* hint;
  double most;
  const char* other = nullptr;  ///< the one in its place of another kind of points
  const char* other_hint = "";
  bool has_color = true;
};
constexpr Strength extinctions{
    "extinction", "give the extinction per world length here", largest_number, "opacity",
    "needs a \"unit_distance\" beside \"points\"; or give the extinction"};
constexpr Strength opacities{
    "opacity", "give the opacity of a layer as thick as unit_distance", 1, "extinction",
    "stands in a function with a \"unit_distance\"; give the opacity instead, "
    "in all points, or remove the unit_distance"};
constexpr Strength factor_strength{
    "factor", "give the factor of the extinction", largest_number, nullptr, "", false};

/// Returns the points of a list; at least one. Their values do not descend; two equal ones make a
/// jump.
template <class Point>
std::vector<Point> points_of(const Node& list, const Strength& kind, double Point::*strength,
                             bool srgb) {
  std::vector<std::string_view> keys{"value", kind.name};
  if (kind.has_color) keys.emplace_back("color");
  if (list.array_size() == 0) {
    list.fail(std::string("is empty; give at least one point {value, ") + kind.name +
              (kind.has_color ? ", color}" : "}"));
  }
  std::vector<Point> points;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    const Node node = list.element(i);
    if (kind.other != nullptr && node.has(kind.other)) node.fail_at(kind.other, kind.other_hint);
    node.expect_object(keys);
    Point& point = points.emplace_back();
    point.*strength = node.at(kind.name, kind.hint).number(0, kind.most);
    const Node value = node.at("value", "give the data value of this point");
    if (kind.has_color) point.color = color_of(node.at("color", "give [r, g, b]"), srgb);
    point.value = value.number(-largest_value, largest_value);
    if (i >= 1 && point.value < points[i - 1].value) {
      value.fail("is below the value of the point before it; points must ascend");
    }
    if (i >= 2 && point.value == points[i - 2].value) {
      value.fail("is the third equal value; two make a jump, remove the middle one");
    }
  }
  return points;
}

/// Returns the function of points. What floats hold may be narrower than what is checked of them.
TransferFunction function_of(const Node& list, std::vector<TransferFunction::Point> points) {
  return checked(list, [&] { return TransferFunction(std::move(points)); });
}

void read_deviation(const Node& node, OpacityTable& table) {
  node.expect_object({"extinction", "color"});
  if (const auto extinction = node.find("extinction")) {
    table.extinction_deviation = extinction->number(0, largest_extinction_deviation);
  }
  if (const auto color = node.find("color")) {
    table.color_deviation = color->number(0, largest_color_deviation);
  }
}

TransferFunctionDescription preset(const Node& function) {
  function.expect_object({"preset", "range"});
  std::vector<std::string_view> names;
  for (const Preset& known : presets()) names.push_back(known.name);
  const Node name = *function.find("preset");
  name.one_of(names);
  PresetDescription description{name.string(), {}};
  if (const auto range = function.find("range")) {
    if (range->array_size() != 2) {
      range->fail("must have 2 numbers, but has " + std::to_string(range->array_size()));
    }
    const auto end = [&](std::size_t i) {
      return range->element(i).number(-scene_json::largest_value, scene_json::largest_value);
    };
    description.range = {end(0), end(1)};
    if (!((*description.range)[0] < (*description.range)[1])) {
      range->fail("must be two ascending values");
    }
  }
  return description;
}

}  // namespace

bool is_srgb(const Node& function) {
  const auto space = function.find("color_space");
  return space && space->one_of({"linear", "srgb"}) == 1;
}

Rgb<double> color_of(const Node& node, bool srgb) {
  if (!srgb) return linear_rgb(node);
  return srgb_to_linear(linear_rgb(node, 1));
}

std::vector<TransferFunction::Point> extinction_points(const Node& list, bool srgb) {
  return function_of(list, points_of(list, extinctions, &TransferFunction::Point::extinction, srgb))
      .points();
}

TransferFunction factors(const Node& list) {
  return function_of(list,
                     points_of(list, factor_strength, &TransferFunction::Point::extinction, false));
}

TransferFunctionDescription transfer_function(const Node& function) {
  if (function.has("gaussians") || function.has("tables")) return multivariate(function);
  if (function.has("preset")) return preset(function);
  function.expect_object({"type", "color_space", "unit_distance", "deviation", "points",
                          "gaussians", "tables", "preset"});
  if (const auto type = function.find("type")) type->one_of({"piecewise_linear"});
  const auto unit_distance = function.find("unit_distance");
  const Node list = function.at("points", "give an array of {value, extinction, color}");
  const bool srgb = is_srgb(function);
  if (!unit_distance) {
    if (function.has("deviation")) {
      function.fail_at("deviation", "needs a \"unit_distance\": it is that of an opacity table");
    }
    return extinction_points(list, srgb);
  }
  OpacityTable table;
  table.unit_distance = unit_distance->number(smallest_unit_distance, largest_unit_distance);
  table.points = points_of(list, opacities, &OpacityPoint::opacity, srgb);
  if (const auto deviation = function.find("deviation")) read_deviation(*deviation, table);
  return table;
}

}  // namespace pellucid::scene_json
