// SPDX-License-Identifier: Apache-2.0
#include "scene_facts.h"

#include <algorithm>
#include <array>
#include <utility>

#include "film/film_job.h"
#include "histograms.h"
#include "pellucid/geometry/box_around.h"
#include "pellucid/io/internal/patient_space.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/presets.h"
#include "pellucid/scene/view_camera.h"
#include "slice.h"

namespace pellucid::view {

namespace {

const char* kind_of(const Layer& layer) {
  constexpr const char* names[] = {"volume", "channels", "mesh", "labels"};
  return names[layer.content.index()];
}

/// Returns the range of each channel that slices show.
Json ranges_of(const Layer& layer) {
  Json ranges = Json::array();
  const auto add = [&](const VolumeStatistics& statistics) {
    ranges.push_back({statistics.minimum, statistics.maximum});
  };
  if (const auto* volume = std::get_if<VolumeContent>(&layer.content)) {
    add(volume->volume->statistics());
  } else if (const auto* channels = std::get_if<ChannelsContent>(&layer.content)) {
    for (const Channel& channel : *channels->channels) add(channel.volume->statistics());
  } else if (const auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    for (int c = 0; c < mesh->mesh->count(); ++c) add(mesh->mesh->statistics(c));
  }
  return ranges;
}

Json box_of(const Scene& scene) {
  const auto [lower, upper] = box_around(world_corners(scene));
  return {{"lower", {lower.x, lower.y, lower.z}}, {"upper", {upper.x, upper.y, upper.z}}};
}

/// Returns whether a part of the layer's file can be chosen: it is one field of a file.
bool is_one_field(const LayerDescription& layer) {
  return !layer.mesh && !layer.labels && !layer.mask && layer.channels.empty() &&
         layer.field.builtin.empty() && has_source(layer.field);
}

/// Returns whether there is a file that could hold other arrays or times.
bool has_file(const LayerDescription& layer) {
  return layer.mesh ? layer.mesh->file != array_in_memory : is_one_field(layer);
}

int components_of(const LayerDescription& layer) {
  if (!is_one_field(layer)) return 1;
  ReadOptions options = layer.field.options;
  options.note = {};
  options.component.reset();
  options.component_name.reset();
  options.time.reset();
  try {
    return component_count(layer.field.file, options);
  } catch (const Error&) {
    return 1;  // The file was read as the options say; there is nothing to choose.
  }
}

}  // namespace

std::vector<FileChoices> file_choices(const SceneDescription& description) {
  std::vector<FileChoices> result;
  for (const LayerDescription& layer : description.layers) {
    result.push_back({components_of(layer)});
  }
  return result;
}

FileChoices all_choices(const LayerDescription& layer) {
  FileChoices choices{components_of(layer)};
  if (layer.mesh && has_file(layer)) {
    MeshReadOptions options = layer.mesh->options;
    options.note = {};
    const MeshFile file = read_mesh(layer.mesh->file, options);
    for (const MeshArray& array : file.grid.arrays) choices.arrays.push_back(array.name);
    choices.times = file.times;
  } else if (is_one_field(layer)) {
    ReadOptions options = layer.field.options;
    options.note = {};
    for (const VolumeArray& array : list_arrays(layer.field.file, options)) {
      if (array.unreadable_reason.empty()) choices.arrays.push_back(array.name);
    }
  }
  if (choices.arrays.size() < 2 && choices.times.size() < 2) {
    throw Error("the file has no other arrays and no steps of time");
  }
  return choices;
}

Lettering lettering_of(const SceneDescription& description) {
  const bool anatomical = std::ranges::all_of(description.layers, is_of_patient);
  return {anatomical, anatomical ? "mm" : ""};
}

namespace {

/// Returns what pages show of the times of the data and of the film.
Json timeline_json(const SceneState& state) {
  const Animation& film = state.film_length();
  const std::vector<Keyframe> keyframes = keyframes_of(film);
  Json keys = Json::array();
  for (const Keyframe& keyframe : keyframes) {
    keys.push_back(
        {{"at", keyframe.at}, {"camera", keyframe.has_camera}, {"parts", keyframe.targets}});
  }
  Json follows = Json::array();
  for (std::size_t i = 0; i < state.scene().layers.size(); ++i) {
    follows.push_back(state.follows_time(i));
  }
  const auto chosen = keyframe_at(keyframes, state.frame(), film.fps);
  return {{"times", state.times()},
          {"time_unit", state.times_unit()},
          {"times_left_out", state.times_left_out()},
          {"time", state.time()},
          {"follows", std::move(follows)},
          {"has_film", state.description().animation.has_value()},
          {"seconds", film.seconds},
          {"fps", film.fps},
          {"frames", frame_count(film)},
          {"frame", state.frame()},
          {"keyframes", std::move(keys)},
          {"keyframe", chosen ? Json(*chosen) : Json()},
          {"moves_data", film.moves_data()},
          {"by_steps", film.by_steps},
          {"turns", film.turntable ? Json(film.turntable->turns) : Json()},
          {"formats", savable_film_formats()}};
}

bool is_savable(const SceneDescription& description) {
  try {
    check_has_sources(description);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

Json scene_json(const SceneState& state, const std::vector<FileChoices>& choices) {
  Json layers = Json::array();
  for (std::size_t i = 0; i < choices.size(); ++i) {
    const Layer& layer = state.scene().layers[i];
    const Json ranges = ranges_of(layer);
    layers.push_back({{"kind", kind_of(layer)},
                      {"channels", channel_names_of(layer)},
                      {"range", ranges.empty() ? Json::array({0, 1}) : ranges[0]},
                      {"ranges", ranges},
                      {"steps", slice_steps_json(layer)},
                      {"file", has_file(state.description().layers[i])},
                      {"components", choices[i].components},
                      {"arrays", choices[i].arrays},
                      {"times", choices[i].times}});
  }
  Json names = Json::array();
  for (const Preset& preset : presets()) {
    names.push_back({{"name", preset.name},
                     {"description", preset.description},
                     {"hounsfield", preset.hounsfield},
                     {"lit", preset.lit}});
  }
  return {{"type", "scene"},
          {"timeline", timeline_json(state)},
          {"scene", Json::parse(scene_to_json(state.portable_description()))},
          {"savable", is_savable(state.description())},
          {"temporary", state.has_temporary_folder()},
          {"layers", std::move(layers)},
          {"box", box_of(state.scene())},
          {"presets", std::move(names)},
          {"sides", view_names()},
          {"anatomical", lettering_of(state.description()).anatomical},
          {"can_undo", state.can_undo()},
          {"can_redo", state.can_redo()}};
}

}  // namespace pellucid::view
