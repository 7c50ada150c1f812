// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>

#include "pellucid/cpu/render.h"
#include "tests/support/instruction_sets.h"

namespace pellucid {

/// How many of them the machine has. Counts of what tests have seen grow with it.
inline int set_count() {
  return static_cast<int>(
      std::count_if(std::begin(packet_sets), std::end(packet_sets), test::runs_here));
}

inline bool no_packets() {
  return set_count() == 0;
}

}  // namespace pellucid
