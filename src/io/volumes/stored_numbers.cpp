// SPDX-License-Identifier: Apache-2.0
#include "stored_numbers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace pellucid {

namespace {

struct WholeType {
  const char* name;
  std::size_t bytes;
  std::int64_t least;
  std::uint64_t largest;
};

template <class Value>
constexpr WholeType whole_type(const char* name) {
  return {name, sizeof(Value), std::numeric_limits<Value>::lowest(),
          static_cast<std::uint64_t>(std::numeric_limits<Value>::max())};
}

constexpr std::array whole_types{whole_type<std::uint8_t>("u8"),   whole_type<std::int8_t>("i8"),
                                 whole_type<std::uint16_t>("u16"), whole_type<std::int16_t>("i16"),
                                 whole_type<std::uint32_t>("u32"), whole_type<std::int32_t>("i32")};

const char* type_for(std::int64_t least, std::uint64_t largest) {
  for (const WholeType& type : whole_types) {
    if (least >= type.least && largest <= type.largest) return type.name;
  }
  return "f64";
}

/// Returns the difference between a number of this size and the double next to it.
std::uint64_t rounded_by(std::uint64_t size) {
  constexpr std::uint64_t exact = std::uint64_t{1} << 53;
  if (size <= exact) return 0;
  const double rounded = static_cast<double>(size);
  // 2^64 is no number of 64 bits; the difference to it is.
  const std::uint64_t back = rounded >= 0x1p64 ? 0 : static_cast<std::uint64_t>(rounded);
  return std::min(back - size, size - back);
}

/// Works for the smallest number as well, whose negative is none.
std::uint64_t size_of(std::int64_t number) {
  const auto bits = static_cast<std::uint64_t>(number);
  return number < 0 ? 0 - bits : bits;
}
std::uint64_t size_of(std::uint64_t number) {
  return number;
}

}  // namespace

bool is_stored_only(std::string_view type) noexcept {
  return type == "f16" || type == "i64" || type == "u64";
}

std::optional<std::string> whole_type_for(double lowest, double highest, std::size_t least_bytes) {
  for (const WholeType& type : whole_types) {
    if (type.bytes >= least_bytes && lowest >= static_cast<double>(type.least) &&
        highest <= static_cast<double>(type.largest)) {
      return type.name;
    }
  }
  return std::nullopt;
}

void Rounding::merge(const Rounding& other) noexcept {
  count += other.count;
  largest = std::max(largest, other.largest);
}

std::string Rounding::text(std::size_t of) const {
  const bool one = count == 1;
  return std::to_string(count) + " of " + std::to_string(of) + " whole numbers of 64 bits " +
         (one ? "does" : "do") + " not fit double and " + (one ? "is" : "are") +
         " rounded, by at most " + std::to_string(largest);
}

WholeNumbers::WholeNumbers(MakeValues make) : make_(std::move(make)), values_(make_(type_)) {}

void WholeNumbers::hold(std::int64_t least, std::uint64_t largest) {
  least_ = std::min(least_, least);
  largest_ = std::max(largest_, largest);
  const std::string type = type_for(least_, largest_);
  if (type == type_) return;
  VolumeData wider = make_(type);
  std::visit(
      [&](auto& to, const auto& from) {
        using Value = typename std::decay_t<decltype(to)>::value_type;
        const std::span<Value> values = to.writable();
        for (std::size_t i = 0; i < done_; ++i) values[i] = static_cast<Value>(from[i]);
      },
      wider, values_);
  values_ = std::move(wider);
  type_ = type;
}

template <class Number>
void WholeNumbers::add_any(std::span<const Number> numbers) {
  if (numbers.empty()) return;
  const auto [least, largest] = std::ranges::minmax_element(numbers);
  hold(std::in_range<std::int64_t>(*least) ? static_cast<std::int64_t>(*least) : 0,
       std::in_range<std::uint64_t>(*largest) ? static_cast<std::uint64_t>(*largest) : 0);
  std::visit(
      [&](auto& values) {
        using Value = typename std::decay_t<decltype(values)>::value_type;
        const std::span<Value> to = values.writable().subspan(done_, numbers.size());
        std::ranges::transform(numbers, to.begin(),
                               [](Number number) { return static_cast<Value>(number); });
      },
      values_);
  done_ += numbers.size();
  if (type_ != "f64") return;
  for (const Number number : numbers) {
    if (const std::uint64_t by = rounded_by(size_of(number)); by > 0) rounding_.merge({1, by});
  }
}

void WholeNumbers::add(std::span<const Signed> numbers) {
  add_any(numbers);
}

void WholeNumbers::add(std::span<const Unsigned> numbers) {
  add_any(numbers);
}

void WholeNumbers::widen_for(const WholeNumbers& other) {
  hold(other.least_, other.largest_);
}

void unify(std::span<WholeNumbers> components) {
  for (WholeNumbers& component : components) {
    for (const WholeNumbers& other : components) component.widen_for(other);
  }
}

float half_to_float(std::uint16_t bits) noexcept {
  const unsigned exponent = bits >> 10 & 31U, fraction = bits & 1023U;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const float size = exponent == 31  ? fraction == 0 ? infinity : std::nanf("")
                      : exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                     : std::ldexp(static_cast<float>(fraction + 1024),
                                                  static_cast<int>(exponent) - 25);
  return (bits & 0x8000U) != 0 ? -size : size;
}

}  // namespace pellucid
