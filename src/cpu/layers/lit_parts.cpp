// SPDX-License-Identifier: Apache-2.0
#include "lit_parts.h"

#include <algorithm>

#include "pellucid/math/bernstein_roots.h"
#include "pellucid/render/multivariate_integrator.h"
#include "pellucid/transfer/cubic_cuts.h"

namespace pellucid {
namespace {

/// Share of a stretch between two cuts, at least.
constexpr double shortest = 1e-12;

/// f (1 - u) a + f u b, of degree 4.
void add_product(const CubicBernstein<double>& f, double a, double b,
                 BernsteinPolynomial<double, 4>& sum) {
  for (int k = 0; k <= 4; ++k) {
    if (k < 4) sum.b[k] += f.b[k] * a * ((4 - k) / 4.0);
    if (k > 0) sum.b[k] += f.b[k - 1] * b * (k / 4.0);
  }
}

}  // namespace

void LitParts::start(const Ray<double>& ray, Interval<double> range) {
  ray_ = ray;
  range_ = range;
  layers_.clear();
  cuts_.clear();
}

void LitParts::add(const LayerStretch& stretch, const MultivariateTransfer<double>& function,
                   const LayerLook& look) {
  layers_.emplace_back();
  LitLayer<double>& layer = layers_.back();
  layer.transfer = &function;
  layer.gradient_opacity = look.gradient_opacity();
  layer.reflection = look.reflection();
  layer.primitives = stretch.primitives;
  std::copy_n(stretch.data, layer.transfer->channels, layer.span.data);
  std::copy_n(stretch.gradient, 3, layer.gradient);
  layer.magnitude = stretch.magnitude;
  layer.span.length = stretch.end - stretch.begin;
  if (range_.begin <= stretch.begin && stretch.end <= range_.end) return;
  const double first = (range_.begin - stretch.begin) / layer.span.length;
  const double last = (range_.end - stretch.begin) / layer.span.length;
  layer = layer.part(std::max(first, 0.0), std::min(last, 1.0));
}

void LitParts::finish() {
  const auto add_ends = [&](const CubicBernstein<double>& data,
                            const PiecewiseLinear<double>& table) {
    for_each_interval(data, table, [&](int, double, double end, double, double) noexcept {
      if (end < 1) cuts_.push_back(end);
    });
  };
  const Vec3<double> begin = ray_.origin + ray_.direction * range_.begin;
  const Vec3<double> end = ray_.origin + ray_.direction * range_.end;
  for (const LitLayer<double>& layer : layers_) {
    for (int i = 0; i < layer.transfer->tables; ++i) {
      const ChannelTable<double>& table = layer.transfer->table[i];
      add_ends(layer.span.data[table.channel], table.table);
    }
    if (layer.gradient_opacity != nullptr) add_ends(layer.magnitude, *layer.gradient_opacity);
    if (layer.reflection == nullptr) continue;
    for (const LightSource<double>& light : lights_) {
      // g·l, or for a point light g·(P - x).
      Vec3<double> first = light.place, last = light.place;
      if (light.kind == LightSource<double>::Kind::head) first = last = ray_.direction;
      if (light.kind == LightSource<double>::Kind::point) {
        first = light.place - begin;
        last = light.place - end;
      }
      BernsteinPolynomial<double, 4> along;
      for (int a = 0; a < 3; ++a) add_product(layer.gradient[a], first[a], last[a], along);
      double position[4];
      const int count = sign_change_positions(along, position);
      cuts_.insert(cuts_.end(), position, position + count);
    }
  }
  cuts_.push_back(0);
  cuts_.push_back(1);
  std::ranges::sort(cuts_);
  // Those that are closer together than that are one.
  const auto close = [](double a, double b) { return b - a < shortest; };
  cuts_.erase(std::unique(cuts_.begin(), cuts_.end(), close), cuts_.end());
  cuts_.back() = 1;
  part_.resize(layers_.size());
}

void LitParts::integrate(double left_out, double position_error,
                         MultivariateRayIntegrator& integrator) const {
  const std::size_t pieces = cuts_.size() - 1;
  for (std::size_t i = 0; i < pieces && !integrator.done(); ++i) {
    const Piece piece{*this, cuts_[i], cuts_[i + 1]};
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
