// SPDX-License-Identifier: Apache-2.0
#include "pellucid/scene/picture_advice.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "layer_light.h"
#include "message.h"
#include "pellucid/geometry/box_around.h"
#include "value_sample.h"

namespace pellucid {
namespace {

/// The values between which a function absorbs; nothing if nowhere.
struct Support {
  double lower = std::numeric_limits<double>::infinity(), upper = -lower;
};
Support support_of(const TransferFunction& function) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Support support;
  const auto& points = function.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].extinction > 0)) continue;
    support.lower = std::min(support.lower, i > 0 ? points[i - 1].value : -infinity);
    support.upper = std::max(support.upper, i + 1 < points.size() ? points[i + 1].value : infinity);
  }
  return support;
}

std::string interval_text(const Support& support) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (support.upper == infinity) return "above " + number(support.lower);
  if (support.lower == -infinity) return "below " + number(support.upper);
  return "from " + number(support.lower) + " to " + number(support.upper);
}

/// Says why a layer's function shows none of its values; empty: it shows some.
std::string why_clear(const Layer& layer) {
  const TransferFunction* const function = table_of(layer);
  if (function == nullptr || has_surfaces(layer) || layer.projection) return {};
  std::vector<double> values;
  if (const auto* const volume = std::get_if<VolumeContent>(&layer.content)) {
    values = value_sample(*volume->volume);
  } else if (const auto* const mesh = std::get_if<MeshContent>(&layer.content)) {
    values = value_sample(*mesh->mesh);
  } else if (const auto* const source = std::get_if<SourceContent>(&layer.content)) {
    const StretchSource::Variable& variable = source->source->description().variables.front();
    values = {variable.minimum, variable.maximum};
  }
  if (values.empty()) return "the data have no number that is finite";
  const Support support = support_of(*function);
  if (!(support.lower < support.upper)) return "the transfer function absorbs nowhere";
  if (values.back() <= support.lower || values.front() >= support.upper) {
    return "the transfer function absorbs " + interval_text(support) +
           ", where none of the data are, which lie from " + number(values.front()) + " to " +
           number(values.back());
  }
  return {};
}

std::string why_empty(const Scene& scene, bool any) {
  const Layer* const layer = only_layer(scene);
  if (layer != nullptr) {
    const std::string why = why_clear(*layer);
    if (!why.empty()) return why + "; take another function, range or look";
  }
  return any ? "what is there is faint or small; raise the extinction, or move the camera"
             : "no ray meets anything that absorbs; look at the camera, the clips and the function";
}

/// Returns the range of a variable of a layer, and whether it is known and not empty.
std::optional<Support> range_of(const Layer& layer, int channel) {
  const auto of_statistics = [](const VolumeStatistics& statistics) -> std::optional<Support> {
    if (statistics.finite == 0) return std::nullopt;
    return Support{statistics.minimum, statistics.maximum};
  };
  if (const auto* const volume = std::get_if<VolumeContent>(&layer.content)) {
    return of_statistics(volume->volume->statistics());
  }
  if (const auto* const mesh = std::get_if<MeshContent>(&layer.content)) {
    return of_statistics(mesh->mesh->statistics(channel));
  }
  if (const auto* const channels = std::get_if<ChannelsContent>(&layer.content)) {
    return of_statistics((*channels->channels)[channel].volume->statistics());
  }
  return std::nullopt;
}

/// Returns whether a plane has all of a layer's data on one side.
bool misses(const Slice& slice, const Layer& layer) {
  bool any_before = false, any_behind = false;
  for (const Vec3<double>& corner : world_corners(layer)) {
    const double side = dot(corner - slice.point, slice.normal);
    any_before = any_before || side <= 0;
    any_behind = any_behind || side >= 0;
  }
  return !(any_before && any_behind);
}

std::string with_and(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

}  // namespace

std::vector<std::string> surface_advice(const Scene& scene) {
  std::vector<std::string> advice;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    const Layer& layer = scene.layers[i];
    if (!layer.visible) continue;
    const std::string where = scene.layers.size() == 1 ? ""
                              : layer.name.empty()     ? "layer " + std::to_string(i + 1) + ": "
                                                       : layer.name + ": ";
    std::vector<std::string> values;
    std::string range;
    for (const Isosurface& surface : layer.isosurfaces) {
      const auto data = range_of(layer, surface.channel);
      if (!data || (surface.value >= data->lower && surface.value <= data->upper)) continue;
      values.push_back(number(surface.value));
      range = number(data->lower) + " to " + number(data->upper);
    }
    if (!values.empty()) {
      advice.push_back(where + (values.size() == 1 ? "isosurface " : "isosurfaces ") +
                       with_and(values) + (values.size() == 1 ? " shows" : " show") +
                       " nothing: the data have values from " + range);
    }
    std::vector<std::string> slices;
    for (std::size_t n = 0; n < layer.slices.size(); ++n) {
      if (misses(layer.slices[n], layer)) slices.push_back(std::to_string(n + 1));
    }
    if (slices.empty()) continue;
    const auto [lower, upper] = box_around(world_corners(layer));
    std::string box;
    for (int a = 0; a < 3; ++a) {
      box += std::string(a == 0 ? "" : ", ") + "xyz"[a] + " from " + number(lower[a]) + " to " +
             number(upper[a]);
    }
    advice.push_back(where + (slices.size() == 1 ? "slice " : "slices ") + with_and(slices) +
                     (slices.size() == 1 ? " misses" : " miss") + " the data, which have " + box);
  }
  return advice;
}

std::optional<std::string> picture_advice(const Scene& scene, const Image& image) {
  std::size_t seen = 0, burnt = 0;
  bool any = false;
  for (const auto& pixel : image.pixels) {
    any = any || pixel[3] > 0;
    if (!(pixel[3] >= 0.02F)) continue;
    ++seen;
    if (std::max({pixel[0], pixel[1], pixel[2]}) > 1.05F * pixel[3]) ++burnt;
  }
  if (200 * seen < image.pixels.size()) {
    return "the picture is nearly empty: " + why_empty(scene, any);
  }
  if (10 * burnt > seen) {
    return "a tenth or more of what is seen is brighter than white, and cut off: lower the lights' "
           "colors, or the diffuse and specular parts of the shading";
  }
  return std::nullopt;
}

}  // namespace pellucid
