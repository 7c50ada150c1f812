// SPDX-License-Identifier: Apache-2.0
#include "general_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bundle.h"
#include "pellucid/render/multivariate_integrator.h"
#include "surface_events.h"

namespace pellucid {

namespace {

/// The part [begin, end] of a stretch.
void take(const LayerStretch& stretch, const MultivariateTransfer<double>& transfer, double begin,
          double end, CubicBernstein<double>* to) {
  if (begin <= stretch.begin && stretch.end <= end) {
    std::copy_n(stretch.data, transfer.channels, to);
    return;
  }
  const double length = stretch.end - stretch.begin;
  const double first = (begin - stretch.begin) / length, last = (end - stretch.begin) / length;
  for (int c = 0; c < transfer.channels; ++c) {
    to[c] = restrict_to(stretch.data[c], first, last);
  }
}

/// Surfaces at one place.
class SurfaceMixture {
 public:
  void add(const SurfaceEvent& event) {
    transparency_ *= 1 - event.opacity;
    error_ += event.error;
    if (event.opacity >= 1) {
      ++opaque_;
      opaque_color_ += event.color;
      return;
    }
    const double depth = -std::log1p(-event.opacity);
    depth_ += depth;
    color_ += depth * event.color;
  }
  double opacity() const { return 1 - transparency_; }
  double error() const { return error_; }
  Rgb<double> color() const {
    if (opaque_ > 0) return opaque_color_ * (1.0 / opaque_);
    return depth_ > 0 ? color_ * (1 / depth_) : color_;
  }

 private:
  double transparency_ = 1, depth_ = 0, error_ = 0;
  Rgb<double> color_{}, opaque_color_{};
  int opaque_ = 0;
};

}  // namespace

/// One layer along a ray, cut by its clips.
class GeneralPath::ClippedStream {
 public:
  ClippedStream(const LayerSource& source, const ClippedLayer& layer,
                const std::vector<LightSource<double>>& lights, double largest_color)
      : stream_(source.stream()), layer_(layer) {
    if (source.look().has_surfaces()) surfaces_.emplace(source, lights, largest_color);
  }

  /// Returns the interval of the part in which the layer may be present.
  Interval<double> start(const RayPart& part) {
    stretch_ = absent();
    if (surfaces_) surfaces_->start(part.ray);
    Interval<double> inside = stream_->start(part.ray);
    inside.begin = std::max(inside.begin, part.range.begin);
    inside.end = std::min(inside.end, part.range.end);
    ranges_ = ClipIntervals(inside, layer_.clips, part.ray).kept;
    range_ = 0;
    if (ranges_.empty()) return {1, 0};
    const Interval<double> all{ranges_.front().begin, ranges_.back().end};
    stream_->restrict_to_range(ranges_[range_++]);
    advance();
    return all;
  }
  /// Goes on to the stretch that ends behind t; returns an opacity met on the way that is not
  /// known.
  double advance_to(double t) {
    double unknown = 0;
    while (stretch_.end <= t) {
      unknown += stretch_.unknown;
      advance();
    }
    return unknown;
  }
  /// The current stretch, or the next one; at infinity behind the last.
  const LayerStretch& stretch() const { return stretch_; }
  /// Returns the surfaces on it; null if the layer has none.
  SurfaceEvents* surfaces() { return surfaces_ ? &*surfaces_ : nullptr; }
  /// Returns its unknown opacity, once.
  double take_unknown() { return std::exchange(stretch_.unknown, 0); }

 private:
  static LayerStretch absent() {
    LayerStretch nothing;
    nothing.begin = nothing.end = std::numeric_limits<double>::infinity();
    return nothing;
  }
  void advance() {
    for (;;) {
      stretch_.function = -1;
      stretch_.primitives = {};
      stretch_.left_out = stretch_.position_error = stretch_.unknown = 0;
      stretch_.gradient_doubt = 0;
      if (stream_->next(stretch_)) {
        if (surfaces_) surfaces_->take(stretch_);
        return;
      }
      if (range_ == ranges_.size()) {
        stretch_ = absent();
        if (surfaces_) surfaces_->take(stretch_);
        return;
      }
      stream_->restrict_to_range(ranges_[range_++]);
    }
  }

  std::unique_ptr<LayerStream> stream_;
  const ClippedLayer& layer_;
  std::vector<Interval<double>> ranges_;
  std::size_t range_ = 0;
  LayerStretch stretch_;
  std::optional<SurfaceEvents> surfaces_;
};

GeneralPath::GeneralPath(const std::vector<ClippedLayer>& layers,
                         const std::vector<LightSource<double>>& lights, const RayTolerance& wanted)
    : wanted_(wanted), lights_(lights), parts_(lights), bundles_(sources_) {
  for (const ClippedLayer& layer : layers) {
    sources_.push_back(&layer.setup->source());
    streams_.emplace_back(*sources_.back(), layer, lights_, std::max(wanted.largest_color, 1.0));
    largest_extinction_ += layer.setup->largest_extinction();
    surfaces_ = surfaces_ || sources_.back()->look().has_surfaces();
  }
  // A surface is opaque whatever its length.
  if (surfaces_) largest_extinction_ = 1e300;
  key_.resize(layers.size());
}

GeneralPath::~GeneralPath() = default;

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
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Interval<double> inside{infinity, -infinity};
  for (ClippedStream& stream : streams_) {
    const Interval<double> own = stream.start(part);
    if (own.empty()) continue;
    inside.begin = std::min(inside.begin, own.begin);
    inside.end = std::max(inside.end, own.end);
  }
  if (inside.empty()) return missed_ray_result();
  RayTolerance wanted = wanted_;
  wanted.tolerance = tolerance;
  // A little longer where there are surfaces: one may be at the very end, and lengths of parts add
  // up to all but their roundings.
  const double length = (inside.end - inside.begin) * (surfaces_ ? 1 + 1e-9 : 1);
  MultivariateRayIntegrator integrator(nothing_, largest_extinction_, wanted, length);
  if (target < infinity) integrator.set_target_depth(target);
  const long cells = merge(part.ray, inside, integrator);
  RayResult result = integrator.result();
  result.cells = cells;
  if (position != nullptr) *position = std::min(integrator.target_position(), inside.end);
  return result;
}

/// Integrates from end to end of the streams' stretches, and between surfaces. Returns the number
/// of parts.
long GeneralPath::merge(const Ray<double>& ray, Interval<double> inside,
                        MultivariateRayIntegrator& integrator) {
  std::fill(key_.begin(), key_.end(), -1);
  const Bundle* bundle = nullptr;
  Bundle::Span span;
  long parts = 0;
  for (double t = inside.begin; t < inside.end && !integrator.done();) {
    double next = inside.end, unknown = 0, left_out = 0, position_error = 0;
    bool present = false, lit = false;
    if (surfaces_) meet_surfaces(t, integrator);
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      unknown += streams_[i].advance_to(t);
      const LayerStretch& stretch = streams_[i].stretch();
      const LayerLook& look = sources_[i]->look();
      const bool here = stretch.begin <= t;
      next = std::min(next, here ? stretch.end : stretch.begin);
      const int function = here && look.has_medium() ? stretch.function : -1;
      key_[i] = function;
      present = present || function >= 0;
      lit = lit || (function >= 0 && look.is_lit());
      if (!here) continue;
      unknown += streams_[i].take_unknown();
      left_out += stretch.left_out;
      if (function >= 0) position_error += stretch.position_error;
    }
    if (unknown > 0) integrator.charge_opacity(unknown);
    if (surfaces_) {
      next = std::min(next, meet_surfaces(t, integrator));
      if (integrator.done()) return parts;
    }
    if (!present) {
      integrator.skip(next - t, left_out);
      t = next;
      continue;
    }
    ++parts;
    position_error += 8 * rounding_unit<double> * next;
    if (lit) {
      add_lit(ray, {t, next}, left_out, position_error, integrator);
      t = next;
      continue;
    }
    if (bundle == nullptr || bundle->key() != key_) bundle = &bundles_.find(key_);
    if (!bundle->fits()) {
      integrator.charge_opacity(1);
      return parts;
    }
    PrimitiveSet primitives{0};
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      if (key_[i] < 0) continue;
      take(streams_[i].stretch(), sources_[i]->functions()[static_cast<std::size_t>(key_[i])], t,
           next, span.data + bundle->first_channel(i));
      primitives.bits |= bundle->primitives(i, streams_[i].stretch().primitives).bits;
    }
    span.length = next - t;
    integrator.set_transfer(bundle->transfer());
    integrator.add_stretch(span, {t, next}, primitives, left_out, position_error);
    t = next;
  }
  if (surfaces_ && !integrator.done()) {
    meet_surfaces(inside.end, integrator);
    // Nothing is left, however the lengths of the parts were rounded.
    integrator.set_remaining_length(0);
  }
  return parts;
}

/// Integrates a stretch of layers that have light or gradient opacity, or of some that have.
void GeneralPath::add_lit(const Ray<double>& ray, Interval<double> range, double left_out,
                          double position_error, MultivariateRayIntegrator& integrator) {
  parts_.start(ray, range);
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    if (key_[i] < 0) continue;
    parts_.add(streams_[i].stretch(), sources_[i]->functions()[static_cast<std::size_t>(key_[i])],
               sources_[i]->look());
  }
  parts_.finish();
  parts_.integrate(left_out, position_error, integrator);
}

/// Meets all surfaces at positions up to t. Returns the position of the next one that is known, or
/// infinity. Surfaces at the same place are a mixture: with depths d_i = -ln(1 - opacity_i), their
/// color is the mean of theirs, weighted by d_i.
double GeneralPath::meet_surfaces(double t, MultivariateRayIntegrator& integrator) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (;;) {
    // The nearest of all layers.
    SurfaceEvents* nearest = nullptr;
    for (ClippedStream& stream : streams_) {
      SurfaceEvents* const surfaces = stream.surfaces();
      if (surfaces == nullptr || surfaces->next() == nullptr) continue;
      if (nearest == nullptr || surfaces->next()->t < nearest->next()->t) nearest = surfaces;
    }
    if (nearest == nullptr) return infinity;
    const SurfaceEvent event = *nearest->next();
    if (event.t > t) return event.t;
    nearest->pop();
    if (event.kind == SurfaceEvent::Kind::mark) {
      nearest->mark(event, integrator.transparency());
      continue;
    }
    if (event.kind == SurfaceEvent::Kind::charge) {
      integrator.charge_opacity_behind(nearest->transparency_at_mark(event), event.opacity);
      continue;
    }
    SurfaceMixture mixture;
    mixture.add(event);
    for (ClippedStream& stream : streams_) {
      SurfaceEvents* const surfaces = stream.surfaces();
      while (surfaces != nullptr && surfaces->next() != nullptr &&
             surfaces->next()->kind == SurfaceEvent::Kind::surface &&
             surfaces->next()->t == event.t) {
        mixture.add(*surfaces->next());
        surfaces->pop();
      }
    }
    integrator.add_surface(mixture.opacity(), mixture.color(), mixture.error(), event.t);
    if (integrator.done()) return infinity;
  }
}

std::unique_ptr<const LayerSource> make_layer_source(const LayerTask& task) {
  if (std::holds_alternative<VolumeContent>(task.layer.content)) return make_volume_source(task);
  if (std::holds_alternative<ChannelsContent>(task.layer.content)) {
    return make_channels_source(task);
  }
  if (std::holds_alternative<MeshContent>(task.layer.content)) return make_mesh_source(task);
  return make_label_source(task);
}

}  // namespace pellucid
