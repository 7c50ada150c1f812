// SPDX-License-Identifier: Apache-2.0

// The reader of .npz, a zip archive of .npy: any bytes give a volume, or an Error of one line.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "pellucid/io/internal/parse_arrays.h"
#include "pellucid/scene/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = std::byte{data[i]};
  try {
    const pellucid::Volume volume = pellucid::parse_npz(bytes, "fuzz");
    std::size_t count = 1;
    for (const int side : volume.description().dimensions) {
      require(side >= 1);
      count *= static_cast<std::size_t>(side);
    }
    // Deflate makes at most 1032 bytes of one.
    require(count <= 1032 * size);
    const pellucid::VolumeStatistics& statistics = volume.statistics();
    require(statistics.finite + statistics.nan == count && statistics.infinite == 0);
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz: ") && message.size() < 10000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
  return 0;
}
