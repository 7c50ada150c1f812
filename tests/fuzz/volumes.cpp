// SPDX-License-Identifier: Apache-2.0

// A parser of volumes, PELLUCID_READER: any bytes give volumes that hold them, or an Error of one
// line.

#include "read_volumes.h"
#include "src/io/mrc/mrc.h"
#include "src/io/nifti/mgh.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pellucid::fuzz::read_volumes(data, size, [](const pellucid::ByteSource& source) {
    return pellucid::PELLUCID_READER(source, {});
  });
  return 0;
}
