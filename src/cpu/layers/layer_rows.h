// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "layer_stream.h"
#include "pellucid/geometry/ray.h"
#include "pellucid/packet/layered_interface.h"
#include "pellucid/packet/layers/lane_mixture.h"
#include "pellucid/packet/light.h"
#include "pellucid/scene/internal/binned_transfer_storage.h"

namespace pellucid {

/// A layer as packets see it: of one variable, with a function or several to choose from; or a term
/// of a function of several variables, a table or all of its Gaussians.
struct SeenLayer {
  const LayerSource* source = nullptr;
  std::size_t layer = 0;                              ///< of the scene
  int first_function = 0;                             ///< number of its first one
  bool in_lanes = false;                              ///< whether packets are for it at all
  int variable = 0;                                   ///< of its tables
  std::vector<const PiecewiseLinear<double>*> table;  ///< its functions; none: Gaussians
  std::optional<BinnedTransferStorage> factor;
  std::optional<PacketLight> light;
  std::vector<const BinnedTransfer*> function;  ///< each of its functions
  /// Grids of the cells that its stretches tell: of its variables, and of that which lights it
  /// (lit_grid).
  std::vector<PellucidPacketJob> grid;
  int lit_grid = 0;
  std::vector<double> plane[3];  ///< of that grid; empty: uniform
  std::vector<Gaussian<float>> gaussians;
  std::optional<LaneMixture> mixture;  ///< of these; none: tables
};

/// Completes a layer whose source, variable, and table or mixture are set. Its functions become
/// some of `functions`. Returns whether packets are for it.
bool prepare(SeenLayer& one, const PacketLight& lights,
             std::deque<BinnedTransferStorage>& functions);

/// Returns a bound on x >= 0 in binary32.
float single_above(double x);

/// Writes the fields of a layer's part of a row (PellucidLayerRow::Part): of a stretch of the layer
/// with its function of this number, the range. `curves`: of a layer of several variables, for
/// their data. `absorbs`: set to false where it does not. Returns false if it is not for lanes.
bool write_part(const SeenLayer& layer, int number, const LayerStretch& stretch,
                Interval<double> range, float* to, float* curves, bool& absorbs);

}  // namespace pellucid
