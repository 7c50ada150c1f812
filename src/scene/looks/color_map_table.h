// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace pellucid {

/// A color map as it is stored: of each point its position times 2040, and the sRGB signals of red,
/// green and blue times 2550.
struct NamedColorMap {
  std::string_view name;
  std::span<const std::uint16_t> numbers;
};

std::span<const NamedColorMap> color_map_table() noexcept;

}  // namespace pellucid
