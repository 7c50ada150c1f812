// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"

/// What goes between the renderer and packets of rays through several fields, as
/// packet/interface.h.
extern "C" {

struct PellucidGaussianPacketJob {
  /// Of this the grid without data, its blocks, what is wanted, rays and results.
  PellucidPacketJob grid_and_rays;
  PellucidView<PellucidMultichannelGrid> grid;
  PellucidView<PellucidPrimitiveSets> primitives;  ///< per block: those that matter there
  // Of steps: per block and channel; and what they see of the function.
  PellucidView<PellucidBlockVariations> variation;
  PellucidView<PellucidSteppedMixture> stepped;
  PellucidView<PellucidNearMixture> near;  ///< of cells: what they see of the function
  /// SmoothChannels::waves; null: nothing is to be found out of rays beside each other. Of steps.
  const float* waves;
  double left_out;      ///< of the extinction, anywhere, at most
  std::int32_t proved;  ///< whether only what is proved counts; of cells
};

PELLUCID_KERNEL(pellucid_integrate_gaussian_packets, const PellucidGaussianPacketJob);

/// Cell by cell.
PELLUCID_KERNEL(pellucid_integrate_multivariate_cells, const PellucidGaussianPacketJob);
}
