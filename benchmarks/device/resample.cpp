// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/device/resample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "pellucid/scene/error.h"

namespace pellucid::bench {
namespace {

/// The two old values beside a new one, and the weight of the second.
struct Between {
  std::size_t first = 0, second = 0;
  double weight = 0;
};

std::vector<Between> along_axis(int old_points, int points) {
  std::vector<Between> list;
  for (int i = 0; i < points; ++i) {
    const double position = static_cast<double>(i) * (old_points - 1) / (points - 1);
    const int first = std::min(static_cast<int>(position), old_points - 2);
    list.push_back(
        {static_cast<std::size_t>(first), static_cast<std::size_t>(first) + 1, position - first});
  }
  return list;
}

double mix(double a, double b, double weight) {
  return (1 - weight) * a + weight * b;
}

template <class Value>
std::vector<Value> interpolated(const DataArray<Value>& old, const std::array<int, 3>& dimensions,
                                int points) {
  const std::vector<Between> x = along_axis(dimensions[0], points),
                             y = along_axis(dimensions[1], points),
                             z = along_axis(dimensions[2], points);
  const auto row = static_cast<std::size_t>(dimensions[0]),
             slice = row * static_cast<std::size_t>(dimensions[1]);
  std::vector<Value> values;
  values.reserve(x.size() * y.size() * z.size());
  for (const Between& k : z) {
    for (const Between& j : y) {
      const auto at = [&](std::size_t i, std::size_t column, std::size_t layer) {
        return static_cast<double>(old[layer * slice + column * row + i]);
      };
      const auto between_rows = [&](std::size_t i) {
        return mix(mix(at(i, j.first, k.first), at(i, j.second, k.first), j.weight),
                   mix(at(i, j.first, k.second), at(i, j.second, k.second), j.weight), k.weight);
      };
      for (const Between& i : x) {
        const double value = mix(between_rows(i.first), between_rows(i.second), i.weight);
        values.push_back(static_cast<Value>(std::is_integral_v<Value> ? std::round(value) : value));
      }
    }
  }
  return values;
}

}  // namespace

Volume resampled(const Volume& volume, int points) {
  Volume::Description d = volume.description();
  const auto has_axis = [](const std::vector<double>& axis) { return !axis.empty(); };
  if (d.centering != Centering::point || std::ranges::any_of(d.coordinates, has_axis) ||
      points < 2) {
    throw Error(d.name + ": only points of a uniform grid are resampled, to two or more");
  }
  const auto scale = [&](std::size_t axis) { return (d.dimensions[axis] - 1.0) / (points - 1); };
  d.placement.spacing.x *= scale(0);
  d.placement.spacing.y *= scale(1);
  d.placement.spacing.z *= scale(2);
  VolumeData data = std::visit(
      [&](const auto& values) { return VolumeData(interpolated(values, d.dimensions, points)); },
      volume.data());
  d.dimensions = {points, points, points};
  return Volume(std::move(d), std::move(data));
}

}  // namespace pellucid::bench
