// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <stop_token>
#include <vector>

#include "clipped_layer.h"
#include "layer_rows.h"
#include "pellucid/packet/light.h"
#include "pellucid/scene/internal/binned_transfer_storage.h"
#include "pellucid/simd/instruction_set.h"
#include "ray_tracer.h"

namespace pellucid {

/// Follows rays through several layers in packets (packet/layers/layered_packet.h): what
/// GeneralPath does, within estimates. Each ray's streams are merged one number at a time; what
/// lies on it is integrated in lanes. What these cannot do is left to a MultivariateRayIntegrator,
/// part by part. Safe to use from any thread.
class LayeredPackets {
 public:
  /// Null where there are no packets for these layers or for such a tolerance. All that is given
  /// must outlive the object.
  static std::unique_ptr<const LayeredPackets> make(const std::vector<ClippedLayer>& layers,
                                                    const std::vector<LightSource<double>>& lights,
                                                    const RayTolerance& wanted, bool depth);

  /// Returns whether there are packets for a layer like this, with frames as its setting says.
  static bool suit(const LayerSetting& setting);

  /// Returns what the parts gather, each off by at most the tolerance beside it. Errors of the
  /// positions of clips are not counted. The status may leave a part to the general path. Once
  /// `stop` is requested, results do not matter.
  std::vector<RayResult> integrate(const std::vector<RayPart>& parts,
                                   const std::vector<double>& tolerances,
                                   const std::stop_token& stop) const;

 private:
  class Packet;
  using Kernel = void (*)(PellucidLayeredJob*);

  LayeredPackets(const std::vector<ClippedLayer>& layers,
                 const std::vector<LightSource<double>>& lights, const RayTolerance& wanted,
                 bool depth, Kernel kernel);
  /// Adds what packets see of a layer.
  void add(const ClippedLayer& layer, std::size_t number, const PacketLight& lights);

  const std::vector<ClippedLayer>& layers_;
  const std::vector<LightSource<double>>& lights_;
  const RayTolerance wanted_;
  Kernel kernel_;
  std::deque<SeenLayer> seen_;   ///< addresses stay
  std::vector<int> first_mark_;  ///< of each layer's isosurfaces
  std::deque<BinnedTransferStorage> functions_;
  Vec3<double> origin_;  ///< of places in the packets' world
  double extent_ = 0;    ///< how far layers and lights are from it
  int marks_ = 0;
  PellucidLayeredJob job_{};  ///< what all rays have in common
  // As the job sees them.
  std::vector<PellucidView<PellucidBinnedTransfer>> function_;
  std::vector<PellucidView<PellucidLight>> light_;
  std::vector<PellucidView<PellucidLaneMixture>> mixture_;
  std::vector<const PellucidPacketJob*> grid_;
  std::vector<std::int32_t> lit_grid_;
};

}  // namespace pellucid
