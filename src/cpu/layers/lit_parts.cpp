// SPDX-License-Identifier: Apache-2.0
#include "lit_parts.h"

#include <algorithm>

#include "pellucid/render/multivariate_integrator.h"

namespace pellucid {

void LitParts::start(const Ray<double>& ray, Interval<double> range) {
  ray_ = ray;
  range_ = range;
  layers_.clear();
  cuts_.clear();
}

void LitParts::add(const LayerStretch& stretch, const MultivariateTransfer<double>& function,
                   const LayerAppearance& look) {
  layers_.emplace_back();
  LitLayer<double>& layer = layers_.back();
  layer.transfer = &function;
  layer.gradient_opacity = look.extinction_factor();
  layer.reflection = look.reflection();
  layer.primitives = stretch.primitives;
  std::copy_n(stretch.data, layer.transfer->channels, layer.span.data);
  std::copy_n(stretch.gradient, 3, layer.gradient);
  layer.gradient_doubt = stretch.gradient_error;
  layer.magnitude = stretch.magnitude;
  layer.span.length = stretch.end - stretch.begin;
  if (range_.begin <= stretch.begin && stretch.end <= range_.end) return;
  const double first = (range_.begin - stretch.begin) / layer.span.length;
  const double last = (range_.end - stretch.begin) / layer.span.length;
  layer = layer.part(std::max(first, 0.0), std::min(last, 1.0));
}

void LitParts::finish() {
  const Vec3<double> begin = ray_.origin + ray_.direction * range_.begin;
  const Vec3<double> end = ray_.origin + ray_.direction * range_.end;
  for (const LitLayer<double>& layer : layers_) {
    for_each_lit_cut(layer, lights_.data(), static_cast<int>(lights_.size()), begin, end,
                     ray_.direction, [&](double cut) { cuts_.push_back(cut); });
  }
  cuts_.push_back(0);
  cuts_.push_back(1);
  std::ranges::sort(cuts_);
  // Those that are closer together than that are one.
  const auto close = [](double a, double b) { return b - a < shortest_lit_piece; };
  cuts_.erase(std::unique(cuts_.begin(), cuts_.end(), close), cuts_.end());
  cuts_.back() = 1;
  part_.resize(layers_.size());
}

void LitParts::integrate(double left_out, double position_error,
                         MultivariateRayIntegrator& integrator) const {
  const std::size_t pieces = cuts_.size() - 1;
  for (std::size_t i = 0; i < pieces && !integrator.done(); ++i) {
    const LitPiece<LitParts> piece{*this, cuts_[i], cuts_[i + 1]};
    // If the stretch's length changes, inner cuts move in proportion.
    const bool is_at_end = i == 0 || i + 1 == pieces;
    const double share = is_at_end ? 1 : piece.last - piece.first;
    integrator.add_panels(
        piece, {range_.begin + piece.first * length(), range_.begin + piece.last * length()},
        left_out, share * position_error);
  }
}

LitStretch<double> LitParts::view() const noexcept {
  LitStretch<double> stretch;
  stretch.layer = layers_.data();
  stretch.layers = static_cast<int>(layers_.size());
  stretch.light = lights_.data();
  stretch.lights = static_cast<int>(lights_.size());
  stretch.begin = ray_.origin + ray_.direction * range_.begin;
  stretch.direction = ray_.direction;
  stretch.length = length();
  stretch.gradient_error = gradient_rounding<double>;
  return stretch;
}

}  // namespace pellucid
