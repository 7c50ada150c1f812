// SPDX-License-Identifier: Apache-2.0

// The parser of MRC: any bytes give volumes that hold them, or an Error of one line.

#include "src/io/mrc.h"

#include "read_volumes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pellucid::fuzz::read_volumes(data, size, [](const pellucid::ByteSource& source) {
    return pellucid::open_mrc(source, {});
  });
  return 0;
}
