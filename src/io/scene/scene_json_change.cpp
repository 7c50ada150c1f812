// SPDX-License-Identifier: Apache-2.0
#include "scene_json_change.h"

#include <memory>
#include <utility>
#include <variant>

#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

/// Calls visit(data, function) with the data and the function of one variable of a layer. Returns
/// whether it has one.
template <class AnyLayer, class Visit>
bool visit_function(AnyLayer& layer, const Visit& visit) {
  if (auto* const volume = std::get_if<VolumeContent>(&layer.content)) {
    visit(*volume->volume, volume->transfer_function);
    return true;
  }
  auto* const mesh = std::get_if<MeshContent>(&layer.content);
  if (mesh == nullptr || mesh->univariate() == nullptr) return false;
  visit(*mesh->mesh, std::get<std::shared_ptr<const TransferFunction>>(mesh->transfer_function));
  return true;
}

}  // namespace

OpacityTable changed(const OpacityTable& table, const FunctionChange& change,
                     const std::optional<std::array<double, 2>>& range) {
  OpacityTable made = table;
  made.points = changed(table.points, change, range);
  if (!change.colors.empty()) made.color_deviation = 0;
  if (change.opacity > 0) {
    made.unit_distance /= change.opacity;
  } else {
    for (OpacityPoint& point : made.points) point.opacity = 0;
  }
  return made;
}

void change_function(const LayerDescription& description, Layer& layer) {
  const FunctionChange& change = description.function_change;
  if (change.is_none()) return;
  const bool has_one = visit_function(layer, [&](const auto& data, auto& function) {
    function = std::make_shared<const TransferFunction>(changed(*function, change, data));
  });
  if (has_one) return;
  throw Error(
      "scene: a color map, a range and a factor of the opacity are for a function of one variable; "
      "edit the terms of the function, or the looks of the labels");
}

std::optional<TransferFunctionDescription> changed_table(const LayerDescription& description,
                                                         const Layer& layer) {
  const FunctionChange& change = description.function_change;
  const auto& function = description.transfer_function;
  const auto* const table = function ? std::get_if<OpacityTable>(&*function) : nullptr;
  if (table == nullptr || change.is_none()) return function;
  std::optional<OpacityTable> made;
  visit_function(layer, [&](const auto& data, const auto&) {
    made = changed(*table, change, range_of(change, data));
  });
  return made;
}

void write_changed_function(const Layer& layer, LayerDescription& description) {
  if (description.function_change.is_none()) return;
  if (const auto& function = description.transfer_function;
      function && std::holds_alternative<OpacityTable>(*function)) {
    description.transfer_function = changed_table(description, layer);
  } else {
    visit_function(layer, [&](const auto&, const auto& made) {
      description.transfer_function = made->points();
    });
  }
  description.function_change = {};
}

}  // namespace pellucid
