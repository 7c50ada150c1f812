// SPDX-License-Identifier: Apache-2.0
#include "mixture_cells.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// The lattice over the range of some points: which box holds a point.
class Lattice {
 public:
  Lattice(const MixtureCells& points, std::size_t parts)
      : parts_(parts), lower_(points.dimensions, 0.0), scale_(points.dimensions, 0.0) {
    const std::size_t n = points.dimensions;
    for (std::size_t k = 0; k < n; ++k) {
      double upper = points.mean[k];
      lower_[k] = points.mean[k];
      for (std::size_t i = 0; i < points.count(); ++i) {
        lower_[k] = std::min(lower_[k], points.mean[i * n + k]);
        upper = std::max(upper, points.mean[i * n + k]);
      }
      // The range is halved, as that of all doubles is none.
      const double half = upper / 2 - lower_[k] / 2;
      if (half > 0) scale_[k] = static_cast<double>(parts) / 2 / half;
    }
  }

  std::size_t box(const double* x) const {
    std::size_t box = 0;
    for (std::size_t k = lower_.size(); k-- > 0;) {
      const double place = (x[k] - lower_[k]) * scale_[k];
      const double last = static_cast<double>(parts_ - 1);
      box = box * parts_ + static_cast<std::size_t>(std::clamp(place, 0.0, last));
    }
    return box;
  }
  std::size_t boxes() const {
    std::size_t all = 1;
    for (std::size_t k = 0; k < lower_.size(); ++k) all *= parts_;
    return all;
  }

 private:
  std::size_t parts_;
  std::vector<double> lower_, scale_;
};

}  // namespace

MixtureCells cells_of(const WeightedPoints& points) {
  MixtureCells cells;
  cells.dimensions = static_cast<std::size_t>(points.dimensions);
  for (std::size_t i = 0; i < points.count(); ++i) {
    if (!(points.weights[i] > 0)) continue;
    const double* const x = &points.coordinates[i * cells.dimensions];
    cells.weight.push_back(points.weights[i]);
    cells.mean.insert(cells.mean.end(), x, x + cells.dimensions);
  }
  return cells;
}

MixtureCells merged_cells(const MixtureCells& points, std::size_t most) {
  const std::size_t n = points.dimensions, t = triangle_size(n);
  constexpr std::size_t fewest_parts = 4;
  const auto parts = static_cast<std::size_t>(
      std::pow(static_cast<double>(most), 1 / static_cast<double>(n)) * (1 + 1e-12));
  if (points.count() <= most || parts < fewest_parts) return points;
  const Lattice lattice(points, parts);
  constexpr std::size_t none = ~std::size_t{0};
  std::vector<std::size_t> cell_of(lattice.boxes(), none), cell(points.count());
  MixtureCells merged;
  merged.dimensions = n;
  for (std::size_t i = 0; i < points.count(); ++i) {
    const double* const x = &points.mean[i * n];
    std::size_t& at = cell_of[lattice.box(x)];
    if (at == none) {
      at = merged.count();
      merged.weight.push_back(0);
      merged.mean.insert(merged.mean.end(), n, 0.0);
    }
    cell[i] = at;
    merged.weight[at] += points.weight[i];
  }
  for (std::size_t i = 0; i < points.count(); ++i) {
    const double share = points.weight[i] / merged.weight[cell[i]];
    for (std::size_t k = 0; k < n; ++k)
      merged.mean[cell[i] * n + k] += share * points.mean[i * n + k];
  }
  merged.covariance.assign(merged.count() * t, 0.0);
  for (std::size_t i = 0; i < points.count(); ++i) {
    const double share = points.weight[i] / merged.weight[cell[i]];
    const double* const x = &points.mean[i * n];
    const double* const mean = &merged.mean[cell[i] * n];
    double* entry = &merged.covariance[cell[i] * t];
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k <= j; ++k) *entry++ += share * (x[j] - mean[j]) * (x[k] - mean[k]);
    }
  }
  return merged;
}

}  // namespace pellucid
