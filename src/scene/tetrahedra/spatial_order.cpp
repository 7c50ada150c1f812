// SPDX-License-Identifier: Apache-2.0
#include "spatial_order.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace pellucid {
namespace {

constexpr int bits_of_axis = 21;

/// Returns the bits of a number of 21, each with two empty ones in front of it.
std::uint64_t spread(std::uint64_t x) noexcept {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

}  // namespace

MortonCurve::MortonCurve(const Box<double>& box) noexcept : lower_(box.lower) {
  double longest = 0;
  for (int a = 0; a < 3; ++a) longest = std::max(longest, box.upper[a] - box.lower[a]);
  if (longest > 0 && std::isfinite(longest)) steps_ = std::exp2(bits_of_axis) / longest;
}

std::uint64_t MortonCurve::operator()(const Vec3<double>& place) const noexcept {
  constexpr double last = (1 << bits_of_axis) - 1;
  std::uint64_t code = 0;
  for (int a = 0; a < 3; ++a) {
    const double step = (place[a] - lower_[a]) * steps_;
    if (!std::isfinite(step)) return std::numeric_limits<std::uint64_t>::max();
    code |= spread(static_cast<std::uint64_t>(std::clamp(step, 0.0, last))) << a;
  }
  return code;
}

std::vector<std::int32_t> in_order(std::vector<std::uint64_t> keys, const ParallelFor& parallel) {
  using Entry = std::pair<std::uint64_t, std::int32_t>;
  std::vector<Entry> entries(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i)
    entries[i] = {keys[i], static_cast<std::int32_t>(i)};
  keys = {};
  // Parts are sorted by themselves, then two by two put together.
  constexpr std::size_t parts = 16;
  const auto begin = [&](std::size_t part) {
    return entries.begin() + static_cast<std::ptrdiff_t>(entries.size() * part / parts);
  };
  const auto each = [&](std::size_t width, auto&& body) {
    parallel(static_cast<int>(parts / width), [&](int first, int last) {
      for (int i = first; i < last; ++i) body(static_cast<std::size_t>(i) * width);
    });
  };
  each(1, [&](std::size_t part) { std::sort(begin(part), begin(part + 1)); });
  for (std::size_t width = 2; width <= parts; width *= 2) {
    each(width, [&](std::size_t part) {
      std::inplace_merge(begin(part), begin(part + width / 2), begin(part + width));
    });
  }
  std::vector<std::int32_t> order(entries.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = entries[i].second;
  return order;
}

}  // namespace pellucid
