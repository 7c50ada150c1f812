// SPDX-License-Identifier: Apache-2.0
//
// Stands in for memory_limit.cpp in a page, whose memory is one heap of 32-bit addresses.
#include <emscripten/heap.h>
#include <malloc.h>

#include "memory_limit.h"

namespace pellucid {

MemoryLimit memory_limit(const std::filesystem::path&) {
  const std::uintmax_t most = emscripten_get_heap_max();
  const auto taken = static_cast<std::uintmax_t>(static_cast<unsigned>(mallinfo().uordblks));
  return {most > taken ? most - taken : 0, "a page"};
}

}  // namespace pellucid
