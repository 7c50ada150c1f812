// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/volume.h"

namespace pellucid {

/// Returns the number of cores that this process may use.
int default_thread_count();

/// Returns a function that splits work among `threads` threads. A thread that waits for the others
/// takes up no other work, which might wait for it in turn.
ParallelFor parallel_for(int threads);

}  // namespace pellucid
