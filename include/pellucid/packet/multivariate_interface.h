// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"

/// What goes between the renderer and rays through several fields, as packet/interface.h.
extern "C" {

struct PellucidMultivariateJob {
  const void* grid;      ///< MultichannelGrid
  const void* blocks;    ///< MultivariateBlocks
  const void* transfer;  ///< MultivariateTransfer<double>
  double largest_extinction;
  double tolerance, largest_color;
  std::int32_t proved;  ///< whether only what is proved counts
  const PellucidRay* rays;
  std::int32_t count;
  PellucidRayResult* results;  ///< lines count as `closed`
};

void pellucid_integrate_multivariate_sse4(const PellucidMultivariateJob* job);
void pellucid_integrate_multivariate_avx2(const PellucidMultivariateJob* job);
void pellucid_integrate_multivariate_avx512(const PellucidMultivariateJob* job);
}
