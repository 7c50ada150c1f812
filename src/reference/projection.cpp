// SPDX-License-Identifier: Apache-2.0
#include "projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pellucid::reference {
namespace {

const std::vector<TransferFunction::Point>& points_of(const Layer& layer) {
  const auto* const mesh = std::get_if<MeshContent>(&layer.content);
  return mesh != nullptr ? mesh->univariate()->points()
                         : std::get<VolumeContent>(layer.content).transfer_function->points();
}

/// Returns the largest value of sign · chord on [from, to], where it has one top at most.
Real top_between(const Chord& chord, Real sign, Real from, Real to) {
  const Real golden = (std::sqrt(Real(5)) - 1) / 2;
  Real left = to - golden * (to - from), right = from + golden * (to - from);
  Real at_left = sign * chord(left), at_right = sign * chord(right);
  Real best = std::max(at_left, at_right);
  for (int i = 0; i < 90; ++i) {
    if (at_left < at_right) {
      from = left;
      left = right;
      at_left = at_right;
      right = from + golden * (to - from);
      at_right = sign * chord(right);
    } else {
      to = right;
      right = left;
      at_right = at_left;
      left = to - golden * (to - from);
      at_left = sign * chord(left);
    }
    best = std::max({best, at_left, at_right});
  }
  return best;
}

/// Returns the largest value of sign · chord on [0, last].
Real top(const Chord& chord, Real sign, Real last) {
  constexpr int count = 64;
  Real best = -std::numeric_limits<Real>::infinity();
  int at = 0;
  for (int i = 0; i <= count; ++i) {
    const Real value = sign * chord(last * i / count);
    if (value > best) {
      best = value;
      at = i;
    }
  }
  const Real from = last * std::max(at - 1, 0) / count;
  const Real to = last * std::min(at + 1, count) / count;
  return std::max(best, top_between(chord, sign, from, to));
}

/// Integrates by Simpson's rule on [from, to], halved until both halves agree with the whole.
Real integral(const Chord& chord, Real from, Real to, int levels) {
  const Real middle = (from + to) / 2;
  const auto simpson = [&](Real a, Real b) {
    return (b - a) / 6 * (chord(a) + 4 * chord((a + b) / 2) + chord(b));
  };
  const Real whole = simpson(from, to), halves = simpson(from, middle) + simpson(middle, to);
  const Real size = std::max(std::abs(chord.lower()), std::abs(chord.upper())) * (to - from);
  if (levels == 0 || std::abs(whole - halves) <= Real(1e-18) * size) return halves;
  return integral(chord, from, middle, levels - 1) + integral(chord, middle, to, levels - 1);
}

}  // namespace

Projection::Projection(const Layer& layer, const std::vector<Clip>& of_scene)
    : kind_(*layer.projection), points_(points_of(layer)), data_(layer, of_scene) {}

Real Projection::value(const RealRay& ray, Real end, bool& has_data, std::uint64_t& cells,
                       Real& overlap) const {
  const bool extreme = kind_ == LayerProjection::maximum || kind_ == LayerProjection::minimum;
  const Real sign = kind_ == LayerProjection::minimum ? -1 : 1;
  Real best = -std::numeric_limits<Real>::infinity(), sum = 0, length = 0;
  has_data = false;
  for (const LayerStretch& stretch : data_.stretches(ray, cells, overlap)) {
    const Real own = stretch.t_end - stretch.t_begin;
    if (!(own > 0) || !(stretch.t_begin < end)) continue;
    const Real last = std::min((end - stretch.t_begin) / own, Real(1));
    has_data = true;
    const Chord& chord = stretch.chords.front();
    if (extreme) {
      best = std::max(best, top(chord, sign, last));
    } else {
      sum += own * integral(chord, 0, last, 8);
      length += own * last;
    }
  }
  if (!has_data) return kind_ == LayerProjection::sum ? 0 : std::numeric_limits<Real>::quiet_NaN();
  if (extreme) return sign * best;
  return kind_ == LayerProjection::sum ? sum : sum / length;
}

void Projection::put_over(const RealRay& ray, Real end, std::uint64_t& cells,
                          ReferencePixel& pixel) const {
  bool has_data = false;
  Real overlap = 0;
  const Real v = value(ray, end, has_data, cells, overlap);
  pixel.value = static_cast<double>(v);
  pixel.overlap += static_cast<double>(overlap);
  if (!has_data) return;
  Real largest = 0;
  for (const TransferFunction::Point& point : points_) {
    largest = std::max(largest, Real(point.extinction));
  }
  if (!(largest > 0)) return;
  // At a control value the point on its right counts.
  const auto right = std::find_if(points_.begin(), points_.end(),
                                  [&](const auto& point) { return Real(point.value) > v; });
  const TransferFunction::Point& b = right == points_.end() ? points_.back() : *right;
  const TransferFunction::Point& a = right == points_.begin() ? b : *(right - 1);
  const Real width = Real(b.value) - Real(a.value);
  const Real s = width > 0 ? (v - Real(a.value)) / width : 0;
  const auto mix = [&](double from, double to) { return (1 - s) * Real(from) + s * Real(to); };
  const Real opacity = mix(a.extinction, b.extinction) / largest;
  const auto over = [&](double from, double to, double behind) {
    return static_cast<double>(opacity * mix(from, to) + (1 - opacity) * Real(behind));
  };
  pixel.radiance = {over(a.color.r, b.color.r, pixel.radiance.r),
                    over(a.color.g, b.color.g, pixel.radiance.g),
                    over(a.color.b, b.color.b, pixel.radiance.b)};
  pixel.opacity = static_cast<double>(opacity + (1 - opacity) * Real(pixel.opacity));
}

}  // namespace pellucid::reference
