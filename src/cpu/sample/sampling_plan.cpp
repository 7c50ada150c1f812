// SPDX-License-Identifier: Apache-2.0
#include "sampling_plan.h"

#include <algorithm>

#include "pellucid/render/sample_ray.h"
#include "psi_table_storage.h"

namespace pellucid {
namespace {

SegmentRule rule_of(Method method) {
  switch (method) {
    case Method::rectangle:
      return SegmentRule::rectangle;
    case Method::taylor:
      return SegmentRule::taylor;
    case Method::midpoint:
    case Method::homogeneous:
      return SegmentRule::midpoint;
    case Method::trapezoid:
    case Method::average:
      return SegmentRule::trapezoid;
    case Method::simpson:
      return SegmentRule::simpson;
    case Method::partial:
      return SegmentRule::partial;
    case Method::preintegrated:
      return SegmentRule::preintegrated;
    case Method::kniss:
      return SegmentRule::kniss;
    case Method::gaussian:
      return SegmentRule::gaussian;
    case Method::linear:
    case Method::exact:
      break;
  }
  return SegmentRule::linear;
}

bool is_mesh(const Layer& layer) {
  return std::holds_alternative<MeshContent>(layer.content);
}

double voxel_of_steps(const Layer& layer) {
  const Volume* const volume = grid_of(layer);
  return volume != nullptr ? volume->voxel_size() : voxel_of(layer);
}

/// Returns the least and largest value of a layer's first channel.
Interval<double> range_of(const Layer& layer) {
  if (const auto* const mesh = std::get_if<MeshContent>(&layer.content)) {
    const auto& data = mesh->mesh->statistics(0);
    return {data.minimum, data.maximum};
  }
  if (const auto* const own = std::get_if<SourceContent>(&layer.content)) {
    const StretchSource::Variable& variable = own->source->description().variables[0];
    return {variable.minimum, variable.maximum};
  }
  const VolumeStatistics& data = grid_of(layer)->statistics();
  return {data.minimum, data.maximum};
}

}  // namespace

SamplingPlan::SamplingPlan(const std::vector<ClippedLayer>& layers, const Integration& integration,
                           double largest_color, bool depth)
    : rule_(rule_of(integration.method)),
      by_cells_(
          takes_cells(integration.method) &&
          std::ranges::all_of(
              layers, [](const ClippedLayer& layer) { return is_mesh(layer.setup->layer()); })),
      stop_(stop_tolerance<double>() / std::max(largest_color, 1.0)),
      depth_(depth) {
  for (const ClippedLayer& layer : layers) {
    steps_.push_back(integration.step * voxel_of_steps(layer.setup->layer()));
  }
  if (rule_ == SegmentRule::partial) psi_ = psi_table();
  if (rule_ != SegmentRule::preintegrated) return;
  for (const ClippedLayer& layer : layers) {
    const Interval<double> range = range_of(layer.setup->layer());
    const double step = steps_[tables_.size()];
    auto& of_layer = tables_.emplace_back();
    for (const MultivariateTransfer<double>& function : layer.setup->source().functions()) {
      of_layer.push_back(std::make_unique<const PreintegratedStorage>(
          function.table[0].table, range.begin, range.end, step, ParallelFor{}));
    }
  }
}

}  // namespace pellucid
