// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "pellucid/cpu/render.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/render/integrate_cell.h"
#include "pellucid/render/ray_result.h"
#include "pellucid/scene/volume.h"
#include "pellucid/traverse/block_classes.h"

namespace pellucid {

/// Fraction of a ray's tolerance for extinction that grids' blocks and layers leave out.
inline constexpr double ray_left_out_share = 1.0 / 32;

/// A part of a ray in the world, whose direction has length 1.
struct RayPart {
  Ray<double> ray;
  Interval<double> range{0, std::numeric_limits<double>::infinity()};  ///< world arc length
};

/// Returns whether a part is all of its ray.
inline bool is_whole(const RayPart& part) {
  return part.range.begin <= 0 && part.range.end == std::numeric_limits<double>::infinity();
}

/// Options of rays.
struct TraceOptions {
  /// Fraction of the tolerance that the part of a ray has: less than 1 where the ray has other
  /// parts.
  double share = 1;
  /// Fraction of that for traced rays: the remainder is kept for pixels that are interpolated with
  /// the help of RayTracer::interpolation_info().
  double traced_tolerance_fraction = 1;
  /// Once it is requested, what a tracer returns does not matter.
  std::stop_token stop{};
};

/// Tracer of the rays of a frame, made for its data, transfer function and method. It owns or
/// shares all that it refers to but its layer.
class RayTracer {
 public:
  RayTracer() = default;
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;
  virtual ~RayTracer() = default;

  /// Returns what the parts gather, each by itself. With the method `exact`, the status may leave a
  /// part to the general way (left_ray_result()), and an infinite half_opacity_depth leaves
  /// that depth to it, within RayResult::half. Safe to call from any thread.
  virtual std::vector<RayResult> trace(const std::vector<RayPart>& parts,
                                       const TraceOptions& options) const = 0;

  /// Returns whether it keeps to the ranges of the parts; if not, it follows the whole rays.
  virtual bool keeps_to_ranges() const { return false; }

  /// Returns the position on each part at which the optical depth, counted from its begin, reaches
  /// the number beside it; where the part's data end if it never does. Safe to call from any
  /// thread.
  virtual std::vector<double> find_depths(const std::vector<RayPart>& parts,
                                          const std::vector<double>& /*depths*/) const {
    return std::vector<double>(parts.size(), std::numeric_limits<double>::infinity());
  }

  /// Data that are needed to interpolate pixels between rays.
  struct InterpolationInfo {
    const Volume& volume;  ///< whose grid it is
    ClassifiedBlocks blocks;
    double longest_step;  ///< voxels: how far apart rays may be at most
  };
  /// Returns what interpolation between rays has to know; none: nothing is known of what is between
  /// them.
  virtual std::optional<InterpolationInfo> interpolation_info() const { return std::nullopt; }
};

/// Layer, lights and options for which a tracer is made.
struct TracerTask {
  /// In its place (moved_into_place()), of a scene that check_method() accepts. Its clips are not
  /// the tracer's concern. It must outlive the tracer.
  const Layer& layer;
  const Integration& integration;
  const RenderOptions& options;
  const std::vector<Light>& lights;
  RayTolerance wanted;
  int threads = 1;  ///< on which what is needed of the data's blocks is made
};

/// Returns the tracer of a volume with a transfer function. Null if packets do not support its
/// light.
std::unique_ptr<const RayTracer> make_univariate_tracer(const TracerTask& task);
/// Returns the tracer of a volume's isosurfaces. Null if packets do not suit them, or the layer
/// shows more.
std::unique_ptr<const RayTracer> make_surface_tracer(const TracerTask& task);
/// Returns the tracer of channels with a multivariate transfer function. Null if packets do not
/// suit the rays.
std::unique_ptr<const RayTracer> make_multivariate_tracer(const TracerTask& task);
/// Returns the tracer of a mesh with a function of one variable or of several. Null for several if
/// no kernel of packets serves this tolerance, machine and mixture of Gaussians.
std::unique_ptr<const RayTracer> make_mesh_tracer(const TracerTask& task);
/// Returns the tracer of whole rays by one of the methods for comparison, without depths. Null
/// where packets do not suit the layer or the method: it is sampled ray by ray.
std::unique_ptr<const RayTracer> make_packet_sampler(const TracerTask& task);

}  // namespace pellucid
