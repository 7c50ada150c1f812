// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"

/// Interface of the renderer and packets of rays through several fields, as packet/interface.h.
extern "C" {

struct PellucidGaussianPacketJob {
  /// Grid without data, its blocks, tolerance, rays and results; other members are not used.
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
