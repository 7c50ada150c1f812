// SPDX-License-Identifier: Apache-2.0
#include "scene_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "cli/arguments/parse.h"
#include "film/scene_times.h"
#include "pellucid/scene/error.h"

namespace pellucid::view {

namespace {

constexpr std::size_t longest_history = 100;

constexpr std::array<std::string_view, 2> scene_keys{"clip", "lights"};
constexpr std::array<std::string_view, 8> layer_keys{
    "visible", "transfer_function", "shading",     "gradient_opacity",
    "clip",    "projection",        "isosurfaces", "slices"};

/// Turns a text "#rrggbb" into linear numbers.
void convert_color(Json& value) {
  if (!value.is_string()) return;
  const Rgb<double> color = cli::parse_color("color", value.get<std::string>());
  value = {color.r, color.g, color.b};
}

/// Turns every "color": "#rrggbb" into linear numbers.
void convert_colors(Json& value) {
  if (value.is_array()) {
    for (Json& element : value) convert_colors(element);
  } else if (value.is_object()) {
    for (auto& [key, member] : value.items()) {
      if (key == "color") {
        convert_color(member);
      } else {
        convert_colors(member);
      }
    }
  }
}

void put(Json& object, const std::string& key, Json value) {
  if (value.is_null()) {
    object.erase(key);
  } else {
    object[key] = std::move(value);
  }
}

/// Puts the value of an edit into the document of a scene.
void apply(const Edit& edit, Json& document) {
  const auto refuse = [&] { throw Error(fmt::format("edit: \"{}\" cannot be edited", edit.key)); };
  Json value = edit.value;
  convert_colors(value);
  if (!edit.layer) {
    if (edit.key == "background") {
      if (value == "transparent") {
        document["image"]["background"] = nullptr;
        return;
      }
      convert_color(value);
      return put(document["image"], "background", std::move(value));
    }
    if (std::ranges::find(scene_keys, edit.key) == scene_keys.end()) refuse();
    return put(document, edit.key, std::move(value));
  }
  Json& layer = document["layers"][*edit.layer];
  if (edit.key == "colors" && layer.contains("labels")) {
    return put(layer["labels"], "colors", std::move(value));
  }
  if (std::ranges::find(layer_keys, edit.key) == layer_keys.end()) refuse();
  put(layer, edit.key, std::move(value));
}

std::string text_of(const LayerDescription& layer) {
  return layer.transfer_function ? transfer_function_to_json(*layer.transfer_function) : "";
}

}  // namespace

void SceneState::use_matrices(LayerDescription& layer) {
  if (!layer.transfer_function) return;
  auto* const function = std::get_if<MultivariateDescription>(&*layer.transfer_function);
  if (function == nullptr) return;
  for (GaussianPrimitive& gaussian : function->gaussians) {
    gaussian.matrix = gaussian_matrix(gaussian);
    gaussian.shape.reset();
    if (!gaussian.channels.empty()) continue;
    const std::vector<std::string> names =
        function->channels.empty() ? function_channels(layer) : function->channels;
    gaussian.channels.assign(names.begin(), names.end());
  }
}

SceneState::SceneState(SceneDescription description, Scene scene, ParallelFor parallel)
    : description_(std::move(description)),
      scene_(std::move(scene)),
      parallel_(std::move(parallel)),
      times_(take_times(description_)) {
  for (LayerDescription& layer : description_.layers) use_matrices(layer);
  keyed_ = with_time();
}

void SceneState::set_camera(const Camera& camera) {
  try {
    make_camera_frame(camera, scene_.size);
  } catch (const Error&) {
    return;  // A drag that leads nowhere, such as into the focal point.
  }
  description_.camera = camera;
  scene_.camera = camera;
  // A turntable starts from what is seen.
  if (turntable_camera_) frame_ = 0;
  turntable_camera_.reset();
  film_.reset();
}

void SceneState::set_size(ImageSize size) {
  if (scene_.backdrop) return;  // whose size it is
  description_.size = size;
  scene_.size = size;
  film_.reset();
}

void SceneState::set_tolerance(double tolerance) {
  scene_.integration.tolerance = nearest_tolerance(tolerance);
  description_.integration.tolerance = scene_.integration.tolerance;
  fit_opacity_tables(description_, scene_);
  film_.reset();
}

std::size_t SceneState::checked_layer(std::size_t layer) const {
  if (layer < description_.layers.size()) return layer;
  throw Error(
      fmt::format("layer {}: there are {} layers only", layer + 1, description_.layers.size()));
}

void SceneState::edit(const Edit& edit) {
  if (edit.layer) checked_layer(*edit.layer);
  Json document = Json::parse(scene_to_json(description_));
  apply(edit, document);
  SceneDescription next = parse_scene(document.dump(), "scene");
  if (edit.layer) use_matrices(next.layers[*edit.layer]);
  take_step(std::move(next), edit.layer.value_or(0), edit.layer ? 1 : 0, edit.gesture);
}

void SceneState::set_look(std::size_t layer, const LookDescription& look) {
  SceneDescription next = description_;
  LayerDescription& target = next.layers[checked_layer(layer)];
  target.transfer_function = look.transfer_function;
  if (look.shading) target.shading = look.shading;
  if (look.gradient_opacity) target.gradient_opacity = look.gradient_opacity;
  use_matrices(target);
  take_step(std::move(next), layer, 1, no_gesture);
}

void SceneState::set_gaussians(std::size_t layer, MultivariateDescription gaussians) {
  SceneDescription next = description_;
  LayerDescription& target = next.layers[checked_layer(layer)];
  target.transfer_function = std::move(gaussians);
  target.shading.reset();
  use_matrices(target);
  take_step(std::move(next), layer, 1, no_gesture);
}

void SceneState::refine_gaussians(std::size_t layer, MultivariateDescription gaussians) {
  SceneDescription next = description_;
  LayerDescription& target = next.layers[checked_layer(layer)];
  const std::string before = function_text(layer);
  target.transfer_function = std::move(gaussians);
  use_matrices(target);
  const auto refined = target.transfer_function;
  become(std::move(next), layer, 1);
  for (auto* const history : {&undone_by_, &redone_by_}) {
    for (auto& [step, keyed] : *history) {
      if (text_of(step.layers[layer]) == before) step.layers[layer].transfer_function = refined;
    }
  }
}

std::string SceneState::function_text(std::size_t layer) const {
  return text_of(description_.layers[checked_layer(layer)]);
}

void SceneState::set_default_function(std::size_t layer) {
  SceneDescription next = description_;
  LayerDescription& target = next.layers[checked_layer(layer)];
  SceneDescription without = with_open_function(layer);
  LayerDescription& bare = without.layers[layer];
  complete_description(remake_layer(timed(without), layer, scene_.layers[layer], parallel_), bare);
  target.transfer_function = bare.transfer_function;
  target.shading = bare.shading;
  take_step(std::move(next), layer, 1, no_gesture);
}

SceneDescription SceneState::with_open_function(std::size_t layer) const {
  SceneDescription without = description_;
  LayerDescription& bare = without.layers[checked_layer(layer)];
  bare.transfer_function.reset();
  // A volume as the program shows a file alone. Beside surfaces the light is theirs, too, and a
  // layer without a function would be transparent.
  const bool takes_look =
      !bare.shows_surfaces() && std::holds_alternative<VolumeContent>(scene_.layers[layer].content);
  if (takes_look) {
    bare.look.emplace();
    bare.look->has_function = true;
  }
  bare.isosurfaces.clear();
  bare.slices.clear();
  return without;
}

bool SceneState::have_same_look(const LayerDescription& a, const LayerDescription& b) {
  SceneDescription one, other;
  one.layers = {a};
  other.layers = {a};
  copy_look(b, other.layers.front());
  return scene_to_json(one) == scene_to_json(other);
}

void SceneState::take_choice(std::size_t layer, const LayerDescription& chosen) {
  const LayerDescription before = description_.layers[checked_layer(layer)];
  SceneDescription next = description_, open = description_;
  LayerDescription& completed = open.layers[layer];
  copy_choice(chosen, completed);
  complete_description(remake_layer(timed(open), layer, scene_.layers[layer], parallel_),
                       completed);
  copy_look(completed, next.layers[layer]);
  become(std::move(next), layer, 1);
  const LayerDescription& taken = description_.layers[layer];
  const auto renew = [&](SceneDescription& description) {
    LayerDescription& own = description.layers[layer];
    if (have_same_look(own, before)) copy_look(taken, own);
  };
  renew(keyed_);
  for (auto* const history : {&undone_by_, &redone_by_}) {
    for (auto& [description, keyed] : *history) {
      renew(description);
      renew(keyed);
    }
  }
}

void SceneState::set_clips(std::vector<Clip> clips, int gesture) {
  SceneDescription next = description_;
  next.clips = std::move(clips);
  take_step(std::move(next), 0, 0, gesture);
}

void SceneState::set_source(std::size_t layer, const std::function<void(LayerDescription&)>& change,
                            bool keeps_function) {
  SceneState next = *this;
  LayerDescription& target = next.description_.layers[checked_layer(layer)];
  change(target);
  if (!keeps_function) {
    target.transfer_function.reset();
    target.isosurfaces.clear();
    target.slices.clear();
  }
  next.times_ = take_times(next.description_);
  // The others keep their data, which may be arrays in memory.
  SceneDescription alone = next.timed(next.description_);
  alone.layers = {alone.layers[layer]};
  check_has_sources(alone);
  std::vector<MeshSource> meshes;
  next.scene_.layers[layer] = make_scene(alone, parallel_, &meshes).layers.front();
  check_data(next.scene_);
  if (target.mesh) target.mesh->channels = meshes.front().channels;
  fit_opacity_tables(next.description_, next.scene_);
  complete_description(next.scene_.layers[layer], target);
  // Steps back would show the other data again, without reading them.
  next.undone_by_.clear();
  next.redone_by_.clear();
  next.last_gesture_ = no_gesture;
  next.film_.reset();
  next.keyed_ = next.with_time();
  *this = std::move(next);
}

void SceneState::become(SceneDescription next, std::size_t first, std::size_t count) {
  Scene scene = scene_;
  scene.clips = next.clips;
  scene.lights = next.lights;
  scene.background = next.background;
  const SceneDescription at_time = count > 0 ? timed(next) : SceneDescription{};
  for (std::size_t i = first; i < first + count; ++i) {
    scene.layers[i] = remake_layer(at_time, i, scene_.layers[i], parallel_);
    complete_description(scene.layers[i], next.layers[i]);
  }
  check_data(scene);
  check_method(scene);
  fit_opacity_tables(next, scene);
  next.camera = scene_.camera;
  description_ = std::move(next);
  scene_ = std::move(scene);
  film_.reset();
}

void SceneState::take_step(SceneDescription next, std::size_t first, std::size_t count,
                           int gesture) {
  SceneDescription before = description_;
  become(std::move(next), first, count);
  remember(std::move(before), gesture);
}

void SceneState::remember(SceneDescription before, int gesture) {
  redone_by_.clear();
  if (gesture != no_gesture && gesture == last_gesture_) return;
  last_gesture_ = gesture;
  undone_by_.push_back({std::move(before), keyed_});
  if (undone_by_.size() > longest_history) undone_by_.erase(undone_by_.begin());
}

void SceneState::step(std::vector<Step>& from, std::vector<Step>& to) {
  if (from.empty()) return;
  auto [next, keyed] = from.back();
  const auto moves_data = [](const SceneDescription& scene) {
    return scene.animation && scene.animation->moves_data();
  };
  // Choosing a time is no step, but a film may have changed it.
  const std::optional<double> time = moves_data(description_) ? next.time : description_.time;
  next.time = description_.time;
  next.size = description_.size;
  next.integration = description_.integration;
  SceneDescription before = description_;
  become(std::move(next), 0, scene_.layers.size());
  from.pop_back();
  to.push_back({std::move(before), std::exchange(keyed_, std::move(keyed))});
  last_gesture_ = no_gesture;
  if (time != description_.time) {
    SceneDescription then = description_;
    then.time = time;
    load(std::move(then));
  }
  show_film();
}

void SceneState::undo() {
  step(undone_by_, redone_by_);
}

void SceneState::redo() {
  step(redone_by_, undone_by_);
}

SceneDescription SceneState::portable_description() const {
  SceneDescription description = description_;
  if (turntable_camera_) description.camera = turntable_camera_;
  visit_paths(description, [&](std::filesystem::path& path) {
    if (path.empty() || path == array_in_memory) return;
    path = std::filesystem::absolute(path).lexically_normal();
    const std::filesystem::path within = path.lexically_relative(temporary_);
    if (!temporary_.empty() && !within.empty() && *within.begin() != "..") path = within;
  });
  return description;
}

std::string SceneState::saved() const {
  check_has_sources(description_);
  SceneDescription description = portable_description();
  if (length_is_set_ && !description.animation) description.animation = film_to_save();
  return scene_to_json(description);
}

}  // namespace pellucid::view
