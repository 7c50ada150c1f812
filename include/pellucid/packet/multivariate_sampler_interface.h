// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"

/// Interface of the renderer and rays that sample several fields, as packet/interface.h.
extern "C" {

struct PellucidMultivariateSamplerJob {
  PellucidPacketJob grid_and_rays;  ///< of this the grid without data, its blocks, rays and results
  PellucidView<PellucidMultichannelGrid> grid;
  PellucidView<PellucidPrimitiveSets> primitives;  ///< per block: those that matter there
  PellucidView<PellucidSampledMultivariate> transfer;
  double step;  ///< world length
  double stop;  ///< the transparency at which a ray ends
};

PELLUCID_KERNEL(pellucid_sample_multivariate, const PellucidMultivariateSamplerJob);
}
