// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string_view>

#include "built_sets.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid::test {

/// Returns whether this build has the kernels of the set (PELLUCID_BUILD_SETS).
inline bool is_built(InstructionSet set) {
  return set == InstructionSet::scalar ||
         std::ranges::any_of(built_sets,
                             [set](std::string_view name) { return name == name_of(set); });
}

/// Returns whether tests of the set run: it is built, and this machine has it.
inline bool runs_here(InstructionSet set) {
  return is_built(set) && is_supported(set);
}

/// Returns the set of fewest lanes that runs here; scalar: none does.
inline InstructionSet narrowest_set() {
  for (const InstructionSet set : packet_sets) {
    if (runs_here(set)) return set;
  }
  return InstructionSet::scalar;
}

}  // namespace pellucid::test
