// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns the different values of a part of a volume, ascending, if the part looks like labels
/// (label_count()) or has a single value, which says nothing of the whole; none if it does not.
std::optional<std::vector<double>> label_values_of_part(const Volume& part);

}  // namespace pellucid
