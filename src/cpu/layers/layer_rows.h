// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "layer_stream.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/packet/layered_interface.h"
#include "pellucid/packet/layers/lane_mixture.h"
#include "pellucid/packet/light.h"
#include "pellucid/scene/binned_transfer_storage.h"

namespace pellucid {

/// A layer as packets see it.
struct SeenLayer {
  const LayerSource* source = nullptr;
  int first_function = 0;  ///< number of its first one
  int first_mark = 0;      ///< likewise, of the marks of its isosurfaces
  bool in_lanes = false;   ///< whether packets are for it at all
  std::optional<BinnedTransferStorage> factor;
  std::optional<PacketLight> light;
  std::vector<const BinnedTransfer*> function;  ///< each of its functions
  std::vector<PellucidPacketJob> grid;  ///< of the cells that its stretches tell, by variable
  std::vector<Gaussian<float>> gaussians;
  std::optional<LaneMixture> mixture;  ///< of these; none: of one variable
};

/// Returns a bound on x >= 0 in binary32.
float single_above(double x);

/// Writes the fields of a layer's part of a row (PellucidLayerRow::Part): of a stretch of the layer
/// with its function of this number, the range. `curves`: of a layer of several variables, for
/// their data. `absorbs`: set to false where it does not. Returns false if it is not for lanes.
bool write_part(const SeenLayer& layer, int number, const LayerStretch& stretch,
                Interval<double> range, float* to, float* curves, bool& absorbs);

}  // namespace pellucid
