// SPDX-License-Identifier: Apache-2.0
#include "grid_light.h"

#include <algorithm>
#include <cmath>

#include "layers/lit_parts.h"
#include "packet_setup.h"
#include "packet_surfaces.h"
#include "pellucid/field/trilinear.h"
#include "pellucid/render/multivariate_integrator.h"

namespace pellucid {

bool has_moderate_square(double x) {
  return x == 0 || (x > 1e-12 && x < 1e12);
}

LightSource<float> in_single(const LightSource<double>& light, const Vec3<double>& origin) {
  const auto single = [](double x) { return static_cast<float>(x); };
  LightSource<float> result;
  result.kind = static_cast<LightSource<float>::Kind>(light.kind);
  const bool is_point = light.kind == LightSource<double>::Kind::point;
  const Vec3<double> place = is_point ? light.place - origin : light.place;
  result.place = {single(place.x), single(place.y), single(place.z)};
  result.color = {single(light.color.r), single(light.color.g), single(light.color.b)};
  return result;
}

Vec3<double> place_lights(std::span<const Vec3<double>> corners,
                          const std::vector<LightSource<double>>& lights, PacketLight& result) {
  Vec3<double> sum;
  for (const Vec3<double>& corner : corners) sum = sum + corner;
  const Vec3<double> middle = sum * (1 / static_cast<double>(corners.size()));
  double farthest = 0;
  for (const Vec3<double>& corner : corners) {
    farthest = std::max(farthest, length(corner - middle));
  }
  for (const LightSource<double>& light : lights) {
    result.light[result.lights++] = in_single(light, middle);
    if (light.kind != LightSource<double>::Kind::point) continue;
    ++result.points;
    farthest = std::max(farthest, length(light.place - middle));
  }
  result.farthest = static_cast<float>(farthest);
  return middle;
}

Reflection<float> in_single(const Reflection<double>& r) {
  const auto single = [](double x) { return static_cast<float>(x); };
  return {single(r.ambient), single(r.diffuse), single(r.specular), single(r.power),
          single(r.flat_square)};
}

std::optional<PacketLight> packet_light(const LayerAppearance& look, const Reflection<double>* r,
                                        const Volume& volume,
                                        const std::vector<LightSource<double>>& lights) {
  PacketLight result = no_light();
  if (r != nullptr) {
    const double steepest = steepest_gradient(look, volume);
    if (!has_moderate_square(steepest) || !has_moderate_square(std::sqrt(r->flat_square)) ||
        lights.size() > std::size_t{PacketLight::max_lights}) {
      return std::nullopt;
    }
    result.reflection = in_single(*r);
    const Vec3<double> middle = place_lights(volume.world_corners(), lights, result);
    const Vec3<double> origin = volume.world_from_grid().point({0, 0, 0}) - middle;
    for (int i = 0; i < 3; ++i) result.world_origin[i] = origin[i];
    if (!has_moderate_square(static_cast<double>(result.farthest))) return std::nullopt;
    result.of_field = look.layer().shading->gradient == GradientKind::field ? 1 : 0;
  }
  set_world_gradient(volume, result);
  for (int c = 0; c < 3; ++c) {
    for (int a = 0; a < 3; ++a) {
      result.world_direction[c][a] = volume.world_from_grid().matrix.column[a][c];
    }
  }
  return result;
}

PacketLight no_light() {
  PacketLight result;
  result.reflection.ambient = 1;
  result.reflection.flat_square = 1e30f;
  return result;
}

void set_world_gradient(const Volume& volume, PacketLight& result) {
  for (int c = 0; c < 3; ++c) {
    for (int a = 0; a < 3; ++a) {
      result.world_gradient[c][a] =
          static_cast<float>(volume.grid_from_world().matrix.column[c][a]);
    }
  }
}

double steepest_gradient(const LayerAppearance& look, const Volume& volume) {
  const VolumeStatistics& data = volume.statistics();
  return (data.maximum - data.minimum) / voxel_of(look.layer());
}

bool suits_single(const PiecewiseLinear<double>& factor, double largest, double steepest) {
  for (int i = 0; i + 1 < factor.count; ++i) {
    if (!(factor.value[i + 1] - factor.value[i] > 1e-5 * steepest)) return false;
  }
  return has_moderate_square(steepest) && largest < 1e6;
}

std::unique_ptr<const GridLight> GridLight::make(const Layer& layer,
                                                 const std::vector<Light>& lights,
                                                 const RayTolerance& wanted) {
  const auto* const content = std::get_if<VolumeContent>(&layer.content);
  if (content == nullptr || content->mask ||
      (has_surfaces(layer) && !has_plain_isosurfaces(layer)) || wanted.grade == Grade::proved ||
      (layer.shading && lights.empty()) || !fits_single(*content->volume)) {
    return nullptr;
  }
  auto result = std::unique_ptr<GridLight>(new GridLight(layer, lights, wanted));
  const auto light =
      packet_light(result->look_, result->look_.reflection(), result->volume_, result->lights_);
  // Where it turns its edge to the direction half-way to a point light is no place packets know.
  if (!light || (light->points > 0 && has_kink_in_highlight(light->reflection))) return nullptr;
  result->light_ = *light;
  if (layer.gradient_opacity) {
    const LayerAppearance& look = result->look_;
    const PiecewiseLinear<double>& factor = *look.extinction_factor();
    const double largest = layer.gradient_opacity->largest_factor(),
                 steepest = steepest_gradient(look, result->volume_);
    if (!suits_single(factor, largest, steepest)) return nullptr;
    set_factor(factor, largest, steepest, result->factor_, result->light_);
  }
  if (has_surfaces(layer)) {
    result->surfaces_ =
        packet_surfaces(result->look_, result->lights_, std::max(wanted.largest_color, 1.0));
  }
  return result;
}

GridLight::GridLight(const Layer& layer, const std::vector<Light>& lights,
                     const RayTolerance& wanted)
    : volume_(*std::get<VolumeContent>(layer.content).volume),
      wanted_(wanted),
      look_(layer),
      lights_(light_sources(lights)) {
  if (layer.shading) gradient_.emplace(volume_, layer.shading->gradient);
  if (layer.gradient_opacity) magnitude_.emplace(volume_, GradientKind::smooth);
}

void set_factor(const PiecewiseLinear<double>& factor, double largest, double steepest,
                std::optional<BinnedTransferStorage>& storage, PacketLight& result) {
  storage.emplace(factor, steepest);
  result.factor = &storage->view();
  result.largest_factor = std::max(static_cast<float>(largest) * 1.0001f, 1.0f);
}

double most_extinction_on(const PiecewiseLinear<double>& function,
                          const CubicBernstein<double>& data, double off) {
  off += data_rounding(data);
  return sensitivity(function, function.interval(data.hull_min() - off),
                     function.interval(data.hull_max() + off), off)
      .largest_extinction;
}

PellucidCellResult scalar_fallback(const RayResult& found, double opacity) {
  return {found.optical_depth,
          found.opacity,
          std::exp(-found.optical_depth),
          {found.radiance.r, found.radiance.g, found.radiance.b},
          found.error,
          opacity,
          static_cast<std::uint8_t>(found.proved),
          1,
          pellucid_followed};
}

void GridLight::integrate(const StructuredWalk<double>::Step& step, const Ray<double>& world,
                          const PellucidCell& cell, const TransferTables& transfer,
                          double least_allowance, PellucidCellResult& result) const {
  const Interval<double> whole{step.t_begin, step.t_end};
  const double length = whole.end - whole.begin;
  const Interval<double> range{whole.begin + cell.from * length, whole.end};
  LayerStretch stretch;
  stretch.begin = whole.begin;
  stretch.end = whole.end;
  stretch.function = 0;
  stretch.data[0] = volume_.visit([&](const auto& grid) {
    return trilinear_cubic(grid.template corners<double>(step.cell[0], step.cell[1], step.cell[2]),
                           step.entry, step.exit);
  });
  if (gradient_) gradient_->along(step, stretch.gradient);
  if (magnitude_) stretch.magnitude = magnitude_->magnitude_along(step);
  const ChannelTable<double> table{0, transfer.wide};
  const MultivariateTransfer<double> function = transfer_of(table);
  LitParts parts(lights_);
  parts.start(world, range);
  parts.add(stretch, function, look_);
  parts.finish();
  // A bound on the opacity, for which there is an allowance.
  const double most = static_cast<double>(light_.largest_factor) *
                      most_extinction_on(transfer.wide, stretch.data[0], 0);
  const double opacity = std::min(most * (range.end - range.begin), 1.0);
  const double allowed = cell.allowance_per_opacity * opacity + cell.allowance_flat;
  if (opacity > 0 && !(allowed >= least_allowance)) {
    result.status = pellucid_left;
    return;
  }
  RayTolerance wanted = wanted_;
  wanted.tolerance = std::max(allowed, least_allowance);
  MultivariateRayIntegrator integrator(function, most, wanted, range.end - range.begin);
  parts.integrate(0, cell.position_error, integrator);
  result = scalar_fallback(integrator.result(), opacity);
}

}  // namespace pellucid
