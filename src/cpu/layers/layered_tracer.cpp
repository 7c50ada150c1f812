// SPDX-License-Identifier: Apache-2.0
//
// The general path. In: any number of layers of any kind, with clips. Out: what one ray gathers,
// within its tolerance, in both grades. Each layer turns a ray into a stream of stretches on which
// its channels are polynomials (layer_stream.h). The streams are merged: between two ends of any
// stretch, the layers that are present are one function of all of their channels (bundle.h), a sum
// of terms, which MultivariateRayIntegrator cuts and integrates. Called by Frame for every scene
// that no faster tracer is for.

#include <algorithm>
#include <limits>
#include <utility>

#include "layers/bundle.h"
#include "layers/clip_intervals.h"
#include "layers/layer_stream.h"
#include "pellucid/render/multivariate_integrator.h"
#include "ray_tracer.h"
#include "threads.h"

namespace pellucid {
namespace {

/// Fraction of the tolerance for primitives that are left out of blocks.
constexpr double left_out_share = 1.0 / 32;

/// Length of a ray that no data are longer than.
double reach(const std::vector<Layer>& layers) {
  double longest = 0;
  for (const Layer& layer : layers) {
    const std::array<Vec3<double>, 8> corners = world_corners(layer);
    for (std::size_t i = 0; i < 4; ++i) {
      longest = std::max(longest, length(corners[7 - i] - corners[i]));
    }
  }
  return longest;
}

/// One layer along a ray, cut by its clips.
class ClippedStream {
 public:
  ClippedStream(std::unique_ptr<LayerStream> stream, const std::vector<Clip>& own,
                const std::vector<Clip>& of_scene)
      : stream_(std::move(stream)), own_(own), of_scene_(of_scene) {}

  /// Returns the interval in which the layer may be present.
  Interval<double> start(const Ray<double>& ray) {
    stretch_ = absent();
    uncertain_ = 0;
    Interval<double> inside = stream_->start(ray);
    inside.begin = std::max(inside.begin, 0.0);
    if (!(inside.begin < inside.end)) return {1, 0};
    ClipIntervals intervals(inside);
    for (const std::vector<Clip>* clips : {&own_, &of_scene_}) {
      for (const Clip& clip : *clips) intervals.cut(clip, ray);
    }
    uncertain_ = intervals.error_in(inside);
    ranges_ = std::move(intervals.kept);
    range_ = 0;
    if (ranges_.empty()) return {1, 0};
    const Interval<double> all{ranges_.front().begin, ranges_.back().end};
    stream_->restrict_to_range(ranges_[range_++]);
    advance();
    return all;
  }
  /// Returns the total error of the positions at which clips cut the ray.
  double uncertain() const { return uncertain_; }

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
      if (stream_->next(stretch_)) return;
      if (range_ == ranges_.size()) {
        stretch_ = absent();
        return;
      }
      stream_->restrict_to_range(ranges_[range_++]);
    }
  }

  std::unique_ptr<LayerStream> stream_;
  const std::vector<Clip>&own_, &of_scene_;
  std::vector<Interval<double>> ranges_;
  std::size_t range_ = 0;
  double uncertain_ = 0;
  LayerStretch stretch_;
};

class LayeredTracer : public RayTracer {
 public:
  LayeredTracer(const TracerTask& task, const std::vector<Layer>& layers)
      : layers_(layers),
        clips_(task.scene.clips),
        wanted_(task.wanted),
        depth_(task.options.depth) {
    LayerTask each{layers_.empty() ? task.layer : layers_.front(), wanted_, 0,
                   parallel_for(task.threads)};
    each.negligible_extinction =
        left_out_share * wanted_.tolerance /
        (std::max(reach(layers_), std::numeric_limits<double>::min()) *
         std::max(wanted_.largest_color, 1.0) * std::max(static_cast<double>(layers_.size()), 1.0));
    for (const Layer& layer : layers_) {
      sources_.push_back(
          make_layer_source({layer, each.wanted, each.negligible_extinction, each.parallel}));
      most_.push_back(largest_extinction(layer));
      largest_extinction_ += most_.back();
    }
    wanted_.tolerance *= 1 - left_out_share;
  }

  std::vector<RayResult> trace(const std::vector<Ray<double>>& world,
                               double /*share*/) const override {
    Bundles bundles(sources_);
    std::vector<ClippedStream> streams;
    streams.reserve(layers_.size());
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      streams.emplace_back(sources_[i]->stream(), layers_[i].clips, clips_);
    }
    std::vector<RayResult> results;
    results.reserve(world.size());
    for (const Ray<double>& ray : world) results.push_back(trace_one(ray, streams, bundles));
    return results;
  }

 private:
  RayResult trace_one(const Ray<double>& ray, std::vector<ClippedStream>& streams,
                      Bundles& bundles) const {
    RayResult result =
        follow(ray, streams, bundles, std::numeric_limits<double>::infinity(), nullptr);
    if (depth_ && result.opacity > 0) {
      follow(ray, streams, bundles, HalfOpacity{}.depth_to_half(result.opacity),
             &result.half_opacity_depth);
    }
    return result;
  }

  /// Integrates a ray, up to this optical depth; the position at which it is reached goes to
  /// `position`.
  RayResult follow(const Ray<double>& ray, std::vector<ClippedStream>& streams, Bundles& bundles,
                   double target, double* position) const {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Interval<double> inside{infinity, -infinity};
    double unknown = 0;
    for (std::size_t i = 0; i < streams.size(); ++i) {
      const Interval<double> own = streams[i].start(ray);
      unknown += most_[i] * streams[i].uncertain();
      if (own.empty()) continue;
      inside.begin = std::min(inside.begin, own.begin);
      inside.end = std::max(inside.end, own.end);
    }
    const bool misses = inside.empty();
    if (misses && !(unknown > 0)) return missed_ray_result();
    MultivariateRayIntegrator integrator(nothing_, largest_extinction_, wanted_,
                                         misses ? 0 : inside.end - inside.begin);
    if (target < infinity) integrator.set_target_depth(target);
    if (unknown > 0) integrator.charge_opacity(unknown);
    long cells = 0;
    if (!misses) cells = merge(streams, inside, bundles, integrator);
    RayResult result = integrator.result();
    result.cells = cells;
    if (position != nullptr) *position = std::min(integrator.target_position(), inside.end);
    return result;
  }

  /// Integrates from end to end of the streams' stretches. Returns the number of parts.
  long merge(std::vector<ClippedStream>& streams, Interval<double> inside, Bundles& bundles,
             MultivariateRayIntegrator& integrator) const {
    std::vector<int> key(streams.size(), -1);
    const Bundle* bundle = nullptr;
    Bundle::Span span;
    long parts = 0;
    for (double t = inside.begin; t < inside.end && !integrator.done();) {
      double next = inside.end, unknown = 0, left_out = 0, position_error = 0;
      bool changed = bundle == nullptr, present = false;
      for (std::size_t i = 0; i < streams.size(); ++i) {
        unknown += streams[i].advance_to(t);
        const LayerStretch& stretch = streams[i].stretch();
        const bool here = stretch.begin <= t;
        next = std::min(next, here ? stretch.end : stretch.begin);
        const int function = here ? stretch.function : -1;
        changed = changed || key[i] != function;
        key[i] = function;
        present = present || function >= 0;
        if (!here) continue;
        unknown += streams[i].take_unknown();
        left_out += stretch.left_out;
        if (function >= 0) position_error += stretch.position_error;
      }
      if (unknown > 0) integrator.charge_opacity(unknown);
      if (!present) {
        integrator.skip(next - t, left_out);
        t = next;
        continue;
      }
      if (changed) bundle = &bundles.find(key);
      ++parts;
      if (!bundle->fits()) {
        integrator.charge_opacity(1);
        return parts;
      }
      PrimitiveSet primitives{0};
      for (std::size_t i = 0; i < streams.size(); ++i) {
        if (key[i] < 0) continue;
        take(streams[i].stretch(), sources_[i]->functions()[static_cast<std::size_t>(key[i])], t,
             next, span.data + bundle->first_channel(i));
        primitives.bits |= bundle->primitives(i, streams[i].stretch().primitives).bits;
      }
      span.length = next - t;
      integrator.set_transfer(bundle->transfer());
      integrator.add_stretch(span, {t, next}, primitives, left_out,
                             position_error + 8 * rounding_unit<double> * next);
      t = next;
    }
    return parts;
  }

  /// The part [begin, end] of a stretch.
  static void take(const LayerStretch& stretch, const MultivariateTransfer<double>& transfer,
                   double begin, double end, CubicBernstein<double>* to) {
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

  const std::vector<Layer>& layers_;
  const std::vector<Clip>& clips_;
  RayTolerance wanted_;
  const bool depth_;
  std::vector<std::unique_ptr<const LayerSource>> sources_;
  const MultivariateTransfer<double> nothing_{};  ///< before the first stretch
  std::vector<double> most_;                      ///< largest extinction of each layer
  double largest_extinction_ = 0;
};

}  // namespace

std::unique_ptr<const LayerSource> make_layer_source(const LayerTask& task) {
  if (std::holds_alternative<VolumeContent>(task.layer.content)) return make_volume_source(task);
  if (std::holds_alternative<ChannelsContent>(task.layer.content)) {
    return make_channels_source(task);
  }
  if (std::holds_alternative<MeshContent>(task.layer.content)) return make_mesh_source(task);
  return make_label_source(task);
}

std::unique_ptr<const RayTracer> make_layered_tracer(const TracerTask& task,
                                                     const std::vector<Layer>& layers) {
  return std::make_unique<LayeredTracer>(task, layers);
}

}  // namespace pellucid
