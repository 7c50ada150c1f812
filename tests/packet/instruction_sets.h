// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>

#include "pellucid/cpu/render.h"

namespace pellucid {

/// Those that packets are compiled for.
inline constexpr InstructionSet sets[] = {InstructionSet::sse4, InstructionSet::avx2,
                                          InstructionSet::avx512};

inline bool no_packets() {
  return std::none_of(std::begin(sets), std::end(sets), is_supported);
}

}  // namespace pellucid
