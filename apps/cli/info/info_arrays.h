// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "arguments/output.h"
#include "pellucid/io/read_volume.h"

namespace pellucid::cli {

/// Return the arrays of a volume file in which they have names; `chosen` is the one that was read.
std::string arrays_text(const std::vector<VolumeArray>& arrays, const std::string& chosen);
Json arrays_json(const std::vector<VolumeArray>& arrays);

}  // namespace pellucid::cli
