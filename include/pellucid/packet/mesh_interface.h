// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/packet/interface.h"

/// Interface as packet/interface.h, for rays through a variable of a mesh.
extern "C" {

/// A part of a ray in the world: its direction of length 1; between which arc lengths it is, the
/// last one perhaps infinite.
struct PellucidMeshRay {
  double origin[3], direction[3];
  double begin, end;
};

/// A part of a span that the packets' rule is not good enough for.
struct PellucidLinearSpan {
  double front, back;
  double error, length, position_error, end_error;
};

/// Facts of a job that the caller of a kernel knows, and the kernel does not.
struct PellucidSpanContext;

struct PellucidMeshJob {
  PellucidView<PellucidTetrahedra> mesh;
  PellucidView<PellucidMeshPoints> points;  ///< one per point
  PellucidView<PellucidMeshFields> fields;
  /// Values of several variables: their values at value_points points, 0 where they have none
  /// there: of the first four channels at each point, then of the next four.
  const double* values;
  std::int32_t value_points;
  /// True if rays see the mesh in double, and not in binary32.
  std::int32_t in_double;
  // The transfer function and what is wanted.
  PellucidView<PellucidBinnedTransfer> transfer;  ///< of one variable
  PellucidView<PellucidNearMixture> mixture;      ///< of several
  double tolerance, largest_color, largest_extinction;
  std::int32_t proved;  ///< whether only what is proved counts
  std::int32_t depth;   ///< whether results are to say where half of the opacity is
  // Rays and results.
  const PellucidMeshRay* rays;
  PellucidRayResult* results;
  std::int32_t count;
  /// Integrates what the packets hand back; those of several variables hand nothing back.
  void (*integrate_span)(const PellucidSpanContext* context, const PellucidLinearSpan* span,
                         PellucidCellResult* result);
  const PellucidSpanContext* context;
};

PELLUCID_KERNEL(pellucid_integrate_mesh, const PellucidMeshJob);

/// Rays through several variables, in double.
PELLUCID_KERNEL(pellucid_integrate_multivariate_mesh, const PellucidMeshJob);
}
