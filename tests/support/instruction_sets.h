// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "built_sets.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid::test {

/// Returns whether this build has the kernels of the set (PELLUCID_BUILD_SETS).
constexpr bool is_built(InstructionSet set) {
  switch (set) {
    case InstructionSet::scalar:
      return true;
    case InstructionSet::sse4:
      return built_sse4;
    case InstructionSet::avx2:
      return built_avx2;
    case InstructionSet::avx512:
      return built_avx512;
  }
  return false;
}

/// Returns whether tests of the set run: it is built, and this machine has it.
inline bool runs_here(InstructionSet set) {
  return is_built(set) && is_supported(set);
}

/// Returns the set of fewest lanes that runs here; scalar: none does.
inline InstructionSet narrowest_set() {
  for (const InstructionSet set :
       {InstructionSet::sse4, InstructionSet::avx2, InstructionSet::avx512}) {
    if (runs_here(set)) return set;
  }
  return InstructionSet::scalar;
}

}  // namespace pellucid::test
