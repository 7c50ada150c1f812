// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace pellucid {

/// Checksum that is compared in place of data that are too long to be sent or shown (FNV-1a).
class Checksum {
 public:
  void add(std::string_view text) {
    for (const char c : text) mix(static_cast<unsigned char>(c));
  }
  void add(double number) { mix(std::bit_cast<std::uint64_t>(number)); }
  std::uint64_t value() const noexcept { return sum_; }

 private:
  void mix(std::uint64_t bits) { sum_ = (sum_ ^ bits) * 1099511628211u; }

  std::uint64_t sum_ = 14695981039346656037u;
};

}  // namespace pellucid
