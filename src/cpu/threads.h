// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

#include "pellucid/cpu/threads.h"

namespace pellucid {

/// Calls body(i) for 0 <= i < count, in this order, on that many threads: each takes the next i
/// when it is done with its last, so that none is idle before all are taken. Where body gives false
/// or throws, no further i is taken.
void parallel_for_ordered(std::size_t count, int threads,
                          const std::function<bool(std::size_t)>& body);

}  // namespace pellucid
