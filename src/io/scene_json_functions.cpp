// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/error.h"
#include "scene_json_parts.h"

namespace pellucid::scene_json {
namespace {

/// The members of a point that both kinds have, and the order of the values.
template <class Point>
void read_place(const Node& node, std::vector<Point>& points) {
  const Node value = node.at("value", "give the data value of this point");
  const Rgb<double> color = linear_rgb(node.at("color", "give linear [r, g, b]"));
  const std::size_t i = points.size();
  points.push_back({value.number(), 0, color});
  if (i >= 1 && points[i].value < points[i - 1].value) {
    value.fail("is below the value of the point before it; points must ascend");
  }
  if (i >= 2 && points[i].value == points[i - 2].value) {
    value.fail("is the third equal value; two make a jump, remove the middle one");
  }
}

TransferFunctionDescription opacity_table(const Node& list, double unit_distance) {
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
    read_place(point, table.points);
    table.points.back().opacity = opacity;
  }
  return table;
}

}  // namespace

std::vector<TransferFunction::Point> extinction_points(const Node& list) {
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
    read_place(point, points);
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
  function.expect_object({"type", "unit_distance", "points", "gaussians", "tables"});
  if (const auto type = function.find("type")) type->one_of({"piecewise_linear"});
  const auto unit_distance = function.find("unit_distance");
  const Node list = function.at("points", "give an array of {value, extinction, color}");
  if (!unit_distance) return extinction_points(list);
  if (list.array_size() == 0)
    list.fail("is empty; give at least one point {value, opacity, color}");
  return opacity_table(list, unit_distance->number(smallest_unit_distance, largest_unit_distance));
}

}  // namespace pellucid::scene_json
