// SPDX-License-Identifier: Apache-2.0
#include "whole_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

#include "volume_source.h"

namespace pellucid {

namespace {

struct WholeType {
  const char* name;
  std::int64_t least;
  std::uint64_t largest;
};

template <class Value>
constexpr WholeType whole_type(const char* name) {
  return {name, std::numeric_limits<Value>::lowest(),
          static_cast<std::uint64_t>(std::numeric_limits<Value>::max())};
}

constexpr std::array whole_types{whole_type<std::uint8_t>("u8"),   whole_type<std::int8_t>("i8"),
                                 whole_type<std::uint16_t>("u16"), whole_type<std::int16_t>("i16"),
                                 whole_type<std::uint32_t>("u32"), whole_type<std::int32_t>("i32")};

template <class Number>
bool is_exact(Number number) {
  constexpr auto largest = Number{1} << 53;
  const auto size =
      std::is_signed_v<Number> && number < 0 ? static_cast<Number>(-(number + 1)) : number;
  if (size < largest) return true;
  // Beyond, those that double holds are the ones whose lowest bits are 0.
  const double rounded = static_cast<double>(number);
  constexpr double end = std::is_signed_v<Number> ? 0x1p63 : 0x1p64;
  return rounded < end && static_cast<Number>(rounded) == number;
}

template <class Number>
std::vector<VolumeData> kept(const std::vector<std::span<const Number>>& lists,
                             const std::string& name,
                             const std::function<void(const std::string&)>& note) {
  std::int64_t least = 0;
  std::uint64_t largest = 0;
  for (const std::span<const Number> list : lists) {
    for (const Number number : list) {
      if (std::cmp_less(number, least)) least = static_cast<std::int64_t>(number);
      if (std::cmp_greater(number, largest)) largest = static_cast<std::uint64_t>(number);
    }
  }
  const auto type = std::ranges::find_if(whole_types, [&](const WholeType& candidate) {
    return least >= candidate.least && largest <= candidate.largest;
  });
  const std::string type_name = type == whole_types.end() ? "f64" : type->name;
  std::vector<VolumeData> all;
  std::size_t rounded = 0, count = 0;
  for (const std::span<const Number> list : lists) {
    VolumeData data = make_values(type_name, list.size(), name);
    std::visit(
        [&](auto& values) {
          using Value = typename std::decay_t<decltype(values)>::value_type;
          std::ranges::transform(list, values.writable().begin(),
                                 [](Number number) { return static_cast<Value>(number); });
        },
        data);
    all.push_back(std::move(data));
    if (type != whole_types.end()) continue;
    count += list.size();
    rounded += static_cast<std::size_t>(
        std::ranges::count_if(list, [](Number number) { return !is_exact(number); }));
  }
  if (rounded > 0 && note) {
    note(name + ": " + std::to_string(rounded) + " of " + std::to_string(count) +
         " whole numbers of 64 bits do not fit double and are rounded");
  }
  return all;
}

}  // namespace

std::vector<VolumeData> kept_whole_numbers(const std::vector<std::span<const std::int64_t>>& lists,
                                           const std::string& name,
                                           const std::function<void(const std::string&)>& note) {
  return kept(lists, name, note);
}

std::vector<VolumeData> kept_whole_numbers(const std::vector<std::span<const std::uint64_t>>& lists,
                                           const std::string& name,
                                           const std::function<void(const std::string&)>& note) {
  return kept(lists, name, note);
}

float float_of_half(std::uint16_t bits) noexcept {
  const unsigned exponent = bits >> 10 & 31U, fraction = bits & 1023U;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const float size = exponent == 31  ? fraction == 0 ? infinity : std::nanf("")
                      : exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                     : std::ldexp(static_cast<float>(fraction + 1024),
                                                  static_cast<int>(exponent) - 25);
  return (bits & 0x8000U) != 0 ? -size : size;
}

}  // namespace pellucid
