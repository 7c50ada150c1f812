// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid::device_check {

/// Reads what Nsight Compute prints by `ncu --csv --page raw`: lines before the header are
/// skipped, the line of units behind it too. Returns for each kernel the metrics of its longest
/// launch (gpu__time_duration.sum), as text, with "kernel" and "launches"; nothing where there is
/// no such table.
std::vector<nlohmann::ordered_json> kernels_of(std::string_view csv);

}  // namespace pellucid::device_check
