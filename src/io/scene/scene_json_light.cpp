// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "pellucid/scene/error.h"
#include "scene_json_parts.h"
#include "text/printable.h"

namespace pellucid::scene_json {
namespace {

constexpr double largest_strength = 1e3;
constexpr double largest_light = 1e6;

Rgb<double> light_color(const Node& node) {
  const auto [r, g, b] = three(node);
  return {r.number(0, largest_light), g.number(0, largest_light), b.number(0, largest_light)};
}

Vec3<double> direction(const Node& node) {
  const Vec3<double> v = vector(node);
  if (!(std::hypot(v.x, v.y, v.z) > 0)) node.fail("has no length; give a direction [x, y, z]");
  return v;
}

Light light(const Node& node) {
  node.expect_object({"type", "direction", "position", "color"});
  constexpr std::array types{"head", "directional", "point"};
  const std::size_t type = node.at("type", "give \"head\", \"directional\" or \"point\"")
                               .one_of({types.begin(), types.end()});
  for (const auto& [key, of] : {std::pair{"direction", 1U}, std::pair{"position", 2U}}) {
    if (type == of || !node.has(key)) continue;
    node.fail_at(key, std::string("makes no sense for a ") + types[type] + " light; remove it");
  }
  Light light;
  if (type == 1) {
    light.kind = DirectionalLight{
        direction(node.at("direction", "give [x, y, z], the way in which the light shines"))};
  } else if (type == 2) {
    light.kind = PointLight{vector(node.at("position", "give a point [x, y, z] of the world"))};
  }
  if (const auto color = node.find("color")) light.color = light_color(*color);
  return light;
}

GradientOpacity::Point gradient_point(const Node& node) {
  node.expect_object({"gradient", "factor"});
  return {node.at("gradient", "give the magnitude of this point").number(0, largest_value),
          node.at("factor", "give the factor of the extinction").number(0, largest_number)};
}

/// Reads the colors of a surface: a function of one variable.
template <class Surface>
void read_colors(const Node& node, Surface& surface) {
  TransferFunctionDescription function = transfer_function(node);
  if (std::holds_alternative<MultivariateDescription>(function)) {
    node.fail("is of several variables, but colors are of one; give \"points\" or a \"preset\"");
  }
  if (const auto* points = std::get_if<std::vector<TransferFunction::Point>>(&function)) {
    surface.colors = std::make_shared<const TransferFunction>(*points);
  } else {
    surface.written_colors =
        std::make_shared<const TransferFunctionDescription>(std::move(function));
  }
}

Isosurface isosurface(const Node& node) {
  node.expect_object({"value", "color", "opacity", "channel", "colors", "color_channel"});
  Isosurface surface;
  surface.value =
      node.at("value", "give the data value of the surface").number(-largest_value, largest_value);
  if (const auto opacity = node.find("opacity")) surface.opacity = opacity->number(0, 1);
  if (const auto color = node.find("color")) {
    if (node.has("colors")) color->fail("stands beside \"colors\"; give one of the two");
    surface.color = light_color(*color);
  }
  if (const auto function = node.find("colors")) read_colors(*function, surface);
  if (const auto channel = node.find("channel")) surface.channel = channel_name(*channel);
  if (const auto channel = node.find("color_channel")) {
    if (!node.has("colors")) channel->fail("needs \"colors\" beside it");
    surface.color_channel = channel_name(*channel);
  }
  return surface;
}

Slice slice(const Node& node) {
  node.expect_object({"point", "normal", "opacity", "colors", "channel"});
  Slice slice;
  slice.point = vector(node.at("point", "give a point [x, y, z] of the plane"));
  slice.normal = direction(node.at("normal", "give a direction [x, y, z] across the plane"));
  if (const auto opacity = node.find("opacity")) slice.opacity = opacity->number(0, 1);
  if (const auto function = node.find("colors")) read_colors(*function, slice);
  if (const auto channel = node.find("channel")) slice.channel = channel_name(*channel);
  return slice;
}

/// Fails unless the keys of an object that name channels name some of the layer.
class ChannelCheck {
 public:
  explicit ChannelCheck(const LayerDescription& layer) : names_(function_channels(layer)) {
    if (names_.empty()) names_.emplace_back(field_channel);
  }

  void operator()(const Node& node) const {
    for (const char* const key : {"channel", "color_channel"}) {
      const auto channel = node.find(key);
      if (!channel || std::ranges::find(names_, channel->string()) != names_.end()) continue;
      std::string list;
      for (const std::string& name : names_) list += (list.empty() ? "" : ", ") + printable(name);
      channel->fail("is \"" + printable(channel->string()) + "\", which is not there" +
                    did_you_mean(channel->string(), {names_.begin(), names_.end()}) +
                    "; there are: " + list);
    }
  }
  /// Returns whether they are the same variable.
  bool are_same(const ChannelRef& a, const ChannelRef& b) const {
    const auto name = [&](const ChannelRef& c) { return c.is_resolved() ? names_[0] : c.name(); };
    return name(a) == name(b);
  }

 private:
  std::vector<std::string> names_;
};

void refuse_look(const Node& node, const LayerDescription& layer) {
  if (!layer.labels && !layer.projection) return;
  for (const char* const key : {"shading", "gradient_opacity", "isosurfaces", "slices"}) {
    if (!node.has(key)) continue;
    node.fail_at(key, layer.labels ? "makes no sense for labels; remove it"
                                   : "stands beside a \"projection\"; leave one of the two out");
  }
}

}  // namespace

std::vector<Light> lights(const Node& list) {
  std::vector<Light> lights;
  for (std::size_t i = 0; i < list.array_size(); ++i) lights.push_back(light(list.element(i)));
  return lights;
}

Shading shading(const Node& node) {
  node.expect_object({"ambient", "diffuse", "specular", "power", "gradient", "flatness",
                      "flat_gradient", "channel"});
  Shading shading;
  const auto read = [&](const char* key, double least, double& value) {
    if (const auto number = node.find(key)) value = number->number(least, largest_strength);
  };
  read("ambient", 0, shading.ambient);
  read("diffuse", 0, shading.diffuse);
  read("specular", 0, shading.specular);
  read("power", 1, shading.power);
  if (const auto flatness = node.find("flatness")) {
    shading.flatness = flatness->number(0, largest_strength);
  }
  if (const auto gradient = node.find("flat_gradient")) {
    if (shading.flatness) {
      gradient->fail("stands beside a \"flatness\"; leave one of the two out");
    }
    shading.flat_gradient = gradient->number(0, 1e38);
  }
  if (const auto gradient = node.find("gradient")) {
    shading.gradient = std::array{GradientKind::smooth,
                                  GradientKind::field}[gradient->one_of({"smooth", "field"})];
  }
  if (const auto channel = node.find("channel")) shading.channel = channel_name(*channel);
  return shading;
}

std::shared_ptr<const GradientOpacity> gradient_opacity(const Node& node) {
  node.expect_object({"points", "unit", "channel"});
  const Node list = node.at("points", "give an array of {gradient, factor}");
  if (list.array_size() == 0) list.fail("is empty; give at least one point {gradient, factor}");
  std::vector<GradientOpacity::Point> points;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    const Node point = list.element(i);
    points.push_back(gradient_point(point));
    const Node where = *point.find("gradient");
    if (i >= 1 && points[i].gradient < points[i - 1].gradient) {
      where.fail("is below the gradient of the point before it; points must ascend");
    }
    if (i >= 2 && points[i].gradient == points[i - 2].gradient) {
      where.fail("is the third equal gradient; two make a jump, remove the middle one");
    }
  }
  GradientOpacity::Unit length = GradientOpacity::Unit::world;
  if (const auto unit = node.find("unit")) {
    length = std::array{GradientOpacity::Unit::world,
                        GradientOpacity::Unit::voxel}[unit->one_of({"world", "voxel"})];
  }
  ChannelRef variable;
  if (const auto channel = node.find("channel")) variable = channel_name(*channel);
  // What floats hold may be narrower than what is checked here.
  try {
    return std::make_shared<const GradientOpacity>(std::move(points), length, std::move(variable));
  } catch (const Error& error) {
    list.fail(error.what());
  }
}

void read_look(const Node& node, LayerDescription& layer) {
  refuse_look(node, layer);
  const ChannelCheck check(layer);
  if (const auto found = node.find("shading")) {
    layer.shading = shading(*found);
    check(*found);
  }
  if (const auto found = node.find("gradient_opacity")) {
    layer.gradient_opacity = gradient_opacity(*found);
    check(*found);
    const auto* const function =
        layer.transfer_function ? std::get_if<MultivariateDescription>(&*layer.transfer_function)
                                : nullptr;
    if (function != nullptr && function->factor) {
      node.fail_at("gradient_opacity",
                   "stands beside a \"factor\" of the function; leave one of the two out");
    }
  }
  if (const auto list = node.find("isosurfaces")) {
    for (std::size_t i = 0; i < list->array_size(); ++i) {
      const Node element = list->element(i);
      Isosurface surface = isosurface(element);
      check(element);
      for (const Isosurface& other : layer.isosurfaces) {
        if (other.value != surface.value || !check.are_same(other.channel, surface.channel))
          continue;
        element.find("value")->fail("stands twice; keep one of the two isosurfaces");
      }
      layer.isosurfaces.push_back(std::move(surface));
    }
  }
  if (const auto list = node.find("slices")) {
    for (std::size_t i = 0; i < list->array_size(); ++i) {
      const Node element = list->element(i);
      layer.slices.push_back(slice(element));
      check(element);
    }
  }
}

}  // namespace pellucid::scene_json
