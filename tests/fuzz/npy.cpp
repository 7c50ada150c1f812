// SPDX-License-Identifier: Apache-2.0

// The parser of .npy: any bytes give a volume that holds them, or an Error of one line.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <variant>
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
    const pellucid::Volume volume = pellucid::parse_npy(bytes, "fuzz");
    std::size_t count = 1;
    for (const int side : volume.description().dimensions) {
      require(side >= 1);
      count *= static_cast<std::size_t>(side);
    }
    const std::size_t held = std::visit(
        [](const auto& values) { return values.size() * sizeof(values[0]); }, volume.data());
    // Half floats become floats.
    require(held < 2 * size && held % count == 0);
    const pellucid::VolumeStatistics& statistics = volume.statistics();
    require(statistics.finite + statistics.nan == count && statistics.infinite == 0);
  } catch (const pellucid::Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz: ") && message.size() < 1000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
  return 0;
}
