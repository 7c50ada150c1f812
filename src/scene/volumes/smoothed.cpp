// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "derived_volume.h"
#include "message.h"
#include "pellucid/scene/derived_channels.h"

namespace pellucid {
namespace {

/// Distance at which the Gaussian is cut, in standard deviations.
constexpr double cut = 4;
/// The largest standard deviation, in data values.
constexpr double largest_sigma = 16384;

/// The weights of a Gaussian along one axis, whose border values are repeated.
class AxisWeights {
 public:
  /// Computes the weights. `sigma` in data values; `values` of them along the axis.
  AxisWeights(double sigma, int values) : reach_(static_cast<int>(cut * sigma)), last_(values - 1) {
    double sum = 0;
    for (int d = -reach_; d <= reach_; ++d) {
      weight_.push_back(std::exp(-(d / sigma) * (d / sigma) / 2));
      sum += weight_.back();
    }
    sum_before_.push_back(0);
    for (double& w : weight_) {
      w /= sum;
      sum_before_.push_back(sum_before_.back() + w);
    }
  }

  /// Returns the values that count for value i.
  int first(int i) const noexcept { return std::max(i - reach_, 0); }
  int last(int i) const noexcept { return std::min(i + reach_, last_); }
  /// Returns the weight of value j, one of these, in the sum for value i.
  double operator()(int i, int j) const noexcept {
    const int at = j - i + reach_, mirrored = i - j + reach_;
    double w = weight_[static_cast<std::size_t>(at)];
    if (j == 0) w += sum_before_[static_cast<std::size_t>(at)];
    // The weights are symmetric.
    if (j == last_) w += sum_before_[static_cast<std::size_t>(mirrored)];
    return w;
  }

 private:
  int reach_, last_;
  std::vector<double> weight_, sum_before_;
};

/// The sums for the values of one slice across z, axis by axis.
class SliceSums {
 public:
  SliceSums(int nx, int ny)
      : nx_(static_cast<std::size_t>(nx)),
        ny_(ny),
        sum_(nx_ * static_cast<std::size_t>(ny)),
        last_(sum_.size()) {}

  /// Sums up count(value), for slice k.
  template <class Value, class Count>
  void make(const StructuredGrid<Value, double>& grid, const std::array<AxisWeights, 3>& weights,
            int k, const Count& count) {
    std::fill(sum_.begin(), sum_.end(), 0.0);
    for (int z = weights[2].first(k); z <= weights[2].last(k); ++z) {
      const double w = weights[2](k, z);
      const Value* const slice = grid.data + grid.offset(0, 0, z);
      for (std::size_t i = 0; i < sum_.size(); ++i) sum_[i] += w * count(slice[i]);
    }
    along_y(weights[1]);
    along_x(weights[0]);
  }

  double operator()(std::size_t i, std::size_t j) const noexcept { return sum_[i + nx_ * j]; }

 private:
  void along_y(const AxisWeights& weights) {
    sum_.swap(last_);
    std::fill(sum_.begin(), sum_.end(), 0.0);
    for (int j = 0; j < ny_; ++j) {
      double* const to = sum_.data() + nx_ * static_cast<std::size_t>(j);
      for (int y = weights.first(j); y <= weights.last(j); ++y) {
        const double* const from = last_.data() + nx_ * static_cast<std::size_t>(y);
        const double w = weights(j, y);
        for (std::size_t i = 0; i < nx_; ++i) to[i] += w * from[i];
      }
    }
  }

  void along_x(const AxisWeights& weights) {
    sum_.swap(last_);
    std::fill(sum_.begin(), sum_.end(), 0.0);
    const int nx = static_cast<int>(nx_);
    // Between these, the sum of a value reaches no border, and all have the same weights.
    const int begin = weights.last(0), end = std::max(begin, weights.first(nx - 1) + 1);
    for (int j = 0; j < ny_; ++j) {
      double* const to = sum_.data() + nx_ * static_cast<std::size_t>(j);
      const double* const from = last_.data() + nx_ * static_cast<std::size_t>(j);
      const auto near_border = [&](int i) {
        for (int x = weights.first(i); x <= weights.last(i); ++x) to[i] += weights(i, x) * from[x];
      };
      for (int i = 0; i < begin; ++i) near_border(i);
      for (int i = end; i < nx; ++i) near_border(i);
      for (int x = 0; x <= 2 * begin && begin < end; ++x) {
        const double w = weights(begin, x);
        for (int i = begin; i < end; ++i) to[i] += w * from[i + x - begin];
      }
    }
  }

  std::size_t nx_;
  int ny_;
  std::vector<double> sum_, last_;
};

/// Returns the standard deviation along each axis in data values. Throws Error where there is none.
std::array<AxisWeights, 3> make_weights(const Volume& volume, double sigma) {
  const std::string name = volume_name(volume) + ": cannot be smoothed: ";
  if (!(sigma > 0 && std::isfinite(sigma))) {
    throw Error(name + "sigma is " + number(sigma) + ", but must be a positive number");
  }
  const auto along = [&](std::size_t a) {
    if (!volume.description().coordinates[a].empty()) {
      throw Error(name + "the grid is rectilinear along " + axis_names[a] +
                  ", and only uniform ones are smoothed; resample it to a uniform grid");
    }
    const Vec3<double>& edge = volume.world_from_grid().matrix.column[static_cast<int>(a)];
    const double values = sigma / std::hypot(edge.x, edge.y, edge.z);
    if (!(values <= largest_sigma)) {
      throw Error(name + "sigma is " + number(sigma) + ", which is " + number(values) +
                  " times the spacing along " + axis_names[a] + ", but must be at most " +
                  number(largest_sigma) + " times; take a smaller one");
    }
    return AxisWeights(values, volume.description().dimensions[a]);
  };
  return {along(0), along(1), along(2)};
}

}  // namespace

Volume smoothed(const Volume& volume, double sigma, const ParallelFor& parallel) {
  const std::array<AxisWeights, 3> weights = make_weights(volume, sigma);
  DerivedVolume derived(volume, volume_name(volume) + " smoothed by " + number(sigma));
  const bool has_gaps = volume.statistics().nan > 0;
  volume.visit([&](const auto& grid) {
    using Value = std::decay_t<decltype(*grid.data)>;
    const int nx = grid.axis[0].values, ny = grid.axis[1].values;
    const auto rows = static_cast<std::size_t>(ny);
    derived.each_rows(parallel, [&](std::size_t first, std::size_t last) {
      // A slice is done by who has its first row.
      const std::size_t begin = (first + rows - 1) / rows, end = (last + rows - 1) / rows;
      if (begin == end) return;
      SliceSums sums(nx, ny), shares(has_gaps ? nx : 0, has_gaps ? ny : 0);
      for (std::size_t k = begin; k < end; ++k) {
        const int slice = static_cast<int>(k);
        sums.make(grid, weights, slice,
                  [](Value v) { return v == v ? static_cast<double>(v) : 0.0; });
        if (has_gaps) {
          shares.make(grid, weights, slice, [](Value v) { return v == v ? 1.0 : 0.0; });
        }
        const Value* value = grid.data + grid.offset(0, 0, slice);
        for (std::size_t j = 0; j < rows; ++j) {
          for (std::size_t i = 0; float& out : derived.row(k * rows + j)) {
            if (!has_gaps) {
              out = static_cast<float>(sums(i, j));
            } else if (const Value v = *value++; v == v) {
              out = static_cast<float>(sums(i, j) / shares(i, j));
            } else {
              out = std::numeric_limits<float>::quiet_NaN();
            }
            ++i;
          }
        }
      }
    });
  });
  return derived.finish();
}

}  // namespace pellucid
