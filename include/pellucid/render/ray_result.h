// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>

#include "pellucid/math/rgb.h"
#include "pellucid/render/half_opacity.h"

namespace pellucid {

/// How the spans of a ray were integrated: how many by each rule.
struct RuleCounts {
  std::uint64_t skipped = 0;    ///< blocks and cells in which nothing absorbs
  std::uint64_t constant = 0;   ///< blocks over whose range the transfer function is constant
  std::uint64_t strides = 0;    ///< stretches over several cells
  std::uint64_t lines = 0;      ///< cells (or halves …) whose data a line stands for
  std::uint64_t closed = 0;     ///< cells in closed form: exact depth, mean or linear color
  std::uint64_t panels = 0;     ///< cells that took Gauß panels
  std::uint64_t in_double = 0;  ///< those of the above for which binary32 was not enough

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

/// What one ray gathers. Accumulated in double whatever the kernels' number type: thousands of
/// cells in binary32 would cost more than the kernels do (specification, 2.3).
struct RayResult {
  Rgb<double> radiance{};  ///< premultiplied
  double opacity = 0;
  double optical_depth = 0;
  /// World arc length at which half of the opacity is reached; infinite where the ray stays clear
  /// or the depth was not asked for.
  double half_opacity_depth = std::numeric_limits<double>::infinity();
  HalfOpacity half;  ///< what is known of that place before it is looked for
  long cells = 0;    ///< cells walked through, or samples taken

  /// How far radiance and opacity may be from the exact ones; infinite where nothing is known.
  double error = std::numeric_limits<double>::infinity();
  /// What is known of rays beside this one: by how much these may differ from what goes smoothly
  /// from ray to ray, as a standard deviation; and how far apart rays may be to show all that
  /// there is between them, in voxels. Infinite and 0 where nothing is known.
  float neighbor_deviation = std::numeric_limits<float>::infinity(), longest_step = 0;
  bool proved = false;   ///< whether `error` is a bound and not an estimate
  long evaluations = 0;  ///< of the field: cells gathered and points sampled
  RuleCounts spans;
};

/// Of a ray that meets nothing.
PELLUCID_HD inline RayResult missed_ray_result() noexcept {
  RayResult nothing;
  nothing.error = 0;
  nothing.proved = true;
  return nothing;
}

}  // namespace pellucid
