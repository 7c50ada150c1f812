// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "layers/layer_appearance.h"
#include "pellucid/packet/surfaces.h"
#include "pellucid/scene/transfer_function.h"

namespace pellucid {

/// Returns whether a layer has isosurfaces that packets can meet, and no slices: in one color each,
/// not too many, of data that are continuous and that binary32 holds.
bool has_plain_isosurfaces(const Layer& layer);

/// Returns the isosurfaces of such a layer as packets see them.
PacketSurfaces packet_surfaces(const LayerAppearance& look,
                               const std::vector<LightSource<double>>& lights,
                               double largest_color);

/// Returns the function of such a layer with control points at the values of its isosurfaces, and
/// next to no extinction where there was none at them, so that packets visit them. None: some are
/// so close to another control point, or to a jump, that binary32 does not tell them apart.
std::optional<TransferFunction> with_points_at_isosurfaces(const Layer& layer);

}  // namespace pellucid
