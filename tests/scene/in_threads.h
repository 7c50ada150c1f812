// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

namespace pellucid {

/// A ParallelFor on two threads, in parts of one and of many.
inline void in_threads(int count, const std::function<void(int, int)>& body) {
  std::thread first([&] {
    for (int i = 0; i < count / 2; ++i) body(i, i + 1);
  });
  body(count / 2, count);
  first.join();
}

}  // namespace pellucid
