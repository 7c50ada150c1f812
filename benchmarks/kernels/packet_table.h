// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

namespace pellucid::bench {

/// A table of the benchmarks named "packet/KERNEL/MAKER/LANES": for each kernel the nanoseconds per
/// lane, and per call where there are several, of each maker and number of lanes. `order`: all
/// names.
std::string packet_markdown(const std::vector<std::string>& order,
                            const std::map<std::string, double>& nanoseconds);

}  // namespace pellucid::bench
