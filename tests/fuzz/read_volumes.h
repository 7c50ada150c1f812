// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string_view>

#include "pellucid/scene/error.h"
#include "src/io/volumes/components.h"
#include "src/io/volumes/volume_source.h"

namespace pellucid::fuzz {

/// Ends the program, which the fuzzer reports, unless the condition holds.
inline void require(bool condition) {
  if (!condition) std::abort();
}

/// Reads all volumes of a format without compression that `open` finds in any bytes, and requires
/// that they hold what is in them, or that there is an Error of one line.
template <class Open>
void read_volumes(const std::uint8_t* data, std::size_t size, const Open& open) {
  const std::span bytes(reinterpret_cast<const std::byte*>(data), size);
  try {
    const VolumeFile file = open(memory_source(bytes, "fuzz"));
    for (const Volume& volume : read_all(file, {})) {
      std::size_t count = 1;
      for (const int side : volume.description().dimensions) {
        require(side >= 1);
        count *= static_cast<std::size_t>(side);
      }
      const VolumeStatistics& statistics = volume.statistics();
      require(count < size && statistics.finite + statistics.nan == count);
    }
  } catch (const Error& error) {
    const std::string_view message = error.what();
    require(message.starts_with("fuzz") && message.size() < 1000);
    for (const char c : message) require(static_cast<unsigned char>(c) >= 0x20);
  }
}

}  // namespace pellucid::fuzz
