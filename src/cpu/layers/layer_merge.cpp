// SPDX-License-Identifier: Apache-2.0
#include "layer_merge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "clip_intervals.h"

namespace pellucid {
namespace {

constexpr double infinitely_far = std::numeric_limits<double>::infinity();

/// Surfaces at one place are a mixture: with depths d_i = -ln(1 - opacity_i), their color is the
/// mean of theirs, weighted by d_i.
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

CubicBernstein<double> channel_on(const LayerStretch& stretch, int channel,
                                  Interval<double> range) noexcept {
  if (range.begin <= stretch.begin && stretch.end <= range.end) return stretch.data[channel];
  const double length = stretch.end - stretch.begin;
  return restrict_to(stretch.data[channel], (range.begin - stretch.begin) / length,
                     (range.end - stretch.begin) / length);
}

/// One layer along a ray, cut by its clips.
class LayerMerge::ClippedStream {
 public:
  ClippedStream(const LayerSource& source, const ClippedLayer& layer,
                const std::vector<LightSource<double>>& lights, double largest_color, bool by_cells)
      : stream_(source.stream(by_cells)), layer_(&layer) {
    if (source.look().has_surfaces()) surfaces_.emplace(source, lights, largest_color);
  }

  /// Returns the interval of the part in which the layer may be present.
  Interval<double> start(const RayPart& part) {
    stretch_ = absent();
    if (surfaces_) surfaces_->start(part.ray);
    Interval<double> inside = stream_->start(part.ray);
    inside.begin = std::max(inside.begin, part.range.begin);
    inside.end = std::min(inside.end, part.range.end);
    ranges_ = ClipIntervals(inside, layer_->clips, part.ray).kept;
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
    nothing.begin = nothing.end = infinitely_far;
    return nothing;
  }
  void advance() {
    for (;;) {
      stretch_.function = -1;
      stretch_.primitives = {};
      stretch_.left_out = stretch_.position_error = stretch_.unknown = 0;
      stretch_.gradient_error = 0;
      stretch_.kind = LayerStretch::Kind::curves;
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
  const ClippedLayer* layer_;
  std::vector<Interval<double>> ranges_;
  std::size_t range_ = 0;
  LayerStretch stretch_;
  std::optional<SurfaceEvents> surfaces_;
};

LayerMerge::LayerMerge(const std::vector<ClippedLayer>& layers,
                       const std::vector<LightSource<double>>& lights, double largest_color,
                       bool by_cells)
    : lights_(lights), key_(layers.size(), -1) {
  streams_.reserve(layers.size());
  for (const ClippedLayer& layer : layers) {
    sources_.push_back(&layer.setup->source());
    streams_.emplace_back(*sources_.back(), layer, lights_, largest_color, by_cells);
    stretches_.push_back(&streams_.back().stretch());
    has_medium_.push_back(sources_.back()->look().has_medium());
    is_lit_.push_back(sources_.back()->look().is_lit());
    surfaces_ = surfaces_ || sources_.back()->look().has_surfaces();
  }
}

LayerMerge::~LayerMerge() = default;
LayerMerge::LayerMerge(LayerMerge&&) noexcept = default;

Interval<double> LayerMerge::start(const RayPart& part) {
  inside_ = {infinitely_far, -infinitely_far};
  for (ClippedStream& stream : streams_) {
    const Interval<double> own = stream.start(part);
    if (own.empty()) continue;
    inside_.begin = std::min(inside_.begin, own.begin);
    inside_.end = std::max(inside_.end, own.end);
  }
  at_ = inside_.begin;
  state_ = inside_.empty() ? State::done : surfaces_ ? State::surfaces_before : State::streams;
  return inside_;
}

bool LayerMerge::next(MergedPart& part) {
  for (;;) {
    double nearest = infinitely_far;
    switch (state_) {
      case State::surfaces_before:
        if (next_surface(at_, part, nearest)) return true;
        state_ = State::streams;
        break;
      case State::streams: {
        if (!(at_ < inside_.end)) {
          state_ = surfaces_ ? State::surfaces_at_end : State::done;
          break;
        }
        double unknown = 0;
        if (!surfaces_) {
          find_part(part, unknown);
          if (!(unknown > 0)) {
            pass(part);
            return true;
          }
          ahead_ = part;
        } else {
          find_part(ahead_, unknown);
        }
        state_ = State::surfaces_here;
        if (unknown > 0) {
          part = {};
          part.kind = MergedPart::Kind::unknown;
          part.range = {at_, at_};
          part.opacity = unknown;
          return true;
        }
        break;
      }
      case State::surfaces_here:
        if (surfaces_ && next_surface(at_, part, nearest)) return true;
        part = ahead_;
        part.range.end = std::min(part.range.end, nearest);
        pass(part);
        return true;
      case State::surfaces_at_end:
        if (next_surface(inside_.end, part, nearest)) return true;
        state_ = State::done;
        break;
      case State::done:
        return false;
    }
  }
}

/// Goes on behind a part.
void LayerMerge::pass(MergedPart& part) noexcept {
  if (part.kind == MergedPart::Kind::medium) {
    part.position_error += 8 * rounding_unit<double> * part.range.end;
  }
  at_ = part.range.end;
  state_ = surfaces_ ? State::surfaces_before : State::streams;
}

/// Finds which layers are present from here on, and how far.
void LayerMerge::find_part(MergedPart& part, double& unknown) {
  part.left_out = part.position_error = 0;
  part.lit = false;
  double next = inside_.end;
  bool present = false;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    unknown += streams_[i].advance_to(at_);
    const LayerStretch& stretch = streams_[i].stretch();
    const bool here = stretch.begin <= at_;
    next = std::min(next, here ? stretch.end : stretch.begin);
    const int function = here && has_medium_[i] ? stretch.function : -1;
    key_[i] = function;
    present = present || function >= 0;
    part.lit = part.lit || (function >= 0 && is_lit_[i]);
    if (!here) continue;
    unknown += streams_[i].take_unknown();
    part.left_out += stretch.left_out;
    if (function >= 0) part.position_error += stretch.position_error;
  }
  part.kind = present ? MergedPart::Kind::medium : MergedPart::Kind::absent;
  part.range = {at_, next};
}

/// Finds the next surface of all layers at positions up to t. If there is none, `nearest` becomes
/// the position of the next one that is known, or infinite.
bool LayerMerge::next_surface(double t, MergedPart& part, double& nearest) {
  std::size_t of = streams_.size();
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    SurfaceEvents* const surfaces = streams_[i].surfaces();
    if (surfaces == nullptr || surfaces->next() == nullptr) continue;
    if (surfaces->next()->t < nearest) {
      nearest = surfaces->next()->t;
      of = i;
    }
  }
  if (of == streams_.size() || nearest > t) return false;
  SurfaceEvents& first = *streams_[of].surfaces();
  const SurfaceEvent event = *first.next();
  first.pop();
  part = {};
  part.range = {event.t, event.t};
  part.layer = of;
  part.isosurface = event.isosurface;
  if (event.kind != SurfaceEvent::Kind::surface) {
    part.kind =
        event.kind == SurfaceEvent::Kind::mark ? MergedPart::Kind::mark : MergedPart::Kind::doubt;
    part.opacity = event.opacity;
    return true;
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
  part.kind = MergedPart::Kind::surface;
  part.opacity = mixture.opacity();
  part.color = mixture.color();
  part.error = mixture.error();
  return true;
}

}  // namespace pellucid
