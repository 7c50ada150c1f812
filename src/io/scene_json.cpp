// SPDX-License-Identifier: Apache-2.0
#include "pellucid/io/scene_json.h"

#include <array>

#include "pellucid/scene/error.h"
#include "scene_json_parts.h"

namespace pellucid {
namespace {

using scene_json::linear_rgb;
using scene_json::Node;
using scene_json::vector;

constexpr int newest_version = 1;

void check_version(const Node& document) {
  if (const auto version = document.find("pellucid")) {
    const long long number = version->integer(1, 1'000'000);
    if (number != newest_version) {
      version->fail("is version " + std::to_string(number) +
                    ", but this program reads version 1; take a newer pellucid");
    }
  }
}

Camera camera_from(const Node& node, ImageSize size) {
  node.expect_object(
      {"projection", "position", "focal_point", "up", "vertical_angle", "parallel_scale"});
  Camera camera;
  if (const auto projection = node.find("projection")) {
    camera.projection = projection->one_of({"perspective", "orthographic"}) == 0
                            ? Projection::perspective
                            : Projection::orthographic;
  }
  camera.position = vector(node.at("position", "give the camera's place [x, y, z]"));
  camera.focal_point = vector(node.at("focal_point", "give a point [x, y, z] to look at"));
  if (const auto up = node.find("up")) camera.up = vector(*up);
  const bool perspective = camera.projection == Projection::perspective;
  if (const char* other = perspective ? "parallel_scale" : "vertical_angle"; node.has(other)) {
    node.fail_at(other, perspective
                            ? "makes no sense in a perspective camera; give \"vertical_angle\""
                            : "makes no sense in an orthographic camera; give \"parallel_scale\"");
  }
  if (const auto angle = node.find("vertical_angle")) {
    camera.vertical_angle = angle->number_between(0, 180);
  }
  if (!perspective) {
    camera.parallel_scale =
        node.at("parallel_scale", "give half of the image's height in world units")
            .positive_number();
  }
  try {
    make_camera_frame(camera, size);
  } catch (const Error& error) {
    node.fail(error.what());
  }
  return camera;
}

void read_integration(const Node& node, SceneDescription& scene) {
  Integration& integration = scene.integration;
  node.expect_object({"method", "tolerance", "relative_tolerance", "grade", "precision", "step"});
  if (const auto method = node.find("method")) {
    method->one_of({"exact", "rectangle", "taylor", "midpoint", "trapezoid", "simpson", "linear",
                    "preintegrated", "kniss", "gaussian", "homogeneous", "average", "partial"});
    integration.method = *method_from_name(method->string());
  }
  if (const auto tolerance = node.find("tolerance")) {
    integration.tolerance = tolerance->number(smallest_tolerance, largest_tolerance);
  }
  if (const auto share = node.find("relative_tolerance")) {
    if (node.has("tolerance")) share->fail("stands beside \"tolerance\"; give one of the two");
    scene.relative_tolerance = share->positive_number(1);
  }
  if (const auto grade = node.find("grade")) {
    integration.grade =
        std::array{Grade::estimated, Grade::proved}[grade->one_of({"estimated", "proved"})];
  }
  if (const auto precision = node.find("precision")) {
    integration.precision =
        std::array{Precision::automatic, Precision::float32,
                   Precision::float64}[precision->one_of({"automatic", "float", "double"})];
  }
  if (const auto step = node.find("step")) integration.step = step->positive_number(largest_step);
}

/// Channels are looked up here, where all names are known.
void read_data(const Node& volume, const std::filesystem::path& folder, SceneDescription& scene) {
  for (const auto& [one, other] :
       {std::pair{"field", "channels"}, {"field", "mesh"}, {"channels", "mesh"}}) {
    if (!volume.has(one) || !volume.has(other)) continue;
    volume.fail(std::string("has both \"") + one + "\" and \"" + other + "\"; keep one of them");
  }
  if (const auto mesh = volume.find("mesh")) {
    scene.mesh = scene_json::mesh_source(*mesh, folder);
  } else if (const auto channels = volume.find("channels")) {
    scene.channels = scene_json::channel_sources(*channels, folder);
  } else {
    scene.field = scene_json::field_source(
        volume.at("field", "give {\"file\": ...} or {\"builtin\": ...}, or a \"mesh\""), folder);
  }
  const auto function = volume.find("transfer_function");
  if (!function) return;
  scene.transfer_function = scene_json::transfer_function(*function);
  const auto* multivariate = std::get_if<MultivariateDescription>(&*scene.transfer_function);
  if (multivariate == nullptr) {
    if (scene.channels.empty() && !(scene.mesh && scene.mesh->channels.size() > 1)) return;
    function->fail(
        "is of one variable, but here are channels; give \"gaussians\", or put the points "
        "into \"tables\": [{\"channel\": ..., \"points\": ...}]");
  }
  try {
    make_multivariate(*multivariate, function_channels(scene), known_channels(scene));
  } catch (const Error& error) {
    function->fail(error.what());
  }
}

/// The object that stands alone, or under its name in a document of its own.
Node unwrap(const Node& document, std::string_view key) {
  if (!document.is_object() || !document.has(key)) return document;
  document.expect_object({"pellucid", key});
  check_version(document);
  return document.at(key, "");
}

}  // namespace

SceneDescription parse_scene(std::string_view json, const std::string& name,
                             const std::filesystem::path& folder) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  const Node document(parsed, name);
  document.expect_object({"pellucid", "volumes", "camera", "image", "integration"});
  check_version(document);

  const Node volumes = document.at("volumes", "give one volume: [{\"field\": {\"file\": ...}}]");
  if (volumes.array_size() != 1) {
    volumes.fail("has " + std::to_string(volumes.array_size()) +
                 " volumes, but this version renders exactly one");
  }
  const Node volume = volumes.element(0);
  volume.expect_object({"field", "channels", "mesh", "transfer_function"});

  SceneDescription scene;
  read_data(volume, folder, scene);
  if (const auto image = document.find("image")) {
    image->expect_object({"width", "height", "samples", "background"});
    constexpr int largest_size = 65536;
    if (const auto width = image->find("width")) {
      scene.size.width = static_cast<int>(width->integer(1, largest_size));
    }
    if (const auto height = image->find("height")) {
      scene.size.height = static_cast<int>(height->integer(1, largest_size));
    }
    if (const auto samples = image->find("samples")) {
      scene.samples = static_cast<int>(samples->integer(1, largest_samples));
    }
    if (const auto background = image->find("background")) {
      scene.background = linear_rgb(*background);
    }
  }
  if (const auto camera = document.find("camera")) {
    scene.camera = camera_from(*camera, scene.size);
  }
  if (const auto integration = document.find("integration")) {
    read_integration(*integration, scene);
  }
  return scene;
}

TransferFunctionDescription parse_transfer_function(std::string_view json,
                                                    const std::string& name) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  return scene_json::transfer_function(unwrap(Node(parsed, name), "transfer_function"));
}

Camera parse_camera(std::string_view json, const std::string& name) {
  const nlohmann::json parsed = scene_json::parse_document(json, name);
  return camera_from(unwrap(Node(parsed, name), "camera"), {});
}

}  // namespace pellucid
