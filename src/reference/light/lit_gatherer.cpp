// SPDX-License-Identifier: Apache-2.0
#include "lit_gatherer.h"

#include <algorithm>
#include <cmath>

namespace pellucid::reference {
namespace {

/// Limit as in MixtureGatherer: beyond it a Gaussian could stand between the nodes, unseen.
constexpr Real localized = 6;
constexpr double deepest = 1;
constexpr double tolerance = 1e-12;
/// Number of halvings after which a function that does not settle is discontinuous, on a part of
/// 1e-12 of a piece.
constexpr int max_halvings = 40;

MixtureSamples samples_of(const std::vector<LitPart>& layers) {
  MixtureSamples result;
  for (const LitPart& layer : layers) {
    const MixtureSamples samples = layer.sample();
    for (std::size_t j = 0; j < Collocation::nodes; ++j) {
      result.rate[j] += samples.rate[j];
      for (std::size_t c = 0; c < 3; ++c) result.light[c][j] += samples.light[c][j];
    }
  }
  return result;
}

}  // namespace

std::pair<LitGatherer::Panel, LitGatherer::Panel> LitGatherer::halves(const Panel& panel) {
  const Real half = panel.length / 2;
  std::pair<Panel, Panel> result{{{}, panel.t_begin, half, {}},
                                 {{}, panel.t_begin + half, half, {}}};
  for (const LitPart& layer : panel.layers) {
    auto [front, back] = layer.halves();
    result.first.layers.push_back(std::move(front));
    result.second.layers.push_back(std::move(back));
  }
  result.first.samples = samples_of(result.first.layers);
  result.second.samples = samples_of(result.second.layers);
  return result;
}

bool LitGatherer::agree(const Panel& whole, const Panel& front, const Panel& back) const {
  const double depth = front.samples.depth();
  const double sum = depth + back.samples.depth();
  if (std::abs(whole.samples.depth() - sum) > tolerance * (1e-3 + sum)) return false;
  const std::array<Real, 3> all = whole.samples.radiance(), first = front.samples.radiance(),
                            second = back.samples.radiance();
  const double transparency = std::exp(-gatherer_.optical_depth());
  for (std::size_t c = 0; c < 3; ++c) {
    const Real both = first[c] + std::exp(-depth) * second[c];
    if (std::abs(all[c] - both) * transparency > tolerance * (1 + both)) return false;
  }
  return true;
}

void LitGatherer::add(const std::vector<LitPart>& layers, Real t_begin, Real length) {
  Panel panel{{}, t_begin, length, {}};
  for (const LitPart& layer : layers) {
    if (!layer.is_clear()) panel.layers.push_back(layer);
  }
  if (panel.layers.empty()) return;
  panel.samples = samples_of(panel.layers);
  add(panel, 0);
}

void LitGatherer::add(const Panel& panel, int halvings) {
  if (done()) return;
  const auto all = [&](auto&& holds) {
    return std::all_of(panel.layers.begin(), panel.layers.end(), holds);
  };
  const bool is_seen = panel.samples.depth() <= deepest && all([](const LitPart& layer) {
                         return layer.exponent_change() <= localized && layer.is_resolved();
                       });
  if (is_seen && all([](const LitPart& layer) { return layer.is_polynomial(); })) {
    add_whole(panel);
    return;
  }
  const auto [front, back] = halves(panel);
  if (halvings >= max_halvings || (is_seen && agree(panel, front, back))) {
    add_whole(front);
    add_whole(back);
    return;
  }
  add(front, halvings + 1);
  add(back, halvings + 1);
}

void LitGatherer::add_whole(const Panel& panel) {
  const double depth = panel.samples.depth(), before = gatherer_.optical_depth();
  gatherer_.add(depth, panel.samples.radiance());
  if (!with_depth_) return;
  marks_.push_back({panel.samples, panel.t_begin, panel.length, before, gatherer_.optical_depth()});
}

void LitGatherer::add(const SurfaceHit& surface) {
  const double before = gatherer_.optical_depth();
  const Real a = surface.opacity;
  gatherer_.add(-std::log1p(-surface.opacity),
                {a * surface.color.r, a * surface.color.g, a * surface.color.b});
  if (with_depth_) marks_.push_back({{}, surface.t, 0, before, gatherer_.optical_depth()});
}

ReferencePixel LitGatherer::result() const {
  ReferencePixel pixel = gatherer_.result();
  if (!with_depth_ || !(pixel.opacity > 0)) return pixel;
  const double target = -std::log1p(-0.5 * pixel.opacity);
  const auto mark = std::find_if(marks_.begin(), marks_.end() - 1,
                                 [&](const Mark& m) { return m.after >= target; });
  const double share = mark->length > 0 ? mark->samples.share_at_depth(mark->before, target) : 0;
  pixel.half_opacity_depth = static_cast<double>(mark->t_begin + share * mark->length);
  return pixel;
}

}  // namespace pellucid::reference
