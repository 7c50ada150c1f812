// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "memory_limit.h"
#include "pellucid/scene/error.h"

namespace pellucid {

namespace {

std::string mebibytes(std::uintmax_t bytes) {
  return std::to_string(bytes >> 20) + " MiB";
}

}  // namespace

void refuse_memory(std::uintmax_t bytes, const std::string& what, const MemoryLimit& limit) {
  throw Error(what + " would take " + mebibytes(bytes) + " of memory, but " + limit.of +
              " leaves " + mebibytes(limit.bytes) + "; make room, or crop or reduce the volume");
}

void check_memory(std::uintmax_t bytes, const std::string& what,
                  const std::filesystem::path& root) {
  const MemoryLimit limit = memory_limit(root);
  if (bytes > limit.bytes) refuse_memory(bytes, what, limit);
}

}  // namespace pellucid
