// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "clipped_layer.h"
#include "layer_stream.h"
#include "ray_tracer.h"
#include "surface_events.h"

namespace pellucid {

/// Next part of a ray through several layers.
struct MergedPart {
  enum class Kind {
    unknown,  ///< an opacity of at most `opacity` at a point, of which no more is known
    absent,   ///< no layer, only what is left out
    medium,   ///< LayerMerge::key() says of which layers
    surface,  ///< surfaces at one place, as one
    mark,     ///< SurfaceEvent::Kind::mark
    doubt     ///< SurfaceEvent::Kind::charge: of at most `opacity`
  };
  Kind kind = Kind::absent;
  Interval<double> range{0, 0};  ///< world arc length
  double left_out = 0;           ///< upper bound on the extinction of what is ignored there
  double position_error = 0;     ///< of its ends together, world length
  bool lit = false;              ///< whether a layer has light or a factor of its extinction
  double opacity = 0;
  Rgb<double> color{};         ///< of a surface, if it were opaque
  double error = 0;            ///< of a surface, as SurfaceEvent::error
  std::size_t layer = 0;       ///< of a mark or doubt
  std::size_t isosurface = 0;  ///< of the layer
};

/// Merges the streams of all layers along rays, one ray after the other: between two ends of any
/// stretch the same layers are present; surfaces are met between such parts. Used by one thread.
class LayerMerge {
 public:
  /// All must outlive the object. `largest_color` >= 1. `by_cells`: as of LayerSource::stream().
  LayerMerge(const std::vector<ClippedLayer>& layers,
             const std::vector<LightSource<double>>& lights, double largest_color, bool by_cells);
  ~LayerMerge();
  LayerMerge(const LayerMerge&) = delete;
  LayerMerge& operator=(const LayerMerge&) = delete;
  LayerMerge(LayerMerge&&) noexcept;
  LayerMerge& operator=(LayerMerge&&) = delete;

  /// Begins a part of a ray. Returns the interval in which any layer may be; empty if there is
  /// none.
  Interval<double> start(const RayPart& part);
  /// Finds what comes next. Returns false behind the end of that interval.
  bool next(MergedPart& part);

  const std::vector<const LayerSource*>& sources() const noexcept { return sources_; }
  bool has_surfaces() const noexcept { return surfaces_; }
  /// Return, for each layer, the function that is present on the last medium, or -1; and the
  /// stretch of the layer that holds it.
  const std::vector<int>& key() const noexcept { return key_; }
  const std::vector<const LayerStretch*>& stretches() const noexcept { return stretches_; }

 private:
  class ClippedStream;
  enum class State { surfaces_before, streams, surfaces_here, surfaces_at_end, done };

  bool next_surface(double t, MergedPart& part, double& nearest);
  void find_part(MergedPart& part, double& unknown);
  void pass(MergedPart& part) noexcept;

  const std::vector<LightSource<double>>& lights_;
  std::vector<const LayerSource*> sources_;
  std::vector<ClippedStream> streams_;
  std::vector<const LayerStretch*> stretches_;  ///< of the streams
  std::vector<bool> has_medium_, is_lit_;       ///< of the layers' looks
  std::vector<int> key_;
  bool surfaces_ = false;  ///< whether any layer has some

  Interval<double> inside_{0, 0};
  double at_ = 0;
  State state_ = State::done;
  MergedPart ahead_;  ///< found behind surfaces that come first
};

/// Returns the part [begin, end] of a stretch's channel.
CubicBernstein<double> channel_on(const LayerStretch& stretch, int channel,
                                  Interval<double> range) noexcept;

}  // namespace pellucid
