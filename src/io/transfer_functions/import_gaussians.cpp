// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "import_readers.h"
#include "pellucid/scene/error.h"
#include "scene/scene_json_parts.h"

namespace pellucid::imported {
namespace {

/// vtk.js takes smaller widths for this one.
constexpr double smallest_width_of_vtk_js = 0.001;

GaussianNode gaussian(const Node& node) {
  GaussianNode g;
  g.x = node.at("position", "give the Gaussian's place, from 0 to 1").number();
  g.height = share(node.at("height", "give the Gaussian's opacity"));
  g.width = std::max(node.at("width", "give the Gaussian's half width").number(0),
                     smallest_width_of_vtk_js);
  if (const auto bias = node.find("xBias")) {
    g.x_bias = bias->number();
    if (std::abs(g.x_bias) > g.width) bias->fail("moves the top further than the width");
  }
  if (const auto bias = node.find("yBias")) g.y_bias = bias->number(0, 2);
  return g;
}

}  // namespace

Function read_vtk_js(const Node& document) {
  Function function;
  function.format = "vtk.js Gaussians";
  const Node list = document.is_array() ? document : *document.find("gaussians");
  if (list.array_size() == 0) list.fail("is empty; give at least one Gaussian");
  if (list.array_size() > max_gaussians) {
    list.fail("has more than " + std::to_string(max_gaussians) + " Gaussians");
  }
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    function.gaussians.push_back(gaussian(list.element(i)));
  }
  if (document.is_object() && document.has("RGBPoints")) {
    const Function map = read_paraview(document, "");
    function.colors = map.colors;
    function.space = map.space;
  }
  // Positions are shares of the range.
  const auto range = document.is_object() ? document.find("mappingRange") : std::nullopt;
  if (range) {
    if (range->array_size() != 2) range->fail("must have two numbers, a range of values");
    function.lower = range->element(0).number();
    function.upper = range->element(1).number();
    if (!(function.lower < function.upper)) range->fail("is empty; give two ascending values");
    const double scale = function.upper - function.lower;
    for (GaussianNode& g : function.gaussians) {
      g.x = function.lower + g.x * scale;
      g.width *= scale;
      g.x_bias *= scale;
    }
  }
  complete(function, document.where());
  return function;
}

namespace {

/// Returns the nodes' values: given as shares of the range, or evenly over it.
std::vector<double> positions(const Node& document, const char* key, std::size_t count,
                              const Function& function) {
  std::vector<double> values;
  const auto list = document.find(key);
  if (list && list->array_size() != count) {
    list->fail("has " + std::to_string(list->array_size()) + " numbers, but there are " +
               std::to_string(count) + " nodes; give one for each");
  }
  for (std::size_t i = 0; i < count; ++i) {
    const double at = list        ? share(list->element(i))
                      : count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1)
                                  : 0;
    values.push_back(at == 1 ? function.upper
                             : function.lower + at * (function.upper - function.lower));
  }
  return values;
}

}  // namespace

Function read_anari(const Node& document) {
  Function function;
  function.format = "ANARI transferFunction1D";
  function.numbers = ColorEncoding::linear;
  if (const auto range = document.find("valueRange")) {
    if (range->array_size() != 2) range->fail("must have two numbers, a range of values");
    function.lower = range->element(0).number();
    function.upper = range->element(1).number();
    if (!(function.lower < function.upper)) range->fail("is empty; give two ascending values");
  }
  if (const auto unit = document.find("unitDistance")) {
    function.unit_distance = unit->number(smallest_unit_distance, largest_unit_distance);
  }
  if (const auto list = document.find("color")) {
    const std::size_t count = list->array_size();
    const std::vector<double> at = positions(document, "color.position", count, function);
    for (std::size_t i = 0; i < count; ++i) {
      const Node entry = list->element(i);
      const bool with_alpha = entry.array_size() == 4;
      if (!with_alpha) {
        function.colors.push_back({at[i], color(entry)});
        continue;
      }
      function.colors.push_back(
          {at[i], {share(entry.element(0)), share(entry.element(1)), share(entry.element(2))}});
      if (!document.has("opacity")) {
        function.opacities.push_back({at[i], share(entry.element(3))});
      }
    }
  }
  if (const auto list = document.find("opacity")) {
    const std::size_t count = list->array_size();
    const std::vector<double> at = positions(document, "opacity.position", count, function);
    for (std::size_t i = 0; i < count; ++i) {
      function.opacities.push_back({at[i], share(list->element(i))});
    }
  }
  complete(function, document.where());
  return function;
}

}  // namespace pellucid::imported
