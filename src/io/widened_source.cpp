// SPDX-License-Identifier: Apache-2.0
#include "widened_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

namespace pellucid {

namespace {

/// IEEE 754 binary16.
float of_half(std::uint16_t bits) {
  const unsigned exponent = bits >> 10 & 31U, fraction = bits & 1023U;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const float size = exponent == 31  ? fraction == 0 ? infinity : std::nanf("")
                      : exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                     : std::ldexp(static_cast<float>(fraction + 1024),
                                                  static_cast<int>(exponent) - 25);
  return (bits & 0x8000U) != 0 ? -size : size;
}

struct Half {
  using Stored = std::uint16_t;
  static float widen(Stored bits) { return of_half(bits); }
};
template <class Number>
struct Whole {
  using Stored = Number;
  static double widen(Stored number) { return static_cast<double>(number); }
};

/// Reads `to.size()` bytes of widened values, which begin at byte `from` of all of them.
template <class Kind>
void read_widened(const ByteSource& source, const ValueLayout& layout, std::uintmax_t from,
                  std::span<std::byte> to) {
  using Stored = typename Kind::Stored;
  using Wide = decltype(Kind::widen(Stored{}));
  constexpr std::size_t at_once = std::size_t{1} << 14;
  const bool swapped = layout.big_endian == (std::endian::native == std::endian::little);
  std::vector<std::byte> part;
  std::uintmax_t next = layout.offset + from / sizeof(Wide) * sizeof(Stored);
  while (!to.empty()) {
    const std::size_t count = std::min(at_once, to.size() / sizeof(Wide));
    part.resize(count * sizeof(Stored));
    source.read(next, part);
    for (std::size_t i = 0; i < count; ++i) {
      std::array<std::byte, sizeof(Stored)> raw;
      std::copy_n(&part[i * sizeof(Stored)], sizeof(Stored), raw.begin());
      if (swapped) std::ranges::reverse(raw);
      const Wide value = Kind::widen(std::bit_cast<Stored>(raw));
      std::memcpy(&to[i * sizeof(Wide)], &value, sizeof(Wide));
    }
    to = to.subspan(count * sizeof(Wide));
    next += part.size();
  }
}

struct Widening {
  const char* stored;
  const char* kept;
  std::size_t bytes;
  void (*read)(const ByteSource&, const ValueLayout&, std::uintmax_t, std::span<std::byte>);
};
constexpr std::array widenings{Widening{"f16", "f32", 2, read_widened<Half>},
                               Widening{"i64", "f64", 8, read_widened<Whole<std::int64_t>>},
                               Widening{"u64", "f64", 8, read_widened<Whole<std::uint64_t>>}};

const Widening* widening_of(const std::string& stored) {
  const auto found = std::ranges::find(widenings, stored, &Widening::stored);
  return found == widenings.end() ? nullptr : &*found;
}

}  // namespace

std::optional<std::string> widened_type(const std::string& stored) {
  const Widening* const widening = widening_of(stored);
  return widening == nullptr ? std::nullopt : std::optional<std::string>(widening->kept);
}

ByteSource widened_source(const ByteSource& source, const ValueLayout& layout, std::size_t count) {
  const Widening& widening = *widening_of(layout.type);
  check_bytes(source, layout.offset, std::uintmax_t{count} * widening.bytes);
  const std::uintmax_t wide = std::uintmax_t{count} * value_size(widening.kept, source.name);
  return {source.name,
          wide,
          [source, layout, read = widening.read](std::uintmax_t from, std::span<std::byte> to) {
            read(source, layout, from, to);
          },
          {}};
}

}  // namespace pellucid
