// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "read_fields.h"
#include "scene_json_parts.h"
#include "text/printable.h"

namespace pellucid::scene_json {

using scene_fields::alternative;
using scene_fields::light_kinds;
using scene_fields::visit_fields;

namespace {

/// Fails for keys of other kinds of lights.
void refuse_other_kinds(const Node& node, std::size_t kind) {
  for (std::size_t other = 0; other < std::size(light_kinds); ++other) {
    if (other == kind) continue;
    std::visit(
        [&](const auto& light) {
          for (const std::string_view key : keys_of(light)) {
            if (!node.has(key)) continue;
            node.fail_at(key, std::string("makes no sense for a ") + light_kinds[kind] +
                                  " light; remove it");
          }
        },
        alternative<decltype(Light::kind)>(other));
  }
}

Light light(const Node& node) {
  node.expect_object({"type", "direction", "position", "color"});
  const std::size_t kind = node.at("type", "give \"head\", \"directional\" or \"point\"")
                               .one_of({std::begin(light_kinds), std::end(light_kinds)});
  refuse_other_kinds(node, kind);
  Light light{alternative<decltype(Light::kind)>(kind)};
  std::visit([&](auto& one) { visit_fields(one, FieldReader(node)); }, light.kind);
  visit_fields(light, FieldReader(node));
  return light;
}

GradientOpacity::Point gradient_point(const Node& node) {
  node.expect_object({"gradient", "factor"});
  return {node.at("gradient", "give the magnitude of this point").number(0, largest_value),
          node.at("factor", "give the factor of the extinction").number(0, largest_number)};
}

Isosurface isosurface(const Node& node) {
  Isosurface surface = read_fields<Isosurface>(node);
  if (node.has("colors")) {
    if (node.has("color")) node.fail_at("color", "stands beside \"colors\"; give one of the two");
  } else if (node.has("color_channel")) {
    node.fail_at("color_channel", "needs \"colors\" beside it");
  }
  return surface;
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

const MultivariateDescription* multivariate_of(const LayerDescription& layer) {
  const auto& function = layer.transfer_function;
  return function ? std::get_if<MultivariateDescription>(&*function) : nullptr;
}

std::vector<Light> lights(const Node& list) {
  return list_of(list, light);
}

Vec3<double> direction(const Node& node) {
  const Vec3<double> v = vector(node);
  if (!(std::hypot(v.x, v.y, v.z) > 0)) node.fail("has no length; give a direction [x, y, z]");
  return v;
}

void read_colors(const Node& node, std::shared_ptr<const TransferFunction>& colors,
                 std::shared_ptr<const TransferFunctionDescription>& written) {
  TransferFunctionDescription function = transfer_function(node);
  if (std::holds_alternative<MultivariateDescription>(function)) {
    node.fail("is of several variables, but colors are of one; give \"points\" or a \"preset\"");
  }
  if (const auto* points = std::get_if<std::vector<TransferFunction::Point>>(&function)) {
    colors = std::make_shared<const TransferFunction>(*points);
  } else {
    written = std::make_shared<const TransferFunctionDescription>(std::move(function));
  }
}

Shading shading(const Node& node) {
  Shading shading = read_fields<Shading>(node);
  if (shading.flatness && shading.flat_gradient) {
    node.fail_at("flat_gradient", "stands beside a \"flatness\"; leave one of the two out");
  }
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
  return checked(list, [&] {
    return std::make_shared<const GradientOpacity>(std::move(points), length, std::move(variable));
  });
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
    if (const auto* const function = multivariate_of(layer); function && function->factor) {
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
    layer.slices = list_of(*list, [&](const Node& element) {
      Slice slice = read_fields<Slice>(element);
      check(element);
      return slice;
    });
  }
}

}  // namespace pellucid::scene_json
