// SPDX-License-Identifier: Apache-2.0
#include "import_readers.h"
#include "text/printable.h"
#include "text/text.h"

namespace pellucid::imported {
namespace {

ColorSpace color_space(const Node& map, std::vector<std::string>& notes) {
  const auto node = map.find("ColorSpace");
  if (!node) return ColorSpace::rgb;
  const std::string word = in_small_letters(node->string());
  if (word == "rgb") return ColorSpace::rgb;
  if (word == "lab" || word == "cielab") return ColorSpace::lab;
  if (word == "diverging") return ColorSpace::diverging;
  if (word == "step") return ColorSpace::step;
  if (word == "hsv") {
    const auto wrap = map.find("HSVWrap");
    if (!wrap) {
      notes.emplace_back("HSVWrap is not said: hues do not go past red, as in ParaView");
    }
    return wrap && wrap->integer(0, 1) == 1 ? ColorSpace::hsv : ColorSpace::hsv_without_wrap;
  }
  node->fail("is \"" + printable(node->string()) +
             "\", which is not read; save the map as RGB, HSV, Lab, Diverging or Step");
}

std::vector<ColorNode> color_nodes(const Node& flat) {
  const std::size_t size = flat.array_size();
  if (size % 4 != 0 || size == 0) {
    flat.fail("has " + std::to_string(size) +
              " numbers, but must have four for each color: value, red, green, blue");
  }
  std::vector<ColorNode> nodes;
  for (std::size_t i = 0; i < size; i += 4) {
    nodes.push_back(
        {flat.element(i).number(),
         {share(flat.element(i + 1)), share(flat.element(i + 2)), share(flat.element(i + 3))}});
  }
  return nodes;
}

std::string name_of(const Node& map) {
  const auto name = map.find("Name");
  return name ? name->string() : std::string();
}

/// Returns the map of that name among several.
Node chosen(const Node& maps, const std::string& wanted) {
  const std::size_t count = maps.array_size();
  if (count == 0) maps.fail("has no color map in it");
  std::string names;
  for (std::size_t i = 0; i < count; ++i) {
    const Node map = maps.element(i);
    if (!map.is_object()) map.fail("must be an object, a color map");
    if (wanted.empty() || name_of(map) == wanted) return map;
    if (i < 8) names += (i > 0 ? ", \"" : "\"") + printable(name_of(map)) + "\"";
  }
  maps.fail("has no color map \"" + printable(wanted) + "\"; there are " + names +
            (count > 8 ? ", ..." : ""));
}

}  // namespace

Function read_paraview(const Node& document, const std::string& wanted) {
  const bool several = document.is_array();
  const Node map = several ? chosen(document, wanted) : document;
  Function function;
  function.format = "ParaView color map";
  function.name = name_of(map);
  if (several && document.array_size() > 1 && wanted.empty()) {
    function.notes.push_back("the first of " + std::to_string(document.array_size()) +
                             " maps is taken, \"" + printable(function.name) + "\"");
  }
  if (map.has("IndexedColors") && !map.has("RGBPoints")) {
    map.fail_at("IndexedColors", "are colors of categories, not of values; take another map");
  }
  if (map.has("IndexedColors")) {
    function.notes.emplace_back("the colors of categories (IndexedColors) are left out");
  }
  if (const auto scale = map.find("UseLogScale"); scale && scale->is_true()) {
    scale->fail("asks for a logarithmic scale, which is not read; save the map without");
  }
  function.space = color_space(map, function.notes);
  if (map.has("RGBPoints")) function.colors = color_nodes(*map.find("RGBPoints"));
  if (const auto points = map.find("Points")) function.opacities = opacity_nodes(*points);
  if (map.has("NanColor")) {
    function.notes.emplace_back("the color of NaN is left out: data without a value are vacuum");
  }
  complete(function, map.where());
  return function;
}

}  // namespace pellucid::imported
