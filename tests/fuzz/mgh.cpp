// SPDX-License-Identifier: Apache-2.0

// The parser of FreeSurfer's MGH: any bytes give volumes that hold them, or an Error of one line.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>
#include <vector>

#include "pellucid/scene/error.h"
#include "src/io/medical_volumes.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  try {
    const pellucid::VolumeFile file =
        pellucid::open_mgh_bytes(pellucid::memory_source(bytes, "fuzz"), {});
    for (const pellucid::Volume& volume : pellucid::read_all(file, {})) {
      std::size_t count = 1;
      for (const int side : volume.description().dimensions) {
        require(side >= 1);
        count *= static_cast<std::size_t>(side);
      }
      const pellucid::VolumeStatistics& statistics = volume.statistics();
      require(count < size && statistics.finite + statistics.nan == count);
    }
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz") && message.size() < 1000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
  return 0;
}
