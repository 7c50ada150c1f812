// SPDX-License-Identifier: Apache-2.0
#include "coarser_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace pellucid {

namespace {

/// Values along an axis that make one coarser value, and their weights, whose sum is 1.
struct Taps {
  int first = 0;
  std::vector<double> weights;
};
using AxisTaps = std::vector<Taps>;

/// Returns the integral from -∞ to x of the hat function, which is 1 at 0 and 0 from ±1 on.
double hat_integral(double x) {
  if (x <= -1) return 0;
  if (x >= 1) return 1;
  return x < 0 ? (x + 1) * (x + 1) / 2 : 1 - (1 - x) * (1 - x) / 2;
}

Taps single(int index) {
  return {index, {1.0}};
}

/// Returns taps over [begin, end] of indices. weight(i) is that of a value before all are scaled.
template <class Weight>
Taps taps_over(int first, int last, const Weight& weight) {
  Taps taps{first, {}};
  double sum = 0;
  for (int i = first; i <= last; ++i) sum += taps.weights.emplace_back(weight(i));
  for (double& each : taps.weights) each /= sum;
  return taps;
}

AxisTaps point_taps(int count) {
  const int coarse = count / 2 + 1;
  const double step = static_cast<double>(count - 1) / (coarse - 1);
  AxisTaps axis{single(0)};
  for (int i = 1; i + 1 < coarse; ++i) {
    const double begin = (i - 0.5) * step, end = (i + 0.5) * step;
    axis.push_back(taps_over(
        static_cast<int>(std::floor(begin)), std::min(static_cast<int>(std::ceil(end)), count - 1),
        [&](int j) { return hat_integral(end - j) - hat_integral(begin - j); }));
  }
  axis.push_back(single(count - 1));
  return axis;
}

AxisTaps cell_taps(int count) {
  const int coarse = (count + 1) / 2;
  const double step = static_cast<double>(count) / coarse;
  AxisTaps axis;
  for (int i = 0; i < coarse; ++i) {
    const double begin = i * step, end = (i + 1) * step;
    axis.push_back(taps_over(
        static_cast<int>(std::floor(begin)), std::min(static_cast<int>(std::ceil(end)), count) - 1,
        [&](int j) { return std::min(end, j + 1.0) - std::max(begin, double(j)); }));
  }
  return axis;
}

AxisTaps taps_of(int count, Centering centering) {
  if (count >= fewest_coarsened) {
    return centering == Centering::point ? point_taps(count) : cell_taps(count);
  }
  AxisTaps axis;
  for (int i = 0; i < count; ++i) axis.push_back(single(i));
  return axis;
}

template <class Value>
class Mean {
 public:
  void add(Value value, double weight) {
    if (std::isnan(static_cast<double>(value))) return;
    sum_ += weight * static_cast<double>(value);
    weights_ += weight;
  }
  Value take() const {
    // Where there is none values are floats.
    if (!(weights_ > 0)) return std::numeric_limits<Value>::quiet_NaN();
    const double mean = sum_ / weights_;
    return static_cast<Value>(std::is_integral_v<Value> ? std::round(mean) : mean);
  }

 private:
  double sum_ = 0, weights_ = 0;
};

template <class Value>
class MostCommon {
 public:
  void add(Value value, double weight) {
    for (auto& [known, sum] : sums_) {
      if (known == value) {
        sum += weight;
        return;
      }
    }
    sums_.emplace_back(value, weight);
  }
  /// Returns the least of those that are as common.
  Value take() const {
    const auto is_less = [](const auto& a, const auto& b) {
      return a.second != b.second ? a.second < b.second : a.first > b.first;
    };
    return std::max_element(sums_.begin(), sums_.end(), is_less)->first;
  }

 private:
  std::vector<std::pair<Value, double>> sums_;
};

template <template <class> class Merged, class Value>
VolumeData merged(const DataArray<Value>& values, const std::array<int, 3>& dimensions,
                  const std::array<AxisTaps, 3>& taps) {
  const auto [nx, ny] =
      std::pair(static_cast<std::size_t>(dimensions[0]), static_cast<std::size_t>(dimensions[1]));
  DataArray<Value> coarse(taps[0].size() * taps[1].size() * taps[2].size());
  const std::span<Value> out = coarse.writable();
  std::size_t at = 0;
  for (const Taps& z : taps[2]) {
    for (const Taps& y : taps[1]) {
      for (const Taps& x : taps[0]) {
        Merged<Value> all;
        for (std::size_t k = 0; k < z.weights.size(); ++k) {
          for (std::size_t j = 0; j < y.weights.size(); ++j) {
            const double weight = z.weights[k] * y.weights[j];
            const std::size_t row = ((static_cast<std::size_t>(z.first) + k) * ny +
                                     static_cast<std::size_t>(y.first) + j) *
                                        nx +
                                    static_cast<std::size_t>(x.first);
            for (std::size_t i = 0; i < x.weights.size(); ++i) {
              all.add(values[row + i], weight * x.weights[i]);
            }
          }
        }
        out[at++] = all.take();
      }
    }
  }
  return coarse;
}

/// Returns the grid of the coarser values.
Volume::Description coarser_grid(Volume::Description grid, const std::array<AxisTaps, 3>& taps) {
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const int fine = grid.dimensions[axis], coarse = static_cast<int>(taps[axis].size());
    if (fine == coarse) continue;
    grid.dimensions[axis] = coarse;
    std::vector<double>& coordinates = grid.coordinates[axis];
    if (!coordinates.empty()) {
      std::vector<double> kept;
      for (const Taps& each : taps[axis]) {
        double sum = 0;
        for (std::size_t i = 0; i < each.weights.size(); ++i) {
          sum += each.weights[i] * coordinates[static_cast<std::size_t>(each.first) + i];
        }
        kept.push_back(sum);
      }
      coordinates = std::move(kept);
      continue;
    }
    double& spacing = grid.placement.spacing[a];
    const bool is_point = grid.centering == Centering::point;
    const double factor = is_point ? (fine - 1.0) / (coarse - 1) : double(fine) / coarse;
    // The origin is the middle of the first cell.
    if (!is_point) {
      grid.placement.origin =
          grid.placement.origin + grid.placement.direction.column[static_cast<std::size_t>(a)] *
                                      (spacing * (factor - 1) / 2);
    }
    spacing *= factor;
  }
  return grid;
}

}  // namespace

std::shared_ptr<const Volume> coarser_volume(const Volume& volume, Merging merging) {
  const Volume::Description& grid = volume.description();
  const bool is_rectilinear =
      std::ranges::any_of(grid.coordinates, [](const auto& axis) { return !axis.empty(); });
  if (is_rectilinear && grid.centering == Centering::cell) return nullptr;
  std::array<AxisTaps, 3> taps;
  bool has_any = false;
  for (std::size_t a = 0; a < 3; ++a) {
    taps[a] = taps_of(grid.dimensions[a], grid.centering);
    has_any = has_any || std::ssize(taps[a]) < grid.dimensions[a];
  }
  if (!has_any) return nullptr;
  VolumeData data = std::visit(
      [&](const auto& values) {
        return merging == Merging::mean ? merged<Mean>(values, grid.dimensions, taps)
                                        : merged<MostCommon>(values, grid.dimensions, taps);
      },
      volume.data());
  return std::make_shared<const Volume>(coarser_grid(grid, taps), std::move(data));
}

}  // namespace pellucid
