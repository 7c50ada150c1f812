// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "import_readers.h"
#include "import_text.h"
#include "pellucid/scene/error.h"
#include "text/printable.h"

namespace pellucid::imported {
namespace {

constexpr const char* format = "3D Slicer volume property";

/// Reads midpoint and sharpness of a node, which may be absent.
template <class To>
void read_shape(const Node& point, To& node) {
  if (const auto midpoint = point.find("midpoint")) node.midpoint = share(*midpoint);
  if (const auto sharpness = point.find("sharpness")) node.sharpness = share(*sharpness);
}

std::vector<OpacityNode> piecewise(const Node& function) {
  const Node points = function.at("points", "give the nodes {x, y, midpoint, sharpness}");
  std::vector<OpacityNode> nodes;
  for (std::size_t i = 0; i < points.array_size(); ++i) {
    const Node point = points.element(i);
    nodes.push_back({point.at("x", "give the node's value").number(),
                     share(point.at("y", "give the node's opacity"))});
    read_shape(point, nodes.back());
  }
  return nodes;
}

std::vector<ColorNode> colors(const Node& function) {
  const Node points = function.at("points", "give the nodes {x, color, midpoint, sharpness}");
  std::vector<ColorNode> nodes;
  for (std::size_t i = 0; i < points.array_size(); ++i) {
    const Node point = points.element(i);
    nodes.push_back({point.at("x", "give the node's value").number(),
                     color(point.at("color", "give [red, green, blue]"))});
    read_shape(point, nodes.back());
  }
  return nodes;
}

constexpr double largest_strength = 1e3;
constexpr double largest_power = 1e6;

/// Returns vtkVolumeProperty's defaults.
Shading vtk_shading() {
  Shading shading;
  shading.ambient = 0.1;
  shading.diffuse = 0.7;
  shading.specular = 0.2;
  shading.power = 10;
  return shading;
}

Shading lighting(const Node& component) {
  Shading shading = vtk_shading();
  const auto node = component.find("lighting");
  if (!node) return shading;
  const auto read = [&](const char* key, double largest, double& value) {
    if (const auto number = node->find(key)) value = number->number(0, largest);
  };
  read("ambient", largest_strength, shading.ambient);
  read("diffuse", largest_strength, shading.diffuse);
  read("specular", largest_strength, shading.specular);
  read("specularPower", largest_power, shading.power);
  return shading;
}

Node first(const Node& parent, const char* key, Function& function) {
  const Node list = parent.at(key, "give an array of one");
  const std::size_t size = list.array_size();
  if (size == 0) list.fail("is empty; one is needed");
  if (size > 1) {
    function.notes.push_back("the first of " + std::to_string(size) + " " + key + " is taken");
  }
  return list.element(0);
}

}  // namespace

Function read_slicer(const Node& document) {
  Function function;
  function.format = format;
  const Node property = first(document, "volumeProperties", function);
  const Node component = first(property, "components", function);
  if (const auto kind = property.find("interpolationType"); kind && kind->string() != "linear") {
    function.notes.push_back("data are trilinear here, not \"" + printable(kind->string()) + "\"");
  }
  if (const auto shade = component.find("shade"); shade && shade->is_true()) {
    set_shading(lighting(component), function);
  }
  if (const auto unit = component.find("scalarOpacityUnitDistance")) {
    function.unit_distance = unit->number(smallest_unit_distance, largest_unit_distance);
  }
  if (const auto rgb = component.find("rgbTransferFunction")) function.colors = colors(*rgb);
  if (const auto scalar = component.find("scalarOpacity")) {
    function.opacities = piecewise(*scalar);
  }
  const auto disabled = component.find("disableGradientOpacity");
  if (const auto gradient = component.find("gradientOpacity");
      gradient && !(disabled && disabled->is_true())) {
    set_gradient_opacity(piecewise(*gradient), function);
  }
  complete(function, component.where());
  return function;
}

namespace {

/// Returns a line of the legacy text: a count, and as many numbers.
std::vector<double> counted(std::string_view line, const std::string& where, std::size_t size) {
  const std::vector<std::string_view> list = words(line, " \t\r");
  const double count = list.empty() ? 0 : number_of(list.front(), where);
  if (list.empty() || count != static_cast<double>(list.size() - 1) || (list.size() - 1) % size) {
    throw Error(where + ": does not begin with the count of its numbers, a multiple of " +
                std::to_string(size));
  }
  std::vector<double> numbers;
  for (std::size_t i = 1; i < list.size(); ++i) numbers.push_back(number_of(list[i], where));
  return numbers;
}

double checked_share(double x, const std::string& where) {
  if (x >= 0 && x <= 1) return x;
  throw Error(where + ": " + text_of(x) + " must be from 0 to 1");
}

std::vector<OpacityNode> legacy_opacities(std::string_view line, const std::string& where) {
  const std::vector<double> numbers = counted(line, where, 2);
  std::vector<OpacityNode> nodes;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    nodes.push_back({numbers[i], checked_share(numbers[i + 1], where)});
  }
  return nodes;
}

}  // namespace

// vtkMRMLVolumePropertyStorageNode: interpolation, shade, diffuse, ambient, specular, its power,
// scalar opacity, gradient opacity, colors; a line each.
Function read_slicer_text(std::string_view text, const std::string& name) {
  const std::vector<std::string_view> lines = words(text, "\n");
  const auto where = [&](std::size_t line) { return name + ": line " + std::to_string(line + 1); };
  if (lines.size() < 9) {
    throw Error(name + ": has " + std::to_string(lines.size()) +
                " lines, but a volume property has nine; is the file complete?");
  }
  Function function;
  function.format = format;
  if (words(lines[0], " \t\r") != std::vector<std::string_view>{"1"}) {
    function.notes.emplace_back("data are trilinear here");
  }
  if (words(lines[1], " \t\r") != std::vector<std::string_view>{"0"}) {
    const auto number = [&](std::size_t line, double largest) {
      const std::vector<std::string_view> list = words(lines[line], " \t\r");
      const double x = list.size() == 1 ? number_of(list.front(), where(line)) : -1;
      if (x >= 0 && x <= largest) return x;
      throw Error(where(line) + ": must be a number from 0 to " +
                  std::to_string(static_cast<int>(largest)) + ", a part of the shading");
    };
    Shading shading;
    shading.diffuse = number(2, largest_strength);
    shading.ambient = number(3, largest_strength);
    shading.specular = number(4, largest_strength);
    shading.power = number(5, largest_power);
    set_shading(shading, function);
  }
  function.opacities = legacy_opacities(lines[6], where(6));
  set_gradient_opacity(legacy_opacities(lines[7], where(7)), function);
  const std::vector<double> numbers = counted(lines[8], where(8), 4);
  for (std::size_t i = 0; i < numbers.size(); i += 4) {
    const auto part = [&](std::size_t j) { return checked_share(numbers[i + j], where(8)); };
    function.colors.push_back({numbers[i], {part(1), part(2), part(3)}});
  }
  function.notes.emplace_back("the file has no unit distance: 1, as in VTK");
  complete(function, name);
  return function;
}

}  // namespace pellucid::imported
