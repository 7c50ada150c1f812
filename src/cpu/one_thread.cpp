// SPDX-License-Identifier: Apache-2.0
//
// Stands in for threads.cpp where a program has one thread.
#include "threads.h"

namespace pellucid {

int default_thread_count() {
  return 1;
}

ParallelFor parallel_for(int) {
  return [](int count, const std::function<void(int, int)>& body) {
    if (count > 0) body(0, count);
  };
}

void parallel_for_ordered(std::size_t count, int, const std::function<bool(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!body(i)) return;
  }
}

}  // namespace pellucid
