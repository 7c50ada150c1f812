// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace pellucid::bench {

/// Runs every way once per round, after one run that is not counted; each round begins at another
/// way, so that the machine's drift does not fall on one of them. Returns the median of each way's
/// own results (seconds).
std::vector<double> interleaved_medians(const std::vector<std::function<double()>>& ways,
                                        std::size_t rounds);

double median(std::vector<double> values);

}  // namespace pellucid::bench
