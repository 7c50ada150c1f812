// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "layer_functions.h"
#include "pellucid/io/internal/patient_space.h"
#include "pellucid/io/read_volume.h"
#include "pellucid/io/scene_json.h"
#include "scene_json_change.h"

namespace pellucid {

void complete_description(const Layer& layer, LayerDescription& description) {
  write_changed_function(layer, description);
  const auto is_open = [](const std::optional<TransferFunctionDescription>& function) {
    return !function || std::holds_alternative<PresetDescription>(*function);
  };
  if (auto* labels = std::get_if<LabelContent>(&layer.content)) {
    show_as_labels(description);  // of a look that does
    description.labels->styles = labels->table->styles();
    description.labels->table.clear();
    description.labels->extinction.reset();
  }
  if (auto* mesh = std::get_if<MeshContent>(&layer.content)) {
    if (is_open(description.transfer_function) && mesh->univariate() != nullptr) {
      description.transfer_function = mesh->univariate()->points();
    }
  }
  if (description.look) {
    description.look.reset();
    description.shading = layer.shading;
  }
  description.isosurfaces = layer.isosurfaces;
  description.slices = layer.slices;
  const auto* const volume = std::get_if<VolumeContent>(&layer.content);
  if (volume == nullptr) return;
  if (is_open(description.transfer_function)) {
    description.transfer_function = volume->transfer_function->points();
  }
  if (!volume->mask) return;
  for (std::size_t i = 0; i < volume->mask->choices().size(); ++i) {
    TransferFunctionDescription& function = description.mask->choices[i].transfer_function;
    if (is_open(function)) function = volume->mask->choices()[i].transfer_function->points();
  }
}

bool is_of_patient(const LayerDescription& layer) {
  const auto is_placed = [](const FieldSource& field) {
    return field.builtin.empty() && has_source(field) &&
           is_placed_in_lps(field.file, field.options);
  };
  if (layer.mesh) return false;
  if (layer.labels) return is_placed(layer.labels->field);
  if (layer.channels.empty()) return is_placed(layer.field);
  return std::ranges::all_of(layer.channels, [&](const ChannelSource& channel) {
    const auto* const field = std::get_if<FieldSource>(&channel.source);
    return field == nullptr || is_placed(*field);
  });
}

void visit_sources(LayerDescription& layer, const std::function<void(FieldSource&)>& visit) {
  visit(layer.field);
  for (ChannelSource& channel : layer.channels) {
    if (auto* field = std::get_if<FieldSource>(&channel.source)) visit(*field);
  }
  if (layer.labels) visit(layer.labels->field);
  if (layer.mask) visit(layer.mask->field);
}

void visit_paths(SceneDescription& description,
                 const std::function<void(std::filesystem::path&)>& visit) {
  for (LayerDescription& layer : description.layers) {
    visit_sources(layer, [&](FieldSource& field) { visit(field.file); });
    if (layer.mesh) {
      visit(layer.mesh->file);
      visit(layer.mesh->options.q);
    }
    if (layer.labels) visit(layer.labels->table);
  }
  visit(description.backdrop);
}

}  // namespace pellucid
