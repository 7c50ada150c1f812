// SPDX-License-Identifier: Apache-2.0
#include "scene_times.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

#include "pellucid/scene/error.h"
#include "view/command.h"

namespace pellucid::view {

namespace {

/// Calls visit(time) with the time of each source, which may be changed. A component is a step of
/// its own.
template <class Visit>
void visit_times(SceneDescription& scene, const Visit& visit) {
  for (LayerDescription& layer : scene.layers) {
    visit_sources(layer, [&](FieldSource& field) {
      if (!field.options.component) visit(field.options.time);
    });
    if (layer.mesh) visit(layer.mesh->options.time);
  }
}

/// Returns the scene with the first values of the tracks that move times of single sources.
SceneDescription with_moved_times(const SceneDescription& scene) {
  if (!scene.animation) return scene;
  Json document = Json::parse(scene_to_json(scene));
  document.erase("animation");
  bool has_any = false;
  for (const AnimationTrack& track : scene.animation->tracks) {
    const std::string_view target = track.target;
    if (!target.starts_with("/layers/") || !target.ends_with("/time")) continue;
    document[Json::json_pointer(track.target)] = Json::parse(track.keys.front().value);
    has_any = true;
  }
  if (!has_any) return scene;
  SceneDescription moved = parse_scene(document.dump(), "scene");
  moved.animation = scene.animation;
  return moved;
}

/// Returns the time of the scene that reads what the sources say; none: there is none.
std::optional<double> common_time(const SceneDescription& scene, const SceneDescription& bare,
                                  const SceneTimes& times) {
  std::vector<double> given;
  SceneDescription shown = bare, copy = scene;
  times.set(shown, times.all().front());
  std::vector<std::optional<double>> sources;
  visit_times(copy, [&](std::optional<double>& time) { sources.push_back(time); });
  bool is_common = true;
  auto source = sources.begin();
  visit_times(shown, [&](std::optional<double>& time) {
    if (*source) given.push_back(**source);
    is_common = is_common && source->has_value() == time.has_value() &&
                (!time || **source == given.front());
    if (*source) time = *source;
    ++source;
  });
  if (given.empty()) return std::nullopt;
  if (is_common) return given.front();
  const std::string wanted = scene_to_json(shown);
  for (const double time : given) {
    SceneDescription tried = bare;
    times.set(tried, time);
    if (scene_to_json(tried) == wanted) return time;
  }
  return std::nullopt;
}

}  // namespace

SceneTimes take_times(SceneDescription& description) {
  try {
    const SceneDescription moved = with_moved_times(description);
    if (description.time) return SceneTimes(moved);
    SceneDescription bare = moved;
    bool has_times = false;
    visit_times(bare, [&](std::optional<double>& time) {
      has_times = has_times || time;
      time.reset();
    });
    const bool tracks_move = scene_to_json(moved) != scene_to_json(description);
    if (!has_times || tracks_move) return SceneTimes(moved);
    SceneTimes times(bare);
    if (times.all().empty()) return times;
    if (const std::optional<double> time = common_time(description, bare, times)) {
      visit_times(description, [](std::optional<double>& each) { each.reset(); });
      description.time = time;
      return times;
    }
    return SceneTimes(description);
  } catch (const Error&) {
    // The data are there; their times cannot be listed.
    SceneDescription none = description;
    none.layers.clear();
    return SceneTimes(none);
  }
}

}  // namespace pellucid::view
