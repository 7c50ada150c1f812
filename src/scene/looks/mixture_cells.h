// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "pellucid/scene/internal/mixture_fit.h"

namespace pellucid {

/// Groups of points that share their memberships in a fit (Verbeek, Nunnink and Vlassis 2006,
/// "Accelerated EM-based clustering of large data sets").
struct MixtureCells {
  std::size_t dimensions = 1;
  std::vector<double> weight;  ///< > 0
  std::vector<double> mean;    ///< `dimensions` numbers per cell
  /// Covariance of the points of each cell: lower triangles, row by row. Empty: each cell is one
  /// point.
  std::vector<double> covariance;

  std::size_t count() const noexcept { return weight.size(); }
};

/// Returns the number of entries of the lower triangle of a matrix.
constexpr std::size_t triangle_size(std::size_t dimensions) noexcept {
  return dimensions * (dimensions + 1) / 2;
}

/// Returns each point of positive weight as a cell.
MixtureCells cells_of(const WeightedPoints& points);

/// Merges cells of single points that share a box of a lattice with at most `most` boxes over the
/// points' range. Returns the cells as they are if there are no more than `most`, or if they have
/// too many dimensions for a lattice of four boxes along each axis.
MixtureCells merged_cells(const MixtureCells& points, std::size_t most);

}  // namespace pellucid
