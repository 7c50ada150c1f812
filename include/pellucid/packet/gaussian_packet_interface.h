// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"

/// What goes between the renderer and packets of rays through several fields, as
/// packet/interface.h.
extern "C" {

struct PellucidGaussianPacketJob {
  /// Of this the grid without data, its blocks, what is wanted, rays and results.
  PellucidPacketJob grid_and_rays;
  const void* grid;        ///< MultichannelGrid
  const void* primitives;  ///< PrimitiveSet per block: those that matter there
  const void* variation;   ///< BlockVariation per block and channel
  const void* mixture;     ///< SteppedMixture
  /// SmoothChannels::waves; null: nothing is to be found out of rays beside each other. Of steps.
  const float* waves;
  double left_out;      ///< of the extinction, anywhere, at most
  std::int32_t proved;  ///< whether only what is proved counts; of cells
};

PELLUCID_DECLARE_ENTRIES(void, pellucid_integrate_gaussian_packets,
                         (const PellucidGaussianPacketJob* job));

/// Cell by cell: without `variation`, and `mixture` is a NearMixture.
PELLUCID_DECLARE_ENTRIES(void, pellucid_integrate_multivariate_cells,
                         (const PellucidGaussianPacketJob* job));
}
