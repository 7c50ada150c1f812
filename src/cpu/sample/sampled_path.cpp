// SPDX-License-Identifier: Apache-2.0
#include "sampled_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "layers/clip_intervals.h"

namespace pellucid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Beyond this depth, and at infinite ones, nothing is seen.
constexpr double opaque_depth = 700;

/// A segment's depth and the color of which its radiance is made.
struct DepthAndColor {
  double depth = 0;
  Rgb<double> color{};
};
DepthAndColor depth_and_color(const SegmentResult<double>& segment) {
  // Quotients of what is smaller overflow.
  if (!(segment.opacity >= smallest_normal<double>)) return {};
  return {std::min(segment.optical_depth, opaque_depth), (1 / segment.opacity) * segment.radiance};
}

}  // namespace

/// A layer's points on a ray, in the ranges that its clips keep.
class SampledPath::LayerOnRay {
 public:
  explicit LayerOnRay(const ClippedLayer& layer)
      : source(layer.setup->source()), points(source.sampled_points()), layer_(layer) {}

  /// Begins a ray; adds the places where the layer begins and ends.
  void start(const RayPart& part, std::vector<double>& ends) {
    Interval<double> inside = points->start(part.ray);
    inside.begin = std::max(inside.begin, part.range.begin);
    inside.end = std::min(inside.end, part.range.end);
    ranges_ = ClipIntervals(inside, layer_.clips, part.ray).kept;
    range_ = 0;
    side_at = -1;
    if (ranges_.empty()) return;
    for (const Interval<double>& range : ranges_) {
      ends.push_back(range.begin);
      ends.push_back(range.end);
    }
    enter();
  }
  /// Returns the first position from t on at which it may absorb; infinite: none.
  double next_from(double t) {
    for (; range_ < ranges_.size(); ++range_) {
      if (t < ranges_[range_].end) {
        if (entered_ != range_) enter();
        const double next = points->next_from(std::max(t, ranges_[range_].begin));
        if (next < ranges_[range_].end) return next;
      }
    }
    return infinity;
  }
  /// Returns whether it is there between the positions, at which its ranges are cut.
  bool holds(double begin, double end) {
    const double middle = 0.5 * (begin + end);
    while (range_ < ranges_.size() && !(middle < ranges_[range_].end)) ++range_;
    if (range_ == ranges_.size() || middle < ranges_[range_].begin) return false;
    if (entered_ != range_) enter();
    return true;
  }

  const LayerSource& source;
  const std::unique_ptr<LayerPoints> points;
  // Where isosurfaces were looked for last:
  LayerPoint side;
  double side_at = -1;

 private:
  void enter() {
    points->restrict_to_range(ranges_[range_]);
    entered_ = range_;
  }

  const ClippedLayer& layer_;
  std::vector<Interval<double>> ranges_;
  std::size_t range_ = 0, entered_ = 0;  ///< of them; of that to which points are restricted
};

SampledPath::SampledPath(const std::vector<ClippedLayer>& layers,
                         const std::vector<LightSource<double>>& lights, const SamplingPlan& plan,
                         double largest_color)
    : plan_(plan),
      lights_(lights),
      merge_(layers, lights, largest_color, false),
      on_(layers.size()) {
  for (const ClippedLayer& layer : layers) {
    layers_.push_back(std::make_unique<LayerOnRay>(layer));
    by_sides_ = by_sides_ && layers_.back()->points->goes_back() &&
                layers_.back()->source.look().slices().empty();
  }
}

SampledPath::~SampledPath() = default;

RayResult SampledPath::sample(const RayPart& part, const std::stop_token& stop) {
  ray_ = part.ray;
  stop_ = &stop;
  fold_ = FrontToBackCompositor<double>(plan_.stop());
  segments_ = 0;
  sampled_to_ = -1;
  surfaces_.clear();
  next_surface_ = 0;
  gathered_.clear();
  if (plan_.by_cells()) {
    go_through_cells(part);
  } else {
    step_through(part);
  }
  RayResult result;
  result.cells = result.evaluations = segments_;
  result.radiance = fold_.radiance();
  result.optical_depth = fold_.optical_depth();
  result.opacity = fold_.opacity();
  if (plan_.depth() && result.opacity > 0) {
    result.half_opacity_depth = half_opacity_depth(result.opacity);
  }
  return result;
}

/// Returns whether what is behind does not matter, or nobody wants to know.
bool SampledPath::is_over() const {
  return fold_.done() || stop_->stop_requested();
}

void SampledPath::find_surfaces(const RayPart& part) {
  merge_.start(part);
  for (MergedPart next; merge_.next(next);) {
    if (next.kind != MergedPart::Kind::surface) continue;
    surfaces_.push_back({next.range.begin, next.opacity, next.color});
    if (next.opacity >= 1) break;
  }
}

void SampledPath::step_through(const RayPart& part) {
  ends_.clear();
  for (const auto& layer : layers_) layer->start(part, ends_);
  std::ranges::sort(ends_);
  if (merge_.has_surfaces() && !by_sides_) find_surfaces(part);
  for (std::size_t i = 0; i + 1 < ends_.size() && !is_over(); ++i) {
    const double begin = ends_[i], end = ends_[i + 1];
    if (!(begin < end)) continue;
    double step = infinity;
    for (std::size_t k = 0; k < layers_.size(); ++k) {
      if (layers_[k]->holds(begin, end)) step = std::min(step, plan_.step(k));
    }
    // Positions do not tell shorter ones.
    if (step < infinity) step_between(begin, end, std::max(step, 1e-13 * end));
  }
  while (next_surface_ < surfaces_.size() && !fold_.done()) add_surface(surfaces_[next_surface_++]);
}

/// Steps through a part of the ray on which the same layers are present.
void SampledPath::step_between(double first, double last, double step) {
  double index = 0;
  for (double begin = first; begin < last && !is_over();) {
    double next = next_surface_ < surfaces_.size() ? surfaces_[next_surface_].t : infinity;
    for (const auto& layer : layers_) next = std::min(next, layer->next_from(begin));
    if (!(next < last)) break;
    // Positions are multiples of the step, computed from their index, so that they do not drift.
    const double skipped = std::floor((next - first) / step);
    if (skipped > index) {
      index = skipped;
      begin = std::max(begin, first + index * step);
    }
    const double end = std::min(first + (index + 1) * step, last);
    if (by_sides_ && merge_.has_surfaces()) find_crossings(begin, end);
    add_step(begin, end);
    begin = end;
    index += 1;
  }
}

/// Finds the isosurfaces whose sides the ends of a step are on, front to back.
void SampledPath::find_crossings(double begin, double end) {
  if (!(begin < end)) return;
  surfaces_.erase(surfaces_.begin(),
                  surfaces_.begin() + static_cast<std::ptrdiff_t>(next_surface_));
  next_surface_ = 0;
  for (const auto& layer : layers_) {
    const LayerAppearance& look = layer->source.look();
    if (look.isosurfaces().empty() || !layer->holds(begin, end)) continue;
    LayerPoint& front = layer->side;
    if (layer->side_at != begin) layer->points->find(begin, front);
    LayerPoint back, at;
    layer->points->find(end, back);
    const LayerPoint before_step = std::exchange(front, back);
    layer->side_at = end;
    if (before_step.function < 0 || back.function < 0) continue;
    for (const Isosurface& surface : look.isosurfaces()) {
      const auto channel = static_cast<std::size_t>(surface.channel);
      const double before = before_step.value[channel] - surface.value;
      const double behind = back.value[channel] - surface.value;
      if (!((before < 0) != (behind < 0))) continue;
      const double t = crossing(*layer->points, surface, begin, end, before, behind, at);
      if (at.function < 0) continue;
      Rgb<double> color = surface.color;
      if (surface.colors) {
        color = surface.colors->view<double>()
                    .evaluate(at.value[static_cast<std::size_t>(surface.color_channel)])
                    .color;
      }
      if (const Reflection<double>* const reflection = look.surface_reflection()) {
        layer->points->find_gradients(at);
        color = lit(*reflection, at, t, color);
      }
      surfaces_.push_back({t, surface.opacity, color});
    }
  }
  std::ranges::sort(surfaces_, {}, &Surface::t);
}

/// Finds where data cross the value of an isosurface between two places, on whose sides they are by
/// `before` and `behind`: by four steps of false position.
double SampledPath::crossing(LayerPoints& points, const Isosurface& surface, double begin,
                             double end, double before, double behind, LayerPoint& at) {
  double t = begin;
  for (int i = 0; i < 4; ++i) {
    t = begin + (end - begin) * (before / (before - behind));
    points.find(t, at);
    if (at.function < 0) return t;
    const double here = at.value[static_cast<std::size_t>(surface.channel)] - surface.value;
    if (here == 0) return t;
    if ((here < 0) == (before < 0)) {
      begin = t;
      before = here;
    } else {
      end = t;
      behind = here;
    }
  }
  return t;
}

/// Adds the surfaces in front of a step's end, and the step.
void SampledPath::add_step(double begin, double end) {
  while (next_surface_ < surfaces_.size() && surfaces_[next_surface_].t <= begin) {
    add_surface(surfaces_[next_surface_++]);
  }
  while (next_surface_ < surfaces_.size() && surfaces_[next_surface_].t < end && !fold_.done()) {
    const Surface next = surfaces_[next_surface_++];
    add_part(begin, next.t);
    add_surface(next);
    begin = next.t;
  }
  add_part(begin, end);
}

void SampledPath::add_part(double begin, double end) {
  if (!(begin < end) || fold_.done()) return;
  const double middle = 0.5 * (begin + end);
  const SamplePositions of_rule = sample_positions(plan_.rule());
  const bool has_light_in_middle = takes_data(plan_.rule());
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    OnSegment& on = on_[i];
    LayerOnRay& layer = *layers_[i];
    SamplePositions seen = of_rule;
    seen.middle = seen.middle || (has_light_in_middle && layer.source.look().is_lit());
    const bool was_present = on.present && sampled_to_ == begin && seen.back;
    on.present = layer.source.look().has_medium() && layer.holds(begin, end);
    if (!on.present) continue;
    if (seen.front) {
      if (was_present) {
        on.front = on.back;
      } else {
        layer.points->find(begin, on.front);
      }
    }
    if (seen.middle) layer.points->find(middle, on.middle);
    if (seen.back) layer.points->find(end, on.back);
  }
  sampled_to_ = end;
  add_segment(begin, end);
}

void SampledPath::go_through_cells(const RayPart& part) {
  merge_.start(part);
  for (MergedPart next; !is_over() && merge_.next(next);) {
    if (next.kind == MergedPart::Kind::surface) {
      add_surface({next.range.begin, next.opacity, next.color});
    }
    if (next.kind != MergedPart::Kind::medium) continue;
    const auto [begin, end] = next.range;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      OnSegment& on = on_[i];
      on.present = merge_.key()[i] >= 0;
      if (!on.present) continue;
      const LayerStretch& stretch = *merge_.stretches()[i];
      on.front = point_of(stretch, layers_[i]->source, begin);
      on.middle = point_of(stretch, layers_[i]->source, 0.5 * (begin + end));
      on.back = point_of(stretch, layers_[i]->source, end);
    }
    add_segment(begin, end);
  }
}

void SampledPath::add_segment(double begin, double end) {
  ++segments_;
  add(takes_data(plan_.rule()) ? of_data(begin, end) : of_materials(begin, end), begin, end);
}

void SampledPath::add_surface(const Surface& surface) {
  add({std::min(-std::log1p(-surface.opacity), opaque_depth), surface.opacity, 1 - surface.opacity,
       surface.opacity * surface.color},
      surface.t, surface.t);
}

void SampledPath::add(const SegmentResult<double>& segment, double begin, double end) {
  fold_.add(segment);
  if (plan_.depth() && segment.optical_depth > 0) {
    gathered_.push_back({begin, end, segment.optical_depth});
  }
}

SegmentResult<double> SampledPath::of_materials(double begin, double end) {
  const SamplePositions seen = sample_positions(plan_.rule());
  const double half = 0.5 * (begin + end);
  // Depths per length: the color of a mixture is the mean weighted by extinction.
  DepthWeightedColor<double> front, middle, back;
  for (std::size_t i = 0; i < on_.size(); ++i) {
    OnSegment& on = on_[i];
    if (!on.present) continue;
    if (seen.front) add_material(i, on.front, begin, front);
    if (seen.middle) add_material(i, on.middle, half, middle);
    if (seen.back) add_material(i, on.back, end, back);
  }
  const auto mean = [](const DepthWeightedColor<double>& sum) {
    return Material<double>{sum.depth, sum.color};
  };
  return material_segment(plan_.rule(), plan_.psi(), mean(front), mean(middle), mean(back),
                          end - begin);
}

/// Adds what a layer is made of at a point, in light.
void SampledPath::add_material(std::size_t layer, LayerPoint& point, double t,
                               DepthWeightedColor<double>& sum) const {
  if (point.function < 0) return;
  const LayerSource& source = layers_[layer]->source;
  Material<double> here =
      source.functions()[static_cast<std::size_t>(point.function)].evaluate(point.value);
  if (!(here.extinction > 0)) return;
  if (source.look().is_lit()) light_up_point(layer, point, t, here);
  sum.add(here.extinction, here.color);
}

/// Weakens a layer's extinction and lights its color by what is at a point.
void SampledPath::light_up_point(std::size_t layer, LayerPoint& point, double t,
                                 Material<double>& material) const {
  const LayerAppearance& look = layers_[layer]->source.look();
  layers_[layer]->points->find_gradients(point);
  if (const PiecewiseLinear<double>* const factor = look.extinction_factor()) {
    material.extinction *= factor->evaluate(point.factor_argument).extinction;
  }
  if (const Reflection<double>* const reflection = look.reflection()) {
    material.color = lit(*reflection, point, t, material.color);
  }
}

/// Returns a color in the light at a point, whose gradient is known.
Rgb<double> SampledPath::lit(const Reflection<double>& reflection, const LayerPoint& point,
                             double t, const Rgb<double>& color) const {
  return light_up(reflection, lights_.data(), static_cast<int>(lights_.size()), point.gradient,
                  ray_.at(t), -ray_.direction)
      .apply(color);
}

SegmentResult<double> SampledPath::of_data(double begin, double end) {
  DepthWeightedColor<double> sum;
  for (std::size_t i = 0; i < on_.size(); ++i) {
    OnSegment& on = on_[i];
    if (!on.present || on.front.function < 0 || on.back.function < 0) continue;
    if (on.front.function == on.back.function) {
      add_data(i, on.front.function, on.front.value, on.back.value, begin, end, sum);
      continue;
    }
    // Another function from the middle on.
    const double middle = 0.5 * (begin + end);
    double mean[max_channels];
    for (int c = 0; c < max_channels; ++c) {
      mean[c] = 0.5 * (on.front.value[c] + on.back.value[c]);
    }
    add_data(i, on.front.function, on.front.value, mean, begin, middle, sum);
    add_data(i, on.back.function, mean, on.back.value, middle, end, sum);
  }
  return segment_of_depth(sum.depth, sum.color);
}

/// Adds the segment of one layer between two data; in the light of the middle of its step.
void SampledPath::add_data(std::size_t layer, int number, const double* front, const double* back,
                           double begin, double end, DepthWeightedColor<double>& sum) {
  const LayerSource& source = layers_[layer]->source;
  const double length = end - begin;
  DepthAndColor of = depth_and_color(data_segment(
      plan_.rule(), plan_.table(layer, number), std::min(length / plan_.step(layer), 1.0),
      source.functions()[static_cast<std::size_t>(number)], front, back, length));
  if (!(of.depth > 0)) return;
  if (source.look().is_lit()) {
    // A middle in vacuum has no light of its own.
    LayerPoint& middle = on_[layer].middle.function < 0 ? on_[layer].front : on_[layer].middle;
    Material<double> material{of.depth, of.color};
    light_up_point(layer, middle, 0.5 * (begin + end), material);
    of = {material.extinction, material.color};
  }
  sum.add(of.depth, of.color);
}

/// Returns the depth of half of the opacity. Within the segment that passes the half, the rules
/// know no more than a constant extinction.
double SampledPath::half_opacity_depth(double opacity) const {
  const double target = -std::log1p(-0.5 * opacity);
  double before = 0;
  for (const Gathered& segment : gathered_) {
    if (before + segment.depth >= target) {
      return segment.begin + (target - before) / segment.depth * (segment.end - segment.begin);
    }
    before += segment.depth;
  }
  return gathered_.empty() ? infinity : gathered_.back().end;
}

}  // namespace pellucid
