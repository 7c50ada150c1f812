// SPDX-License-Identifier: Apache-2.0

// The parser of FreeSurfer's MGH: any bytes give volumes that hold them, or an Error of one line.

#include "read_volumes.h"
#include "src/io/medical_volumes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pellucid::fuzz::read_volumes(data, size, [](const pellucid::ByteSource& source) {
    return pellucid::open_mgh_bytes(source, {});
  });
  return 0;
}
