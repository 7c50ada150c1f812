// SPDX-License-Identifier: Apache-2.0
#include "projection/projected_tracer.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "layers/clip_intervals.h"

namespace pellucid {

ProjectedTracer::ProjectedTracer(std::vector<Layer> layers, std::unique_ptr<const RayTracer> others,
                                 const std::vector<Clip>& clips, double largest_color,
                                 const ParallelFor& parallel)
    : layers_(std::move(layers)),
      others_(std::move(others)),
      largest_color_(std::max(largest_color, 1.0)) {
  for (const Layer& layer : layers_) {
    projectors_.push_back(make_layer_projector({layer, clips_of(layer, clips), parallel}));
    colors_.emplace_back(function_of(layer));
  }
}

ProjectedTracer::Front ProjectedTracer::front_of(
    const RayPart& part, const std::vector<std::unique_ptr<ProjectionWorkspace>>& workspaces,
    double* value) const {
  Front front;
  for (std::size_t i = 0; i < projectors_.size(); ++i) {
    const RayValue found = projectors_[i]->project(part.ray, part.range.end, *workspaces[i]);
    front.shown = composite(colors_[i].show(found), front.shown);
    front.cells += found.cells;
    if (value != nullptr) *value = found.value;
  }
  return front;
}

std::vector<RayResult> ProjectedTracer::trace(const std::vector<RayPart>& parts,
                                              const TraceOptions& options,
                                              std::vector<double>* values) const {
  std::vector<std::unique_ptr<ProjectionWorkspace>> workspaces;
  for (const auto& projector : projectors_) workspaces.push_back(projector->workspace());
  if (values != nullptr) values->assign(parts.size(), 0);
  std::vector<Front> fronts;
  fronts.reserve(parts.size());
  std::vector<RayResult> results(parts.size(), missed_ray_result());
  // The others matter only where something of them is seen.
  std::vector<RayPart> behind;
  std::vector<std::size_t> ray_of;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (options.stop.stop_requested()) return results;
    fronts.push_back(front_of(parts[i], workspaces, values != nullptr ? &(*values)[i] : nullptr));
    const ShownValue& shown = fronts.back().shown;
    if (others_ == nullptr || shown.opacity - shown.opacity_error >= 1) continue;
    behind.push_back(parts[i]);
    ray_of.push_back(i);
  }
  if (!behind.empty()) {
    const std::vector<RayResult> found = others_->trace(behind, options);
    for (std::size_t n = 0; n < found.size(); ++n) results[ray_of[n]] = found[n];
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    RayResult& result = results[i];
    put_over(fronts[i].shown, largest_color_, result);
    result.cells += fronts[i].cells;
    result.evaluations += fronts[i].cells;
    ++result.spans.closed;
  }
  return results;
}

}  // namespace pellucid
