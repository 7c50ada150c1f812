// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/error.h"
#include "pellucid/scene/presets.h"
#include "pellucid/scene/srgb.h"
#include "scene_json_parts.h"

namespace pellucid::scene_json {
namespace {

/// The members of a point that both kinds have, and the order of the values.
template <class Point>
void read_place(const Node& node, bool srgb, std::vector<Point>& points) {
  const Node value = node.at("value", "give the data value of this point");
  const Rgb<double> color = color_of(node.at("color", "give [r, g, b]"), srgb);
  add_value(value, points);
  points.back().color = color;
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

OpacityTable opacity_table(const Node& list, double unit_distance, bool srgb) {
  OpacityTable table;
  table.unit_distance = unit_distance;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    const Node point = list.element(i);
    if (point.has("extinction")) {
      point.fail_at("extinction",
                    "stands in a function with a \"unit_distance\"; give the opacity instead, in "
                    "all points, or remove the unit_distance");
    }
    point.expect_object({"value", "opacity", "color"});
    const double opacity =
        point.at("opacity", "give the opacity of a layer as thick as unit_distance").number(0, 1);
    read_place(point, srgb, table.points);
    table.points.back().opacity = opacity;
  }
  return table;
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
  const auto [r, g, b] = three(node);
  return srgb_to_linear(Rgb<double>{r.number(0, 1), g.number(0, 1), b.number(0, 1)});
}

std::vector<TransferFunction::Point> extinction_points(const Node& list, bool srgb) {
  if (list.array_size() == 0) {
    list.fail("is empty; give at least one point {value, extinction, color}");
  }
  std::vector<TransferFunction::Point> points;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    const Node point = list.element(i);
    if (point.has("opacity")) {
      point.fail_at("opacity",
                    "needs a \"unit_distance\" beside \"points\"; or give the extinction");
    }
    point.expect_object({"value", "extinction", "color"});
    const double extinction = point.at("extinction", "give the extinction per world length here")
                                  .number(0, scene_json::largest_number);
    read_place(point, srgb, points);
    points.back().extinction = extinction;
  }
  // What floats hold may be narrower than what is checked here (values that coincide in float).
  try {
    TransferFunction checked(points);
  } catch (const Error& error) {
    list.fail(error.what());
  }
  return points;
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
  if (list.array_size() == 0)
    list.fail("is empty; give at least one point {value, opacity, color}");
  OpacityTable table = opacity_table(
      list, unit_distance->number(smallest_unit_distance, largest_unit_distance), srgb);
  if (const auto deviation = function.find("deviation")) read_deviation(*deviation, table);
  return table;
}

}  // namespace pellucid::scene_json
