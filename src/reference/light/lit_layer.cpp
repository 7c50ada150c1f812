// SPDX-License-Identifier: Apache-2.0
#include "lit_layer.h"

#include <algorithm>
#include <cmath>

#include "grid/derived_channels.h"
#include "vectors.h"

namespace pellucid::reference {
namespace {

Polynomial polynomial_of(const std::array<Real, 4>& cubic) {
  return {cubic.begin(), cubic.end()};
}

GradientCubics cubics_of(const std::vector<Chord>& chords, std::size_t first, Real u_begin,
                         Real u_end) {
  GradientCubics result;
  for (std::size_t a = 0; a < 3; ++a) {
    result[a] = polynomial_of(chords[first + a].monomial(u_begin, u_end));
  }
  return result;
}

}  // namespace

LitLayer::LitLayer(const Layer& layer, const std::vector<Clip>& of_scene)
    : layer_(layer), data_(layer, of_scene) {
  const auto channels = static_cast<std::size_t>(channels_of(layer));
  const DerivedChannels derived(layer);
  gradient_ = derived.gradient(channels);
  argument_ = derived.magnitude(channels);
  if (layer.shading) {
    flat_ = largest_extinction(layer) > 0 ? flat_gradient(layer) : 0;
    flat_of_surfaces_ = flat_gradient_of_surfaces(layer);
  }
  if (layer.gradient_opacity) {
    factor_ = layer.gradient_opacity->per_world(voxel_of(layer));
    factor_table_.emplace(factor_->points());
  }
  if (const ChannelTransferFunction* const factor = extinction_factor_of(layer)) {
    argument_ = static_cast<std::size_t>(factor->channel);
    factor_table_.emplace(factor->function.points());
  }
}

const Chord& LitLayer::argument(const LayerStretch& stretch) const {
  return stretch.chords[argument_];
}

bool LitLayer::is_clear(const LayerStretch& stretch) const {
  if (factor_table_) {
    const Chord& m = argument(stretch);
    if (factor_table_->is_clear(m.lower(), m.upper())) return true;
  }
  if (!stretch.function->primitives().empty()) return false;
  return std::ranges::all_of(stretch.function->tables(), [&](const Mixture::ChannelTable& term) {
    const Chord& chord = stretch.chords[term.channel];
    return term.table.is_clear(chord.lower(), chord.upper());
  });
}

LitStretch LitLayer::prepared(LayerStretch stretch, const RayLights& lights) const {
  LitStretch result{std::move(stretch), {}, {}};
  if (is_clear(result.data)) return result;
  result.cuts = result.data.function->cuts(result.data.chords);
  if (factor_table_) {
    const std::vector<Real> cuts = argument(result.data).cuts(factor_table_->values());
    result.cuts.insert(result.cuts.end(), cuts.begin(), cuts.end());
  }
  if (layer_.shading) add_shading_cuts(lights, result);
  std::erase_if(result.cuts, [](Real u) { return !(u > 0 && u < 1); });
  std::sort(result.cuts.begin(), result.cuts.end());
  return result;
}

/// Adds cuts where light has kinks, and bends where the gradient is least: there the normal turns.
/// Minima beyond the ends of the stretch count as well.
void LitLayer::add_shading_cuts(const RayLights& lights, LitStretch& stretch) const {
  const Real t_begin = stretch.data.t_begin, length = stretch.data.t_end - t_begin;
  const GradientCubics gradient = cubics_of(stretch.data.chords, gradient_, 0, 1);
  lights.add_kinks(*layer_.shading, gradient, t_begin, length, stretch.cuts);
  stretch.bends = lights.bends();
  Polynomial square;
  for (const Polynomial& component : gradient) square = sum(square, product(component, component));
  const Polynomial slope = derivative(square), curvature = derivative(slope);
  for (const Real u : zeros(slope, -1, 2)) {
    const Real bend = value(curvature, u);
    if (!(bend > 0)) continue;
    Real least = flat_ * flat_;
    for (const Polynomial& component : gradient) least += value(component, u) * value(component, u);
    const Real width = std::sqrt(2 * least / bend);
    if (width > 1) continue;
    stretch.cuts.push_back(u);
    stretch.bends.push_back({t_begin + u * length, width * length});
  }
}

LitPart LitLayer::part(const LitStretch& stretch, Real begin, Real end,
                       const RayLights& lights) const {
  const LayerStretch& data = stretch.data;
  const Real whole = data.t_end - data.t_begin;
  const Real u_begin = std::max((begin - data.t_begin) / whole, Real(0));
  const Real u_end = std::min((end - data.t_begin) / whole, Real(1));
  PieceLight light{begin, end - begin, std::nullopt, layer_.shading ? &*layer_.shading : nullptr};
  if (factor_table_) {
    const Chord& m = argument(data);
    const TableInterval interval = factor_table_->interval(m((u_begin + u_end) / 2));
    if (interval.left->extinction == 0 && interval.right->extinction == 0) {
      light.shading = nullptr;
      return {MixturePart(begin, end - begin), std::make_shared<const PieceLight>(light)};
    }
    light.factor.emplace(m, u_begin, u_end, interval, 0, 1);
  }
  if (light.shading != nullptr) {
    light.gradient = cubics_of(data.chords, gradient_, u_begin, u_end);
    light.flat = flat_;
    light.bends = stretch.bends;
    light.lights = &lights;
  }
  return {MixturePart(*data.function, data.chords, u_begin, u_end, begin, end - begin),
          std::make_shared<const PieceLight>(std::move(light))};
}

Rgb<double> LitLayer::shaded_surface(const Rgb<double>& color, const LayerStretch& stretch, Real u,
                                     const RayLights& lights) const {
  if (!layer_.shading) return color;
  Real3 gradient;
  for (std::size_t a = 0; a < 3; ++a) gradient[a] = stretch.chords[gradient_ + a](u);
  const Real t = stretch.t_begin + u * (stretch.t_end - stretch.t_begin);
  const Reflection reflection =
      lights.reflection(*layer_.shading, normal_of(gradient, flat_of_surfaces_), t);
  return {color.r * reflection.factor.r + reflection.added.r,
          color.g * reflection.factor.g + reflection.added.g,
          color.b * reflection.factor.b + reflection.added.b};
}

}  // namespace pellucid::reference
