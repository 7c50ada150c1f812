// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "pellucid/packet/kernel.h"
#include "pellucid/packet/view.h"

/// Interface of the renderer and the packets of rays, which are compiled once for each instruction
/// set, each time with namespace pellucid under another name: plain numbers and pointers, outside
/// of it, that mean the same on both sides.
extern "C" {

/// A ray in grid coordinates, its parameter the world arc length; begin < end are where it enters
/// the grid's box and leaves it. Whoever misses it makes no packet ray.
struct PellucidRay {
  double origin[3], direction[3];
  double begin, end;
};

/// Between which world arc lengths half of a ray's opacity is reached, and how much of it is in
/// front of them.
struct PellucidHalfOpacity {
  double begin, end, opacity_before;
};

/// The fate of a ray, or of a part of one.
enum PellucidStatus : std::uint8_t {
  pellucid_followed,
  pellucid_left  ///< to the next way of following rays: the result means nothing
};

/// Result of one ray: RayResult, as far as packets know it.
struct PellucidRayResult {
  double radiance[3], opacity, optical_depth;
  double error;
  PellucidHalfOpacity half;  ///< where it was asked for
  std::int32_t cells, evaluations;
  std::int32_t skipped, constant, closed, panels, in_double, strides;
  float neighbor_deviation, longest_step;  ///< of grids' rays
  std::uint8_t proved;
  PellucidStatus status;
};

/// A part of a cell that binary32, or the packets' rule, is not good enough for: [from, 1] of the
/// way through it, or through what lies behind `begin`.
struct PellucidCell {
  std::int32_t cell[3];
  double begin;  ///< world length from the ray's begin: what is before has been done otherwise
  double from;
  double position_error;  ///< world length
  /// The most that its error may be: per_opacity · (a bound on its opacity) + flat.
  double allowance_per_opacity, allowance_flat;
};

struct PellucidCellResult {
  double optical_depth, opacity, transparency, radiance[3];
  double error;          ///< as of RayBudget::spend()
  double opacity_bound;  ///< what the allowance was asked for
  std::uint8_t proved, panels;
  PellucidStatus status;  ///< pellucid_left: the whole ray is
};

enum PellucidValue : std::int32_t {
  pellucid_u8,
  pellucid_i8,
  pellucid_u16,
  pellucid_i16,
  pellucid_u32,
  pellucid_i32,
  pellucid_f32,
  pellucid_f64
};

/// Facts of a job that the caller of a kernel knows, and the kernel does not.
struct PellucidCellContext;

struct PellucidPacketJob {
  // The grid: uniform, at least two values along each axis.
  const void* data;  ///< of this type
  PellucidValue type;
  std::int32_t values[3], padding[3];
  // Its blocks.
  PellucidView<PellucidBlockClasses> classes;  ///< one per block, x fastest
  // The transfer function and what is wanted.
  PellucidView<PellucidBinnedTransfer> transfer;
  double tolerance, largest_color, largest_extinction;
  // Smooth blocks, which are sampled.
  PellucidView<PellucidSamplerTransfer> samples;
  PellucidView<PellucidSmoothBlocks> smooth;  ///< none where cells are wanted
  double sample_rounding;  ///< what rounding makes of the error of a ray there, per world length
  // Rays and results.
  const PellucidRay* rays;
  PellucidRayResult* results;
  std::int32_t count;
  std::int32_t depth;   ///< whether results are to say where half of the opacity is
  std::int32_t proved;  ///< whether bounds are wanted, not estimates
  /// Integrates what the packets hand back.
  void (*integrate_cell)(const PellucidCellContext* context, std::int32_t ray,
                         const PellucidCell* cell, PellucidCellResult* result);
  const PellucidCellContext* context;
  PellucidView<PellucidBlockRecords> records;  ///< one per block, in the order of the classes
  PellucidView<PellucidLight> light;           ///< null: unlit
  PellucidView<PellucidSurfaces> surfaces;     ///< null: none
};

PELLUCID_KERNEL(pellucid_integrate_packets, const PellucidPacketJob);

/// With light, gradient opacity or isosurfaces, data of types that binary32 holds, estimates.
PELLUCID_KERNEL(pellucid_integrate_lit_packets, const PellucidPacketJob);

/// Isosurfaces and nothing else, of such data without vacuum.
PELLUCID_KERNEL(pellucid_meet_surfaces, const PellucidPacketJob);
}
