// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "pellucid/math/rgb.h"
#include "pellucid/render/half_opacity.h"

namespace pellucid {

/// Number of spans of a ray by integration rule.
struct RuleCounts {
  std::uint64_t skipped = 0;    ///< transparent blocks and cells
  std::uint64_t constant = 0;   ///< blocks with a constant transfer function over their range
  std::uint64_t strides = 0;    ///< strides over several cells
  std::uint64_t lines = 0;      ///< cells or parts of cells with a line in place of the data
  std::uint64_t closed = 0;     ///< cells in closed form: exact depth, mean or linear color
  std::uint64_t panels = 0;     ///< cells that needed Gauß panels
  std::uint64_t in_double = 0;  ///< number of the above that needed binary64

  PELLUCID_HD constexpr RuleCounts& operator+=(const RuleCounts& other) noexcept {
    skipped += other.skipped;
    constant += other.constant;
    strides += other.strides;
    lines += other.lines;
    closed += other.closed;
    panels += other.panels;
    in_double += other.in_double;
    return *this;
  }
};

/// Outcome of a ray.
enum class RayStatus : std::uint8_t {
  followed,
  // To another way of following rays; what was found means nothing:
  left,        ///< to the next way
  for_one_ray  ///< to the way for one ray: no packets are for it
};

/// The result of one ray. It is accumulated in double whatever the kernels' number type: summing
/// thousands of cells in binary32 would cost more accuracy than the kernels do (specification,
/// 2.3).
struct RayResult {
  Rgb<double> radiance{};  ///< premultiplied
  double opacity = 0;
  double optical_depth = 0;
  /// World arc length at which half of the opacity is reached; infinite if the ray is transparent
  /// or the depth was not requested.
  double half_opacity_depth = std::numeric_limits<double>::infinity();
  HalfOpacity half;  ///< bracket of that position, before it is searched for
  long cells = 0;    ///< cells traversed, or samples taken

  /// Largest possible error of radiance and opacity; infinite if unknown.
  double error = std::numeric_limits<double>::infinity();
  /// Information for adaptive pixel interpolation. `neighbor_deviation` is the standard deviation
  /// by which neighboring rays may differ from a smooth function of the pixel; infinite if unknown.
  /// `longest_step` is the largest distance between rays, in voxels, that misses no detail; 0 if
  /// unknown.
  float neighbor_deviation = std::numeric_limits<float>::infinity(), longest_step = 0;
  RayStatus status = RayStatus::followed;
  bool proved = false;   ///< true if `error` is a proved bound, not an estimate
  long evaluations = 0;  ///< cells gathered and points sampled
  RuleCounts spans;
};

/// Returns the result of a ray that misses the data: error 0, proved.
PELLUCID_HD inline RayResult missed_ray_result() noexcept {
  RayResult nothing;
  nothing.error = 0;
  nothing.proved = true;
  return nothing;
}

/// Returns the result of a ray that is left to another way.
PELLUCID_HD inline RayResult left_ray_result(RayStatus status = RayStatus::left) noexcept {
  RayResult left;
  left.status = status;
  return left;
}

}  // namespace pellucid
