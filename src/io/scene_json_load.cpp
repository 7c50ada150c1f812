// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "pellucid/io/scene_json.h"
#include "pellucid/scene/defaults.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/presets.h"

namespace pellucid {
namespace {

/// What is made of a scene's one field where a term names it.
constexpr std::array made_of_field{DerivedSource::Kind::gradient_magnitude,
                                   DerivedSource::Kind::second_derivative};

bool names(const MultivariateDescription& function, std::string_view channel) {
  const auto in = [&](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), channel) != list.end();
  };
  return in(function.channels) ||
         std::any_of(function.gaussians.begin(), function.gaussians.end(),
                     [&](const auto& gaussian) { return in(gaussian.channels); }) ||
         std::any_of(function.tables.begin(), function.tables.end(),
                     [&](const auto& table) { return table.channel == channel; });
}

/// Of a volume or a mesh.
template <class Data>
TransferFunction function_of(const SceneDescription& description, const Data& data) {
  if (!description.transfer_function) return default_transfer_function(data);
  if (const auto* preset = std::get_if<PresetDescription>(&*description.transfer_function)) {
    return make_preset(preset->name, data, preset->range);
  }
  return make_transfer_function(*description.transfer_function, description.integration.tolerance,
                                description.background);
}

const MultivariateDescription* multivariate(const SceneDescription& description) {
  return description.transfer_function
             ? std::get_if<MultivariateDescription>(&*description.transfer_function)
             : nullptr;
}

void fill_channels(const SceneDescription& description, const std::vector<ChannelSource>& sources,
                   const ParallelFor& parallel, Scene& scene) {
  const MultivariateDescription* const function = multivariate(description);
  if (function == nullptr) {
    throw Error(description.transfer_function
                    ? "scene: points in one variable are the function of a field, but here are "
                      "channels; give them as one of the \"tables\" with its \"channel\""
                    : "scene: channels need a transfer function; give "
                      "\"gaussians\" or \"tables\" ('pellucid suggest' makes a first one)");
  }
  scene.multivariate =
      make_multivariate(*function, channel_names(sources), known_channels(description));
  scene.channels = std::make_shared<const Channels>(load_channels(sources, parallel));
}

/// Whose function is of one variable or of several.
void fill_mesh(const SceneDescription& description, const ParallelFor& parallel, Scene& scene,
               MeshSource* mesh_used) {
  const std::vector<std::string> names = function_channels(description);
  if (const MultivariateDescription* const function = multivariate(description)) {
    scene.multivariate = make_multivariate(*function, names, names);
  } else if (names.size() > 1) {
    throw Error(
        "scene: several arrays of a mesh need a function of them all; give \"gaussians\" or "
        "\"tables\", or leave one array");
  }
  const LoadedMesh loaded = load_mesh(*description.mesh, parallel);
  scene.mesh = loaded.mesh;
  if (mesh_used != nullptr) {
    *mesh_used = *description.mesh;
    mesh_used->channels = loaded.channels;
  }
  if (scene.multivariate) return;
  scene.transfer_function =
      std::make_shared<const TransferFunction>(function_of(description, *scene.mesh));
}

}  // namespace

std::vector<ChannelSource> scene_channels(const SceneDescription& description) {
  if (description.mesh) return {};
  if (!description.channels.empty()) return description.channels;
  const MultivariateDescription* const function = multivariate(description);
  if (function == nullptr) return {};
  std::vector<ChannelSource> channels{{std::string(field_channel), "", description.field}};
  for (const auto kind : made_of_field) {
    const std::string name(derived_name(kind));
    if (!names(*function, name)) continue;
    channels.push_back({name, "", DerivedSource{kind, std::string(field_channel), 0}});
  }
  return channels;
}

std::vector<std::string> function_channels(const SceneDescription& description) {
  return description.mesh ? channel_names(*description.mesh)
                          : channel_names(scene_channels(description));
}

std::vector<std::string> known_channels(const SceneDescription& description) {
  if (description.mesh) return channel_names(*description.mesh);
  if (!description.channels.empty()) return channel_names(description.channels);
  std::vector<std::string> names{std::string(field_channel)};
  for (const auto kind : made_of_field) names.emplace_back(derived_name(kind));
  return names;
}

Scene make_scene(const SceneDescription& description, const ParallelFor& parallel,
                 MeshSource* mesh_used) {
  Scene scene;
  if (description.mesh) {
    fill_mesh(description, parallel, scene, mesh_used);
  } else if (const auto sources = scene_channels(description); !sources.empty()) {
    fill_channels(description, sources, parallel, scene);
  } else {
    scene.volume = std::make_shared<const Volume>(load_field(description.field));
    scene.transfer_function =
        std::make_shared<const TransferFunction>(function_of(description, *scene.volume));
  }
  scene.size = description.size;
  scene.samples = description.samples;
  scene.camera = description.camera ? *description.camera
                                    : default_camera(world_corners(scene), description.size);
  scene.integration = description.integration;
  scene.background = description.background;
  return scene;
}

}  // namespace pellucid
