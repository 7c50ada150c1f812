// SPDX-License-Identifier: Apache-2.0
//
// Stands in for memory_limit.cpp in a page, whose memory is one heap of 32-bit addresses.
#include <emscripten/heap.h>
#include <malloc.h>

#include "memory_limit.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

std::string mebibytes(std::uintmax_t bytes) {
  return std::to_string(bytes >> 20) + " MiB";
}

}  // namespace

MemoryLimit memory_limit(const std::filesystem::path&) {
  const std::uintmax_t most = emscripten_get_heap_max();
  const auto taken = static_cast<std::uintmax_t>(static_cast<unsigned>(mallinfo().uordblks));
  return {most > taken ? most - taken : 0, "a page"};
}

void refuse_memory(std::uintmax_t bytes, const std::string& what, const MemoryLimit& limit) {
  throw Error(what + " would take " + mebibytes(bytes) + " of memory, but " + limit.of +
              " leaves " + mebibytes(limit.bytes) + "; make it smaller, or take the program");
}

void check_memory(std::uintmax_t bytes, const std::string& what,
                  const std::filesystem::path& root) {
  const MemoryLimit limit = memory_limit(root);
  if (bytes > limit.bytes) refuse_memory(bytes, what, limit);
}

}  // namespace pellucid
