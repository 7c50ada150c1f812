// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <string_view>

namespace pellucid {

/// Returns the name of a value of an enumeration, whose names are in the order of its values.
template <class Enum>
std::string_view name_of(std::span<const char* const> names, Enum value) noexcept {
  const auto index = static_cast<std::size_t>(value);
  return index < names.size() ? names[index] : "unknown";
}
/// Returns the value of this name, or none.
template <class Enum>
std::optional<Enum> value_of(std::span<const char* const> names, std::string_view name) noexcept {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(std::distance(names.begin(), found));
}

}  // namespace pellucid
