// SPDX-License-Identifier: Apache-2.0
#include "layer_points.h"

#include <algorithm>

namespace pellucid {

LayerPoint point_of(const LayerStretch& stretch, const LayerSource& source, double t) {
  LayerPoint point;
  point.function = stretch.function;
  if (point.function < 0) return point;
  const double u = std::clamp((t - stretch.begin) / (stretch.end - stretch.begin), 0.0, 1.0);
  const int channels = source.functions()[static_cast<std::size_t>(point.function)].channels;
  for (int c = 0; c < channels; ++c) point.value[c] = evaluate(stretch.data[c], u);
  const LayerAppearance& look = source.look();
  if (look.reflection() != nullptr) {
    for (int a = 0; a < 3; ++a) point.gradient[a] = evaluate(stretch.gradient[a], u);
  }
  if (look.extinction_factor() != nullptr) point.factor_argument = evaluate(stretch.magnitude, u);
  return point;
}

void StreamPoints::restrict_to_range(Interval<double> range) {
  stream_->restrict_to_range(range);
  stretch_ = {};
  stretch_.begin = stretch_.end = range.begin;
  ended_ = false;
}

/// Goes on to the stretch that ends behind t, or stays on the last one.
void StreamPoints::come_to(double t) {
  while (!ended_ && !(t < stretch_.end)) {
    LayerStretch next;
    ended_ = !stream_->next(next);
    if (!ended_) stretch_ = next;
  }
}

double StreamPoints::next_from(double t) {
  come_to(t);
  if (ended_ && !(t < stretch_.end)) return std::numeric_limits<double>::infinity();
  return std::max(t, stretch_.begin);
}

void StreamPoints::find(double t, LayerPoint& point) {
  come_to(t);
  if (t < stretch_.begin || t > stretch_.end) {
    point.function = -1;
    return;
  }
  point = point_of(stretch_, source_, t);
}

std::unique_ptr<LayerPoints> LayerSource::sampled_points() const {
  return std::make_unique<StreamPoints>(stream(false), *this);
}

}  // namespace pellucid
