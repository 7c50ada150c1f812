// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "pellucid/scene/volume.h"

namespace pellucid {

// Kernels run in float too; sums of the eight corners of a cell must not overflow there.
inline constexpr double largest_value = static_cast<double>(std::numeric_limits<float>::max()) / 16;

struct VolumeScan {
  VolumeStatistics statistics;
  std::size_t first_infinite = 0, first_large = 0;
  bool large = false;  ///< a finite value is beyond largest_value
};

/// Scans value by value, for volumes that are refused: which one is to blame.
template <class Value>
VolumeScan scan_each(std::span<const Value> values) {
  VolumeScan s;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto v = static_cast<double>(values[i]);
    if (std::isfinite(v)) {
      ++s.statistics.finite;
      if (!s.large && std::abs(v) > largest_value) {
        s.large = true;
        s.first_large = i;
      }
    } else if (v != v) {
      ++s.statistics.nan;
    } else if (s.statistics.infinite++ == 0) {
      s.first_infinite = i;
    }
  }
  return s;
}

/// Scans in one pass, several values at a time.
template <class Value>
VolumeScan scan(std::span<const Value> values) {
  // Independent lanes, which the compiler turns into vectors.
  constexpr std::size_t lanes = 32 / sizeof(Value);
  std::array<Value, lanes> low, high;
  low.fill(std::numeric_limits<Value>::max());
  high.fill(std::numeric_limits<Value>::lowest());
  std::size_t nan = 0;
  const auto take = [&](std::span<const Value> row) {
    for (std::size_t l = 0; l < row.size(); ++l) {
      const Value v = row[l];
      low[l] = v < low[l] ? v : low[l];  // never a NaN
      high[l] = v > high[l] ? v : high[l];
      if constexpr (std::is_floating_point_v<Value>) nan += v != v ? 1 : 0;
    }
  };
  std::size_t first = 0;
  for (; first + lanes <= values.size(); first += lanes) {
    take(values.subspan(first).template first<lanes>());
  }
  take(values.subspan(first));

  // Adding zero makes -0 a 0, which of the two comes first.
  const auto lowest = static_cast<double>(*std::ranges::min_element(low)) + 0.0;
  const auto highest = static_cast<double>(*std::ranges::max_element(high)) + 0.0;
  if (lowest < -largest_value || highest > largest_value) {
    const VolumeScan each = scan_each(values);
    if (each.large || each.statistics.infinite > 0) return each;
  }
  VolumeScan s;
  s.statistics.nan = nan;
  s.statistics.finite = values.size() - nan;
  if (s.statistics.finite > 0) {
    s.statistics.minimum = lowest;
    s.statistics.maximum = highest;
  }
  return s;
}

/// Counts each number of a type of at most 16 bits, from its least upwards.
template <class Value>
std::vector<std::uint64_t> count_values(std::span<const Value> values) {
  static_assert(std::is_integral_v<Value> && sizeof(Value) <= 2);
  constexpr std::size_t numbers = std::size_t{1} << (8 * sizeof(Value));
  constexpr int least = std::numeric_limits<Value>::min();
  // Equal values tend to stand together; turns keep one count from waiting for the last.
  constexpr std::size_t turns = 4;
  std::vector<std::uint64_t> count(numbers * turns);
  for (std::size_t i = 0; i < values.size(); ++i) {
    ++count[static_cast<std::size_t>(values[i] - least) + numbers * (i % turns)];
  }
  for (std::size_t n = 0; n < numbers; ++n) {
    for (std::size_t t = 1; t < turns; ++t) count[n] += count[n + numbers * t];
  }
  count.resize(numbers);
  return count;
}

/// Adds to the bin of a finite value, of bins between h.lower and h.upper.
inline void add_to_bin(Histogram& h, double x, std::uint64_t times) {
  const auto bins = static_cast<double>(h.count.size());
  // Also for a constant volume: its one value is the upper end.
  const double position = x < h.upper ? (x - h.lower) / (h.upper - h.lower) * bins : bins;
  h.count[std::min(static_cast<std::size_t>(position), h.count.size() - 1)] += times;
}

template <class Value>
void fill_histogram(std::span<const Value> values, Histogram& h) {
  if constexpr (std::is_integral_v<Value> && sizeof(Value) <= 2) {
    constexpr int least = std::numeric_limits<Value>::min();
    const std::vector<std::uint64_t> count = count_values(values);
    for (std::size_t n = 0; n < count.size(); ++n) {
      if (count[n] > 0) add_to_bin(h, static_cast<double>(n) + least, count[n]);
    }
  } else {
    for (const Value v : values) {
      if (v == v) add_to_bin(h, static_cast<double>(v), 1);
    }
  }
}

}  // namespace pellucid
