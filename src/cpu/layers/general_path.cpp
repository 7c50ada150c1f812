// SPDX-License-Identifier: Apache-2.0
#include "general_path.h"

#include <algorithm>
#include <limits>

#include "pellucid/render/multivariate_integrator.h"

namespace pellucid {

GeneralPath::GeneralPath(const std::vector<ClippedLayer>& layers,
                         const std::vector<LightSource<double>>& lights, const RayTolerance& wanted)
    : wanted_(wanted),
      lights_(lights),
      merge_(layers, lights_, std::max(wanted.largest_color, 1.0), false),
      parts_(merge_.sources(), lights_),
      at_mark_(layers.size()) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    largest_extinction_ += layers[i].setup->largest_extinction();
    at_mark_[i].resize(merge_.sources()[i]->look().isosurfaces().size(), 1.0);
  }
  // A surface is opaque whatever its length.
  if (merge_.has_surfaces()) largest_extinction_ = 1e300;
}

RayResult GeneralPath::integrate(const RayPart& part, double tolerance) {
  return follow(part, tolerance, std::numeric_limits<double>::infinity(), nullptr);
}

double GeneralPath::find_depth(const RayPart& part, double depth) {
  double position = part.range.end;
  follow(part, wanted_.tolerance, depth, &position);
  return position;
}

/// Integrates up to this optical depth; the position at which it is reached goes to `position`.
RayResult GeneralPath::follow(const RayPart& part, double tolerance, double target,
                              double* position) {
  const Interval<double> inside = merge_.start(part);
  if (inside.empty()) return missed_ray_result();
  RayTolerance wanted = wanted_;
  wanted.tolerance = tolerance;
  // A little longer where there are surfaces: one may be at the very end, and lengths of parts add
  // up to all but their roundings.
  const bool surfaces = merge_.has_surfaces();
  const double length = (inside.end - inside.begin) * (surfaces ? 1 + 1e-9 : 1);
  MultivariateRayIntegrator integrator(nothing_, largest_extinction_, wanted, length);
  if (target < std::numeric_limits<double>::infinity()) integrator.set_target_depth(target);
  long parts = 0;
  for (MergedPart next; !integrator.done();) {
    if (!merge_.next(next)) {
      // Nothing is left, however the lengths of the parts were rounded.
      if (surfaces) integrator.set_remaining_length(0);
      break;
    }
    if (next.kind == MergedPart::Kind::medium) ++parts;
    if (!add(next, part.ray, integrator)) break;
  }
  RayResult result = integrator.result();
  result.cells = parts;
  if (position != nullptr) *position = std::min(integrator.target_position(), inside.end);
  return result;
}

/// Returns false if nobody knows what comes behind.
bool GeneralPath::add(const MergedPart& part, const Ray<double>& ray,
                      MultivariateRayIntegrator& integrator) {
  switch (part.kind) {
    case MergedPart::Kind::unknown:
      integrator.charge_opacity(part.opacity);
      break;
    case MergedPart::Kind::absent:
      integrator.skip(part.range.end - part.range.begin, part.left_out);
      break;
    case MergedPart::Kind::medium:
      return parts_.add(part, merge_.key(), merge_.stretches(), ray, integrator);
    case MergedPart::Kind::surface:
      integrator.add_surface(part.opacity, part.color, part.error, part.range.begin);
      break;
    case MergedPart::Kind::mark:
      at_mark_[part.layer][part.isosurface] = integrator.transparency();
      break;
    case MergedPart::Kind::doubt:
      integrator.charge_opacity_behind(at_mark_[part.layer][part.isosurface], part.opacity);
      break;
  }
  return true;
}

std::unique_ptr<const LayerSource> make_layer_source(const LayerTask& task) {
  if (std::holds_alternative<VolumeContent>(task.layer.content)) return make_volume_source(task);
  if (std::holds_alternative<ChannelsContent>(task.layer.content)) {
    return make_channels_source(task);
  }
  if (std::holds_alternative<MeshContent>(task.layer.content)) return make_mesh_source(task);
  if (std::holds_alternative<SourceContent>(task.layer.content)) return make_own_source(task);
  return make_label_source(task);
}

}  // namespace pellucid
