// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"

/// Interface of the renderer and the packets of rays that sample; as packet/interface.h.
extern "C" {

enum PellucidSamplingRule : std::int32_t { pellucid_midpoint, pellucid_preintegrated };

struct PellucidSamplerJob {
  PellucidPacketJob grid_and_rays;  ///< of this the grid, its blocks, rays and results
  PellucidSamplingRule rule;
  PellucidView<PellucidSamplerTransfer> transfer;
  PellucidView<PellucidPreintegrated> preintegrated;  ///< null unless the rule is preintegrated
  PellucidView<PellucidLight> light;                  ///< null: unlit
  double step;                                        ///< world length > 0
  double stop;                                        ///< transparency at which a ray ends, [0, 1]
};

PELLUCID_KERNEL(pellucid_sample_packets, const PellucidSamplerJob);
}
