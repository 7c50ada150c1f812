// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/mesh_channels.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Up to 2^18 finite values, ascending, the outermost 0.1 % at either end drawn in: a quarter of a
/// million puts a quantile within 0.1 %, and sorts in milliseconds.
std::vector<double> value_sample(const Volume& volume);
/// The first channel at up to 2^18 points that are even in the mesh's volume.
std::vector<double> value_sample(const MeshChannels& channels);

}  // namespace pellucid
