// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/interface.h"

/// What goes between the renderer and the packets of rays that sample; as packet/interface.h.
extern "C" {

enum PellucidSamplingRule : std::int32_t { pellucid_midpoint, pellucid_preintegrated };

struct PellucidSamplerJob {
  PellucidPacketJob grid_and_rays;  ///< of this the grid, its blocks, rays and results
  PellucidSamplingRule rule;
  const void* transfer;       ///< SamplerTransfer
  const void* preintegrated;  ///< PreintegratedTable; empty where the rule is another
  const void* light;          ///< PacketLight; null: unlit
  double step;                ///< world length
  double stop;                ///< the transparency at which a ray ends
};

PELLUCID_DECLARE_ENTRIES(void, pellucid_sample_packets, (const PellucidSamplerJob* job));
}
