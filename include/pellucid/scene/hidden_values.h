// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns the values with NaN, which is vacuum, where a place is hidden: whole numbers of up to 16
/// bits and float as float, others as double. A place has `components` values side by side, and
/// `hidden` one entry for each place.
VolumeData without_hidden(const VolumeData& data, const std::vector<bool>& hidden,
                          int components = 1);

}  // namespace pellucid
