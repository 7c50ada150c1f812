// SPDX-License-Identifier: Apache-2.0
#include "scene_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "general_path.h"
#include "interval_near.h"
#include "layered_packets.h"
#include "pellucid/traverse/structured_walk.h"
#include "sample/sampled_path.h"

namespace pellucid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// A stretch of one layer goes with its neighbors on the general path if it is shorter than this
/// share of them: what it saves is not worth a share of the tolerance.
constexpr double short_share = 1.0 / 8;

/// The fewest rays of those given at once that packets are begun for, where most went another way.
constexpr std::size_t fewest_in_packets = 4;

/// Returns whether a result is none: the part was left, or its numbers overflowed.
bool is_left(const RayResult& result) {
  return result.status != RayStatus::followed || !std::isfinite(result.error);
}

/// Stretch of a ray that one tracer follows.
struct RaySegment {
  static constexpr int general = -1;
  int tracer;  ///< index of the layer that is alone, or `general`
  Interval<double> range;
  double share = 1;  ///< of the tolerance
};

/// A ray on its way, composited front to back.
struct RayState {
  /// Result of a piece.
  struct Found {
    Interval<double> range;
    double opacity_before;  ///< of the ray
    double opacity;         ///< of the piece
    HalfOpacity half;       ///< of that
    bool has_surfaces;      ///< whether a medium is not all of it
  };
  std::vector<RaySegment> pieces;
  RayResult found = missed_ray_result();
  std::vector<Found> of_pieces;  ///< those that absorb, front to back
  bool done = false;             ///< what is left cannot matter

  double transparency() const { return 1 - found.opacity; }
  /// The error of a part bounds what it does to everything behind it (RayResult::error), so that
  /// errors add up behind transparencies.
  void add_behind(const RayResult& part, Interval<double> range, bool has_surfaces) {
    const double before = transparency();
    if (part.opacity > 0) {
      of_pieces.push_back({range, found.opacity, part.opacity, part.half, has_surfaces});
    }
    found.radiance += before * part.radiance;
    found.error += before * part.error;
    found.opacity += before * part.opacity;
    found.optical_depth += part.optical_depth;
    found.proved = found.proved && part.proved;
    found.cells += part.cells;
    found.evaluations += part.evaluations;
    found.spans += part.spans;
  }
  /// Says between which places half of the opacity is reached.
  void bracket_half() {
    if (found.half_opacity_depth < infinity) return;
    for (const Found& piece : of_pieces) {
      const double left = 1 - piece.opacity_before, wanted = 0.5 * found.opacity;
      if (piece.opacity_before + left * piece.opacity < wanted) continue;
      found.half = {piece.range, piece.opacity_before};
      if (piece.has_surfaces) return;
      // Half of the piece's own opacity is between these, as far as binary32 knows such places: no
      // medium must be missed.
      const double rounding =
          2 * static_cast<double>(rounding_unit<float>) * (piece.range.end - piece.range.begin);
      const Interval<double> own{std::max(piece.range.begin, piece.half.range.begin - rounding),
                                 std::min(piece.range.end, piece.half.range.end + rounding)};
      const double at_begin = piece.opacity_before + left * piece.half.opacity_before;
      if (!(own.begin < own.end)) return;
      if (wanted < at_begin) {
        found.half.range.end = std::min(own.begin + 2 * rounding, piece.range.end);
      } else {
        const double at_half = piece.opacity_before + left * 0.5 * piece.opacity;
        found.half = {{own.begin, wanted < at_half ? own.end : piece.range.end}, at_begin};
      }
      return;
    }
  }
};

class SceneTracer : public RayTracer {
 public:
  SceneTracer(std::vector<ClippedLayer> layers, const std::vector<Light>& lights,
              const RayTolerance& wanted, bool depth)
      : layers_(std::move(layers)),
        lights_(light_sources(lights)),
        wanted_(wanted),
        depth_(depth),
        only_(layers_.size() == 1 && layers_[0].clips.empty() ? layers_[0].setup->fast()
                                                              : nullptr) {
    for (const ClippedLayer& layer : layers_) {
      surfaces_ = surfaces_ || has_surfaces(layer.setup->layer());
    }
    // Where most rays have a fast way, what few of them need is made once it is needed.
    if (only_ == nullptr && !layers_.empty()) packets();
  }

  std::optional<InterpolationInfo> interpolation_info() const override {
    return only_ != nullptr ? only_->interpolation_info() : std::nullopt;
  }
  bool keeps_to_ranges() const override { return true; }

  std::vector<double> find_depths(const std::vector<RayPart>& parts,
                                  const std::vector<double>& depths) const override {
    std::optional<GeneralPath> general;
    std::vector<double> positions;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      positions.push_back(made(general).find_depth(parts[i], depths[i]));
    }
    return positions;
  }

  std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                               const TraceOptions& options) const override {
    std::optional<GeneralPath> general;
    const bool fits_only =
        only_ != nullptr && (only_->keeps_to_ranges() || std::ranges::all_of(parts, is_whole));
    if (is_sampled()) return fits_only ? only_->trace(parts, options) : sample(parts, options);
    if (fits_only) {
      std::vector<RayResult> results = only_->trace(parts, options);
      follow_left(parts, wanted_.tolerance * options.share, options.stop, results, general);
      for (std::size_t i = 0; depth_ && i < parts.size() && !options.stop.stop_requested(); ++i) {
        find_depth(general, parts[i], results[i]);
      }
      return results;
    }
    std::vector<RayState> journeys(parts.size());
    std::size_t most = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      plan(parts[i], journeys[i]);
      most = std::max(most, journeys[i].pieces.size());
    }
    for (std::size_t n = 0; n < most && !options.stop.stop_requested(); ++n) {
      trace_single_layer(n, parts, options, journeys, general);
      trace_overlap(n, parts, options, journeys, general);
    }
    std::vector<RayResult> results;
    results.reserve(parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      RayState& journey = journeys[i];
      if (depth_ && !options.stop.stop_requested()) {
        journey.bracket_half();
        find_depth(general, parts[i], journey.found);
      }
      results.push_back(journey.found);
    }
    return results;
  }

 private:
  bool is_sampled() const {
    return !layers_.empty() && layers_[0].setup->setting().integration.method != Method::exact;
  }
  std::vector<RayResult> sample(const std::vector<RayPart>& parts,
                                const TraceOptions& options) const {
    std::call_once(plan_made_, [&] {
      plan_.emplace(layers_, layers_[0].setup->setting().integration, largest_color(), depth_);
    });
    SampledPath path(layers_, lights_, *plan_, largest_color());
    std::vector<RayResult> results;
    results.reserve(parts.size());
    for (const RayPart& part : parts) {
      if (options.stop.stop_requested()) break;
      results.push_back(path.sample(part, options.stop));
    }
    results.resize(parts.size());
    return results;
  }
  double largest_color() const { return std::max(wanted_.largest_color, 1.0); }

  /// Returns the interval of a ray outside of which a layer is absent.
  static Interval<double> extent(const Layer& layer, const Ray<double>& ray) {
    if (const Volume* volume = grid_of(layer)) {
      const Ray<double> in_grid = volume->grid_from_world().ray(ray);
      return volume->visit([&](const auto& grid) { return grid_interval(grid.axis, in_grid); });
    }
    if (const auto* const own = std::get_if<SourceContent>(&layer.content)) {
      return interval_near(own->source->description().bounds, ray);
    }
    const Tetrahedra mesh = std::get<MeshContent>(layer.content).mesh->mesh().view();
    return interval_near({mesh.lower, mesh.upper}, mesh.coordinate_bound, ray);
  }

  /// Cuts a part of a ray where layers begin and end.
  void plan(const RayPart& part, RayState& journey) const {
    struct Stretch {
      int layer;
      Interval<double> range;
      bool whole;  ///< all that the ray has of the layer
    };
    std::vector<Stretch> stretches;
    std::vector<double> ends;
    double unknown = 0;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const LayerSetup& setup = *layers_[i].setup;
      const Interval<double> all = extent(setup.layer(), part.ray);
      const Interval<double> inside{std::max(all.begin, part.range.begin),
                                    std::min(all.end, part.range.end)};
      if (!(inside.begin < inside.end)) continue;
      const ClipIntervals intervals(inside, layers_[i].clips, part.ray);
      if (!intervals.uncertain.empty()) {
        unknown += std::min(setup.largest_extinction() * intervals.error_in(inside), 1.0);
      }
      for (const Interval<double>& kept : intervals.kept) {
        const bool whole = kept.begin == all.begin && kept.end == all.end;
        stretches.push_back({static_cast<int>(i), kept, whole});
        ends.push_back(kept.begin);
        ends.push_back(kept.end);
      }
    }
    journey.found.error = largest_color() * std::min(unknown, 1.0);
    std::ranges::sort(ends);
    std::vector<RaySegment>& pieces = journey.pieces;
    for (std::size_t n = 0; n + 1 < ends.size(); ++n) {
      const Interval<double> range{ends[n], ends[n + 1]};
      if (!(range.begin < range.end)) continue;
      const Stretch* first = nullptr;
      int present = 0;
      for (const Stretch& stretch : stretches) {
        if (stretch.range.begin > range.begin || stretch.range.end < range.end) continue;
        if (first == nullptr) first = &stretch;
        ++present;
      }
      if (present == 0) continue;
      const RayTracer* const fast = layers_[static_cast<std::size_t>(first->layer)].setup->fast();
      const bool uncut =
          first->whole && first->range.begin == range.begin && first->range.end == range.end;
      const bool alone = present == 1 && fast != nullptr && (fast->keeps_to_ranges() || uncut);
      add({alone ? first->layer : RaySegment::general, range}, pieces);
    }
    leave_short_ones(pieces);
    share_tolerance(pieces);
  }

  /// Adds a piece, or makes the last one longer.
  static void add(const RaySegment& piece, std::vector<RaySegment>& pieces) {
    if (!pieces.empty() && pieces.back().tracer == piece.tracer &&
        (piece.tracer == RaySegment::general || pieces.back().range.end == piece.range.begin)) {
      pieces.back().range.end = piece.range.end;
    } else {
      pieces.push_back(piece);
    }
  }

  /// Gives short pieces beside the general path to it.
  static void leave_short_ones(std::vector<RaySegment>& pieces) {
    const auto length = [](const RaySegment& piece) { return piece.range.end - piece.range.begin; };
    for (std::size_t n = 0; n < pieces.size(); ++n) {
      if (pieces[n].tracer == RaySegment::general) continue;
      for (const std::size_t beside : {n - 1, n + 1}) {
        if (beside < pieces.size() && pieces[beside].tracer == RaySegment::general &&
            length(pieces[n]) < short_share * length(pieces[beside])) {
          pieces[n].tracer = RaySegment::general;
        }
      }
    }
    std::vector<RaySegment> joined;
    for (const RaySegment& piece : pieces) add(piece, joined);
    pieces = std::move(joined);
  }

  /// Half of the tolerance is for the general path, where what others have not spent is added.
  static void share_tolerance(std::vector<RaySegment>& pieces) {
    const auto general = static_cast<double>(std::ranges::count_if(
        pieces, [](const RaySegment& piece) { return piece.tracer == RaySegment::general; }));
    const double alone = static_cast<double>(pieces.size()) - general;
    for (RaySegment& piece : pieces) {
      const double half = general > 0 && alone > 0 ? 0.5 : 1;
      piece.share = half / (piece.tracer == RaySegment::general ? general : alone);
    }
  }

  /// Returns whether the n-th piece is to be followed; ends rays that nothing more matters of.
  bool goes_on(RayState& journey, std::size_t n, const TraceOptions& options) const {
    if (journey.done || n >= journey.pieces.size()) return false;
    const double rest = journey.transparency() * largest_color();
    const double left = wanted_.tolerance * options.share - journey.found.error;
    if (rest > 0.25 * left) return true;
    journey.found.error += rest;
    journey.done = true;
    return false;
  }

  /// The n-th pieces on which one layer is alone.
  void trace_single_layer(std::size_t n, const std::vector<RayPart>& parts,
                          const TraceOptions& options, std::vector<RayState>& journeys,
                          std::optional<GeneralPath>& general) const {
    struct Group {
      int tracer;
      double share;
      std::vector<RayPart> parts;
      std::vector<std::size_t> of;
    };
    std::vector<Group> groups;
    for (std::size_t i = 0; i < journeys.size(); ++i) {
      if (!goes_on(journeys[i], n, options)) continue;
      const RaySegment& piece = journeys[i].pieces[n];
      if (piece.tracer == RaySegment::general) continue;
      auto group = std::ranges::find_if(groups, [&](const Group& one) {
        return one.tracer == piece.tracer && one.share == piece.share;
      });
      if (group == groups.end()) {
        groups.push_back({piece.tracer, piece.share, {}, {}});
        group = groups.end() - 1;
      }
      group->parts.push_back({parts[i].ray, piece.range});
      group->of.push_back(i);
    }
    for (const Group& group : groups) {
      if (options.stop.stop_requested()) return;
      TraceOptions own = options;
      own.share *= group.share;
      const LayerSetup& setup = *layers_[static_cast<std::size_t>(group.tracer)].setup;
      std::vector<RayResult> found = setup.fast()->trace(group.parts, own);
      follow_left(group.parts, wanted_.tolerance * own.share, own.stop, found, general);
      for (std::size_t k = 0; k < found.size(); ++k) {
        RayState& journey = journeys[group.of[k]];
        journey.add_behind(found[k], group.parts[k].range, has_surfaces(setup.layer()));
        if (journey.pieces.size() == 1) {
          journey.found.half_opacity_depth = found[k].half_opacity_depth;
        }
      }
    }
  }

  /// The n-th pieces of the general path.
  void trace_overlap(std::size_t n, const std::vector<RayPart>& parts, const TraceOptions& options,
                     std::vector<RayState>& journeys, std::optional<GeneralPath>& general) const {
    std::vector<RayPart> ahead;
    std::vector<double> tolerances;
    std::vector<std::size_t> of;
    for (std::size_t i = 0; i < journeys.size(); ++i) {
      RayState& journey = journeys[i];
      if (!goes_on(journey, n, options)) continue;
      const RaySegment& piece = journey.pieces[n];
      if (piece.tracer != RaySegment::general) continue;
      // What is not spent, nor for pieces behind.
      const double tolerance = wanted_.tolerance * options.share;
      double left = tolerance - journey.found.error;
      for (std::size_t k = n + 1; k < journey.pieces.size(); ++k) {
        left -= journey.pieces[k].share * tolerance;
      }
      const double own = std::max(left, 0.5 * piece.share * tolerance) /
                         std::max(journey.transparency(), 1.0 / 64);
      ahead.push_back({parts[i].ray, piece.range});
      tolerances.push_back((1 - ray_left_out_share) * std::min(own, largest_tolerance));
      of.push_back(i);
    }
    std::vector<RayResult> found = packets() != nullptr
                                       ? packets()->integrate(ahead, tolerances, options.stop)
                                       : std::vector(ahead.size(), left_ray_result());
    for (std::size_t k = 0; k < ahead.size() && !options.stop.stop_requested(); ++k) {
      if (is_left(found[k])) found[k] = made(general).integrate(ahead[k], tolerances[k]);
      journeys[of[k]].add_behind(found[k], ahead[k].range, surfaces_);
    }
  }

  /// Follows the parts that a fast way has left: in packets if there are enough of them, and what
  /// is still left then one ray at a time.
  void follow_left(const std::vector<RayPart>& parts, double tolerance, const std::stop_token& stop,
                   std::vector<RayResult>& results, std::optional<GeneralPath>& general) const {
    std::vector<RayPart> left;
    std::vector<std::size_t> of;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (!is_left(results[i]) || results[i].status == RayStatus::for_one_ray) continue;
      left.push_back(parts[i]);
      of.push_back(i);
    }
    tolerance *= 1 - ray_left_out_share;
    if (left.size() >= fewest_in_packets && packets() != nullptr && !stop.stop_requested()) {
      const std::vector<double> tolerances(left.size(), tolerance);
      const std::vector<RayResult> found = packets()->integrate(left, tolerances, stop);
      for (std::size_t k = 0; k < left.size(); ++k) results[of[k]] = found[k];
    }
    for (std::size_t i = 0; i < parts.size() && !stop.stop_requested(); ++i) {
      if (is_left(results[i])) results[i] = made(general).integrate(parts[i], tolerance);
    }
  }

  /// Returns the packets of the general way; null: there are none.
  const LayeredPackets* packets() const {
    std::call_once(packets_made_, [&] {
      if (!is_sampled()) packets_ = LayeredPackets::make(layers_, lights_, wanted_, depth_);
    });
    return packets_.get();
  }

  GeneralPath& made(std::optional<GeneralPath>& general) const {
    if (!general) general.emplace(layers_, lights_, wanted_);
    return *general;
  }
  /// Finds where half of the opacity is reached, if that is not known yet.
  void find_depth(std::optional<GeneralPath>& general, const RayPart& part,
                  RayResult& result) const {
    if (!(result.opacity > 0) || result.half_opacity_depth < infinity) return;
    const HalfOpacity& half = result.half;
    const Interval<double> range{std::max(part.range.begin, half.range.begin),
                                 std::min(part.range.end, half.range.end)};
    result.half_opacity_depth =
        made(general).find_depth({part.ray, range}, half.depth_to_half(result.opacity));
  }

  const std::vector<ClippedLayer> layers_;
  const std::vector<LightSource<double>> lights_;
  const RayTolerance wanted_;
  const bool depth_;
  const RayTracer* const only_;  ///< of the only layer, which has no clips; null otherwise
  bool surfaces_ = false;        ///< whether any layer has some
  mutable std::once_flag plan_made_;
  mutable std::optional<SamplingPlan> plan_;  ///< of a method that samples; made when it is needed
  mutable std::once_flag packets_made_;
  mutable std::unique_ptr<const LayeredPackets> packets_;  ///< see packets()
};

}  // namespace

std::unique_ptr<const RayTracer> make_scene_tracer(std::vector<ClippedLayer> layers,
                                                   const std::vector<Light>& lights,
                                                   const RayTolerance& wanted, bool depth) {
  return std::make_unique<SceneTracer>(std::move(layers), lights, wanted, depth);
}

}  // namespace pellucid
