// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "pellucid/scene/mesh_channels.h"
#include "pellucid/scene/volume.h"

namespace pellucid {

/// Number of positions that are sampled in data: a quarter of a million puts a quantile within 0.1
/// %.
inline constexpr std::size_t max_places = std::size_t{1} << 18;

/// Calls visit(index) with all indices below `size`, or with max_places of them if there are more:
/// at the fractional parts of n/golden ratio, which are even at every scale. A fixed stride would
/// see single columns of a grid.
template <class Visit>
void visit_even_places(std::size_t size, const Visit& visit) {
  if (size <= max_places) {
    for (std::size_t i = 0; i < size; ++i) visit(i);
    return;
  }
  for (std::size_t n = 0; n < max_places; ++n) {
    const double s = static_cast<double>(n) / std::numbers::phi;
    const double place = (s - std::floor(s)) * static_cast<double>(size);
    visit(std::min(static_cast<std::size_t>(place), size - 1));
  }
}

/// Returns up to 2^18 finite values, ascending, the outermost 0.1 % at either end drawn in. They
/// sort in milliseconds.
std::vector<double> value_sample(const Volume& volume);
/// Returns the first channel at up to 2^18 points that are even in the mesh's volume.
std::vector<double> value_sample(const MeshChannels& channels);

}  // namespace pellucid
