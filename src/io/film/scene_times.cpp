// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "axes/time_steps.h"
#include "meshes/mesh_blocks.h"
#include "pellucid/io/film.h"
#include "pellucid/io/time_steps.h"
#include "pellucid/scene/error.h"
#include "scene/layer_functions.h"
#include "text/json_document.h"
#include "text/printable.h"

namespace pellucid {
namespace {

/// Calls visit(source, options) with each source of a layer that is used, and its options.
template <class Visit>
void visit_timed(LayerDescription& layer, const Visit& visit) {
  visit_sources(layer, [&](FieldSource& field) {
    const bool is_used =
        &field != &layer.field || !(layer.mesh || layer.labels || !layer.channels.empty());
    if (is_used && has_source(field) && field.builtin.empty()) visit(field, field.options);
  });
  if (layer.mesh && layer.mesh->file != array_in_memory) visit(*layer.mesh, layer.mesh->options);
}

/// Calls visit(times, options) with the options of each source that has times.
template <class Visit>
void visit_steps(const std::vector<std::vector<std::vector<double>>>& times,
                 SceneDescription& description, const Visit& visit) {
  for (std::size_t i = 0; i < times.size(); ++i) {
    auto own = times[i].begin();
    visit_timed(description.layers[i], [&](auto&, auto& options) {
      if (!own->empty()) visit(*own, options);
      ++own;
    });
  }
}

/// Returns whether the component that is chosen is one of these steps, and not of what is there at
/// each. Images have channels beside their times.
bool is_one_step(const FieldSource& source, const StepTimes& steps) {
  const std::string extension = source.file.extension().string();
  const bool is_image = extension == ".tif" || extension == ".tiff" || extension == ".ome";
  if (!source.options.component || is_image || steps.times.empty()) return false;
  ReadOptions at_step = source.options;
  at_step.time = steps.times.front();
  at_step.part = {};
  at_step.note = {};
  try {
    return component_count(source.file, at_step) < 2;
  } catch (const Error&) {
    return true;  // A time or a component is given, not both.
  }
}
bool is_one_step(const MeshSource&, const StepTimes&) {
  return false;
}

}  // namespace

SceneTimes::SceneTimes(const SceneDescription& description) {
  SceneDescription scene = description;
  times_.resize(scene.layers.size());
  std::vector<std::string> units;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    visit_timed(scene.layers[i], [&](const auto& source, const auto& options) {
      StepTimes steps = options.time ? StepTimes() : source_steps(source);
      if (is_one_step(source, steps)) steps = {};
      if (!steps.times.empty()) units.push_back(std::move(steps.unit));
      times_[i].push_back(std::move(steps.times));
      left_out_ += std::erase_if(times_[i].back(), [](double time) {
        return std::abs(time) > scene_json::largest_number;
      });
      all_.insert(all_.end(), times_[i].back().begin(), times_[i].back().end());
    });
  }
  all_ = ascending_times(std::move(all_));
  const bool is_one =
      std::ranges::all_of(units, [&](const auto& unit) { return unit == units[0]; });
  if (is_one && !units.empty()) unit_ = printable(units[0]);
}

std::vector<double> SceneTimes::of(std::size_t layer) const {
  std::vector<double> times;
  for (const auto& each : times_[layer]) times.insert(times.end(), each.begin(), each.end());
  return ascending_times(std::move(times));
}

void SceneTimes::set(SceneDescription& description, double moment) const {
  visit_steps(times_, description, [&](const std::vector<double>& times, auto& options) {
    options.time = options.time_between == TimeBetween::linear
                       ? std::clamp(moment, times.front(), times.back())
                       : times[nearest_step(times, moment)];
  });
}

void SceneTimes::clear(SceneDescription& description) const {
  visit_steps(times_, description,
              [](const std::vector<double>&, auto& options) { options.time.reset(); });
}

double first_time(const Animation& film, const SceneTimes& times) {
  return film.time ? (*film.time)[0] : times.all().front();
}

void set_first_time(const Animation& film, SceneDescription& description) {
  const SceneTimes times(description);
  if (!times.all().empty()) times.set(description, first_time(film, times));
}

void set_first_step(SceneDescription& description) {
  const auto& film = description.animation;
  if (description.time || (film && film->moves_data())) return;
  try {
    const SceneTimes times(description);
    if (!times.all().empty()) times.set(description, times.all().front());
  } catch (const Error&) {
    // Reading the data says what is wrong with them.
  }
}

void resolve_time(SceneDescription& description) {
  if (!description.time) return;
  const SceneTimes times(description);
  if (times.all().empty()) {
    throw Error(
        "scene: \"time\" is given, but no data of it have steps without a time of their own");
  }
  times.set(description, *description.time);
  description.time.reset();
}

void copy_look(const LayerDescription& from, LayerDescription& to) {
  to.transfer_function = from.transfer_function;
  to.function_change = from.function_change;
  to.isosurfaces = from.isosurfaces;
  to.shading = from.shading;
  if (from.labels && to.labels) to.labels->styles = from.labels->styles;
}

void copy_choice(const LayerDescription& from, LayerDescription& to) {
  if (from.labels) show_as_labels(to);
  copy_look(from, to);
  to.slices = from.slices;
  to.look = from.look;
}

}  // namespace pellucid
