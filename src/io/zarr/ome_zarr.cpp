// SPDX-License-Identifier: Apache-2.0
//
// https://ngff.openmicroscopy.org/0.5/: "multiscales" lists the levels of an image, whose arrays'
// axes "axes" names. Transformations of a level, then those of the image, map indices to the world.

#include "ome_zarr.h"

#include <cmath>
#include <utility>

#include "pellucid/scene/error.h"
#include "text/printable.h"
#include "zarr_metadata.h"

namespace pellucid {

using scene_json::Node;

namespace {

constexpr std::size_t max_levels = 64, max_names = 4096;
constexpr int deepest_sequence = 8;

std::string text_of(const Node& node, const char* key) {
  const auto value = node.find(key);
  return value && value->is_string() ? printable(value->string()) : std::string();
}

std::vector<OmeAxis> axes_of(const Node& list) {
  if (list.array_size() > max_zarr_axes) list.fail("lists more than 32 axes");
  std::vector<OmeAxis> axes;
  for (std::size_t i = 0; i < list.array_size(); ++i) {
    const Node axis = list.element(i);
    if (axis.is_string()) {  // NGFF 0.3
      axes.push_back({printable(axis.string()), {}, {}});
    } else {
      axes.push_back({printable(axis.at("name", "name the axis").string()), text_of(axis, "type"),
                      text_of(axis, "unit")});
    }
  }
  return axes;
}

std::vector<double> numbers_of(const Node& list, std::size_t count) {
  if (list.array_size() != count) {
    list.fail("has " + std::to_string(list.array_size()) + " numbers, but there are " +
              std::to_string(count) + " axes");
  }
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(list.element(i).number());
  return numbers;
}

/// Puts one transformation behind those that the level has already.
void apply(const Node& transformation, OmeLevel& level, std::size_t axes, int depth) {
  const std::string& type = transformation.at("type", "name the transformation").string();
  if (type == "identity") return;
  if (type == "sequence" && depth < deepest_sequence) {
    const Node list = transformation.at("transformations", "list them");
    for (std::size_t i = 0; i < list.array_size(); ++i) {
      apply(list.element(i), level, axes, depth + 1);
    }
    return;
  }
  if (type != "scale" && type != "translation") {
    transformation.fail("the transformation \"" + printable(type) +
                        "\" is not read, scale and translation are; give --spacing and --origin, "
                        "or name a level's array");
  }
  if (transformation.has("path")) {
    transformation.fail("keeps its numbers in another file, which is not read");
  }
  const bool is_scale = type == "scale";
  const std::vector<double> by =
      numbers_of(transformation.at(is_scale ? "scale" : "translation", "give its numbers"), axes);
  for (std::size_t a = 0; a < axes; ++a) {
    if (is_scale) {
      level.scale[a] *= by[a];
      level.translation[a] *= by[a];
    } else {
      level.translation[a] += by[a];
    }
  }
  level.has_scale = level.has_scale || is_scale;
}

void apply_all(const Node& owner, OmeLevel& level, std::size_t axes) {
  const auto list = owner.find("coordinateTransformations");
  if (!list || list->is_null()) return;
  for (std::size_t i = 0; i < list->array_size(); ++i) apply(list->element(i), level, axes, 0);
}

std::vector<std::string> channels_of(const Node& ome) {
  std::vector<std::string> names;
  const auto omero = ome.find("omero");
  const auto list = omero ? omero->find("channels") : std::nullopt;
  if (!list || !list->is_array()) return names;
  for (std::size_t i = 0; i < list->array_size() && i < max_names; ++i) {
    names.push_back(text_of(list->element(i), "label"));
  }
  return names;
}

}  // namespace

Node ome_attributes(const Node& attributes) {
  const auto ome = attributes.find("ome");
  return ome && ome->is_object() ? *ome : attributes;
}

std::optional<OmeImage> parse_ome_image(const Node& attributes) {
  const Node ome = ome_attributes(attributes);
  const auto list = ome.find("multiscales");
  if (!list) return std::nullopt;
  if (list->array_size() == 0) list->fail("lists no image");
  const Node multiscale = list->element(0);
  OmeImage image;
  image.images = list->array_size();
  if (const auto axes = multiscale.find("axes")) {
    image.axes = axes_of(*axes);
  } else if (const auto systems = multiscale.find("coordinateSystems");
             systems && systems->array_size() > 0) {
    image.axes = axes_of(systems->element(0).at("axes", "list the axes"));
  }
  const Node datasets = multiscale.at("datasets", "list the levels");
  if (datasets.array_size() == 0) datasets.fail("lists no level");
  if (datasets.array_size() > max_levels) datasets.fail("lists more than 64 levels");
  for (std::size_t i = 0; i < datasets.array_size(); ++i) {
    const Node dataset = datasets.element(i);
    OmeLevel level;
    level.path = dataset.at("path", "name the level's array").string();
    level.scale.assign(image.axes.size(), 1);
    level.translation.assign(image.axes.size(), 0);
    if (!image.axes.empty()) {
      apply_all(dataset, level, image.axes.size());
      apply_all(multiscale, level, image.axes.size());
    }
    image.levels.push_back(std::move(level));
  }
  image.channels = channels_of(ome);
  return image;
}

}  // namespace pellucid
