// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/scene_json.h"

#include <array>
#include <nlohmann/json.hpp>

#include "read_fields.h"
#include "scene_json_parts.h"

namespace pellucid {
namespace {

using scene_json::Node;

constexpr int newest_version = 2;

/// Returns the version of a document; none if it does not say.
std::optional<int> checked_version(const Node& document) {
  const auto version = document.find("pellucid");
  if (!version) return std::nullopt;
  const long long number = version->integer(1, 1'000'000);
  if (number > newest_version) {
    version->fail("is version " + std::to_string(number) +
                  ", but this program reads versions 1 and 2; take a newer pellucid");
  }
  return static_cast<int>(number);
}

/// Channels are looked up here, where all names are known.
void read_data(const Node& node, const std::filesystem::path& folder, LayerDescription& layer) {
  constexpr std::array kinds{"field", "channels", "mesh", "labels"};
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = i + 1; j < kinds.size(); ++j) {
      if (!node.has(kinds[i]) || !node.has(kinds[j])) continue;
      node.fail(std::string("has both \"") + kinds[i] + "\" and \"" + kinds[j] +
                "\"; keep one of them");
    }
  }
  if (const auto labels = node.find("labels")) {
    layer.labels = scene_json::label_source(*labels, folder);
    if (node.has("transfer_function")) {
      node.fail_at("transfer_function", "makes no sense for labels; give \"colors\" in \"labels\"");
    }
    return;
  }
  if (const auto mesh = node.find("mesh")) {
    layer.mesh = scene_json::mesh_source(*mesh, folder);
  } else if (const auto channels = node.find("channels")) {
    layer.channels = scene_json::channel_sources(*channels, folder);
  } else {
    layer.field = scene_json::field_source(
        node.at("field", "give {\"file\": ...} or {\"builtin\": ...}, or a \"mesh\""), folder);
  }
  const auto function = node.find("transfer_function");
  if (!function) return;
  layer.transfer_function = scene_json::transfer_function(*function);
  const MultivariateDescription* const multivariate = scene_json::multivariate_of(layer);
  if (multivariate == nullptr) {
    if (layer.channels.empty() && !(layer.mesh && layer.mesh->channels.size() > 1)) return;
    function->fail(
        "is of one variable, but here are channels; give \"gaussians\", or put the points "
        "into \"tables\": [{\"channel\": ..., \"points\": ...}]");
  }
  scene_json::checked(*function, [&] {
    make_multivariate(*multivariate, function_channels(layer), known_channels(layer));
  });
}

LayerProjection read_projection(const Node& node, const LayerDescription& layer) {
  const auto& names = projection_names;
  const auto projection =
      static_cast<LayerProjection>(node.one_of({std::begin(names), std::end(names)}));
  if (scene_json::multivariate_of(layer) != nullptr || !layer.channels.empty() ||
      (layer.mesh && layer.mesh->channels.size() > 1)) {
    node.fail("is of one variable; give a \"field\" or one array with a function of one");
  }
  if (layer.labels) node.fail("makes no sense for labels; leave it out");
  if (layer.mask) node.fail("stands beside a \"mask\"; leave one of the two out");
  return projection;
}

/// Returns a layer of version 2. A mask needs a field with a function of one variable.
LayerDescription read_layer(const Node& node, const std::filesystem::path& folder) {
  node.expect_object({"name", "visible", "field", "channels", "mesh", "labels", "transfer_function",
                      "mask", "transform", "clip", "projection", "shading", "gradient_opacity",
                      "isosurfaces", "slices"});
  LayerDescription layer;
  if (const auto name = node.find("name")) layer.name = name->string();
  if (const auto visible = node.find("visible")) layer.visible = visible->boolean();
  read_data(node, folder, layer);
  if (const auto mask = node.find("mask")) {
    if (!node.has("field") || scene_json::multivariate_of(layer) != nullptr) {
      node.fail_at("mask", "needs a \"field\" with a function of one variable");
    }
    layer.mask = scene_json::mask_source(*mask, folder);
  }
  if (const auto transform = node.find("transform")) {
    layer.transform = scene_json::affine_map(*transform);
  }
  if (const auto clip = node.find("clip")) layer.clips = scene_json::clips(*clip);
  if (const auto projection = node.find("projection")) {
    layer.projection = read_projection(*projection, layer);
  }
  scene_json::read_look(node, layer);
  return layer;
}

/// Returns the list of layers; in version 1 the one volume.
std::vector<LayerDescription> read_layers(const Node& document,
                                          const std::filesystem::path& folder) {
  const std::optional<int> version = checked_version(document);
  const bool old = version ? *version == 1 : document.has("volumes") && !document.has("layers");
  if (old) {
    document.expect_object({"pellucid", "volumes", "camera", "image", "integration"});
    const Node volumes = document.at("volumes", "give one volume: [{\"field\": {\"file\": ...}}]");
    if (volumes.array_size() != 1) {
      volumes.fail("has " + std::to_string(volumes.array_size()) +
                   " volumes, but version 1 has exactly one; give \"layers\" in version 2");
    }
    const Node volume = volumes.element(0);
    volume.expect_object({"field", "channels", "mesh", "transfer_function"});
    LayerDescription layer;
    read_data(volume, folder, layer);
    return {layer};
  }
  if (document.has("volumes")) document.fail_at("volumes", "is \"layers\" in version 2");
  document.expect_object({"pellucid", "layers", "clip", "lights", "camera", "image", "integration",
                          "time", "animation"});
  const Node list = document.at("layers", "give one at least: [{\"field\": {\"file\": ...}}]");
  if (list.array_size() == 0) list.fail("is empty; give one layer at least");
  return scene_json::list_of(list, [&](const Node& node) { return read_layer(node, folder); });
}

/// Returns the object that stands alone, or under its name in a document of its own with `others`.
Node unwrap(const Node& document, std::string_view key,
            const std::vector<std::string_view>& others = {}) {
  if (!document.is_object() || !document.has(key)) return document;
  std::vector<std::string_view> keys{"pellucid", key};
  keys.insert(keys.end(), others.begin(), others.end());
  document.expect_object(keys);
  checked_version(document);
  return document.at(key, "");
}

}  // namespace

Camera scene_json::camera(const Node& node, ImageSize size) {
  const Camera camera = scene_json::read_fields<Camera>(node);
  const bool perspective = camera.projection == Projection::perspective;
  if (const char* other = perspective ? "parallel_scale" : "vertical_angle"; node.has(other)) {
    node.fail_at(other, perspective
                            ? "makes no sense in a perspective camera; give \"vertical_angle\""
                            : "makes no sense in an orthographic camera; give \"parallel_scale\"");
  }
  scene_json::checked(node, [&] { make_camera_frame(camera, size); });
  return camera;
}

std::optional<Background> shown_background(const SceneDescription& scene) {
  if (scene.is_transparent) return std::nullopt;
  return scene.background.value_or(calm_background());
}

SceneDescription parse_scene(std::string_view json, const std::string& name,
                             const std::filesystem::path& folder) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  const Node document(parsed, name);
  SceneDescription scene;
  scene.layers = read_layers(document, folder);
  if (const auto clip = document.find("clip")) scene.clips = scene_json::clips(*clip);
  if (const auto lights = document.find("lights")) scene.lights = scene_json::lights(*lights);
  if (const auto image = document.find("image")) {
    image->expect_object({"width", "height", "samples", "background", "backdrop"});
    const auto read = [&](const char* key, int& value, int largest) {
      if (const auto node = image->find(key)) value = static_cast<int>(node->integer(1, largest));
    };
    read("width", scene.size.width, 65536);
    read("height", scene.size.height, 65536);
    read("samples", scene.samples, largest_samples);
    if (const auto background = image->find("background")) {
      scene.is_transparent = background->is_null();
      if (!background->is_null()) scene.background = scene_json::background(*background);
    }
    if (const auto backdrop = image->find("backdrop")) {
      scene.backdrop = scene_json::file_path(*backdrop, folder);
    }
  }
  if (const auto camera = document.find("camera")) {
    scene.camera = scene_json::camera(*camera, scene.size);
  }
  if (const auto integration = document.find("integration")) {
    scene.integration = scene_json::read_fields<Integration>(*integration);
  }
  if (const auto time = document.find("time")) scene.time = time->number();
  if (const auto animation = document.find("animation")) {
    scene.animation = scene_json::animation(*animation);
  }
  return scene;
}

LookDescription parse_look(std::string_view json, const std::string& name) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  const Node document(parsed, name);
  LookDescription look;
  const Node function = unwrap(document, "transfer_function", {"shading", "gradient_opacity"});
  look.transfer_function = scene_json::transfer_function(function);
  if (!document.is_object() || !document.has("transfer_function")) return look;
  if (const auto node = document.find("shading")) look.shading = scene_json::shading(*node);
  if (const auto node = document.find("gradient_opacity")) {
    look.gradient_opacity = scene_json::gradient_opacity(*node);
  }
  return look;
}

TransferFunctionDescription parse_transfer_function(std::string_view json,
                                                    const std::string& name) {
  return parse_look(json, name).transfer_function;
}

Camera parse_camera(std::string_view json, const std::string& name) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  return scene_json::camera(unwrap(Node(parsed, name), "camera"));
}

}  // namespace pellucid
