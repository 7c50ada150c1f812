// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/scene/volume.h"

namespace pellucid {

/// One per core that this process may use.
int default_thread_count();

/// Splits work among this many threads. A thread that waits for the others does not take up work
/// from elsewhere, which might wait for it.
ParallelFor parallel_for(int threads);

}  // namespace pellucid
