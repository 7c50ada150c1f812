// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/packet/interface.h"

/// As packet/interface.h, for rays through a variable of a mesh.
extern "C" {

/// A ray through a mesh, with room for what it meets of the boundary.
struct PellucidMeshRay {
  const void* ray;    ///< MeshRay
  double begin, end;  ///< where it may be in the mesh, world arc length
};

/// A part of a span that binary32 is not good enough for, or whose colors bend too much.
struct PellucidLinearSpan {
  double front, back;
  double error, place_error, length;
};

struct PellucidMeshJob {
  const void* mesh;    ///< Tetrahedra
  const void* fields;  ///< MeshFields, of one channel
  // The transfer function and what is wanted.
  const void* transfer;  ///< BinnedTransfer
  double tolerance, largest_color, largest_extinction;
  // Rays and results.
  const PellucidMeshRay* rays;
  PellucidRayResult* results;
  std::int32_t count;
  /// Integrates what the packets hand back.
  void (*integrate_span)(const void* context, const PellucidLinearSpan* span,
                         PellucidCellResult* result);
  const void* context;
};

void pellucid_integrate_mesh_sse4(const PellucidMeshJob* job);
void pellucid_integrate_mesh_avx2(const PellucidMeshJob* job);
void pellucid_integrate_mesh_avx512(const PellucidMeshJob* job);
}
