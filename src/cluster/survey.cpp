// SPDX-License-Identifier: Apache-2.0
#include "survey.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pellucid {
namespace {

constexpr int side = 8;  ///< cells along a block

/// The grid's axes; of a uniform grid, as files that are read in parts have it.
GridAxis<double> axis_of(const Volume::Description& description, int axis) {
  return {nullptr, description.dimensions[static_cast<std::size_t>(axis)],
          description.centering == Centering::cell ? 1 : 0};
}

std::array<int, 3> blocks_of(const Volume::Description& description) {
  std::array<int, 3> count{};
  for (int a = 0; a < 3; ++a) {
    count[static_cast<std::size_t>(a)] = (axis_of(description, a).cells() + side - 1) / side;
  }
  return count;
}

/// Position of the plane in front of a block.
double plane_of(const Volume::Description& description, int axis, int block) {
  const GridAxis<double> grid = axis_of(description, axis);
  return grid.plane(std::min(block * side, grid.cells()));
}

}  // namespace

SurveySlab slab_of(const Volume::Description& description, int rank, int ranks) {
  const int blocks = blocks_of(description)[2], values = description.dimensions[2];
  SurveySlab slab;
  slab.first = static_cast<int>(std::int64_t{blocks} * rank / ranks);
  slab.end = static_cast<int>(std::int64_t{blocks} * (rank + 1) / ranks);
  const bool cells = description.centering == Centering::cell;
  // A part of cell-centred data begins with a half cell that the whole does not have there: one
  // block more, whose records do not count.
  slab.skipped = cells && slab.first > 0 ? 1 : 0;
  const int first = side * (slab.first - slab.skipped);
  const int end = std::min(side * slab.end + (cells ? 0 : 1), values);
  slab.values.first = {0, 0, first};
  slab.values.count = {description.dimensions[0], description.dimensions[1],
                       std::max(end - first, 1)};
  return slab;
}

Survey join(Communicator& ranks, const Volume::Description& description, const SurveySlab& slab,
            const AbsorbingBlocks& found) {
  Survey survey;
  survey.count = blocks_of(description);
  const auto row = static_cast<std::size_t>(survey.count[0]) *
                   static_cast<std::size_t>(survey.count[1]);
  survey.absorbs.assign(row * static_cast<std::size_t>(survey.count[2]), 0);
  for (int block = slab.first; block < slab.end; ++block) {
    const auto own = static_cast<std::size_t>(block - slab.first + slab.skipped) * row;
    std::copy_n(found.absorbs.begin() + static_cast<std::ptrdiff_t>(own), row,
                survey.absorbs.begin() +
                    static_cast<std::ptrdiff_t>(static_cast<std::size_t>(block) * row));
  }
  ranks.reduce_all(survey.absorbs, Communicator::Reduction::maximum);
  return survey;
}

std::optional<std::array<Vec3<double>, 8>> corners_of(const Survey& survey,
                                                      const Volume::Description& description,
                                                      const Affine<double>& world_from_grid) {
  std::array<int, 3> first{}, last{-1, -1, -1};
  std::size_t index = 0;
  for (int k = 0; k < survey.count[2]; ++k) {
    for (int j = 0; j < survey.count[1]; ++j) {
      for (int i = 0; i < survey.count[0]; ++i) {
        if (!(survey.absorbs[index++] > 0)) continue;
        const std::array<int, 3> block{i, j, k};
        const bool is_first = last[0] < 0;
        for (std::size_t a = 0; a < 3; ++a) {
          first[a] = is_first ? block[a] : std::min(first[a], block[a]);
          last[a] = std::max(last[a], block[a]);
        }
      }
    }
  }
  if (last[0] < 0) return std::nullopt;
  std::array<Vec3<double>, 8> corners{};
  for (std::size_t n = 0; n < corners.size(); ++n) {
    Vec3<double> place;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      place[a] = plane_of(description, a, (n >> axis & 1) != 0 ? last[axis] + 1 : first[axis]);
    }
    corners[n] = world_from_grid.point(place);
  }
  return corners;
}

void add_weights(const Survey& survey, const Volume::Description& description,
                 const Affine<double>& frame_from_grid, const Box<double>& bounds,
                 BrickWeights& weights) {
  const double all = std::accumulate(survey.absorbs.begin(), survey.absorbs.end(), 0.0);
  if (!(all > 0)) return;
  std::size_t index = 0;
  for (int k = 0; k < survey.count[2]; ++k) {
    for (int j = 0; j < survey.count[1]; ++j) {
      for (int i = 0; i < survey.count[0]; ++i, ++index) {
        const double weight =
            0.5 / static_cast<double>(survey.absorbs.size()) + 0.5 * survey.absorbs[index] / all;
        const std::array<int, 3> block{i, j, k};
        Vec3<double> middle;
        for (int a = 0; a < 3; ++a) {
          const int at = block[static_cast<std::size_t>(a)];
          middle[a] = 0.5 * (plane_of(description, a, at) + plane_of(description, a, at + 1));
        }
        const Vec3<double> place = frame_from_grid.point(middle);
        std::size_t cell = 0;
        for (int a = 2; a >= 0; --a) {
          const int cells = weights.cells[static_cast<std::size_t>(a)];
          const double at = (place[a] - bounds.lower[a]) / (bounds.upper[a] - bounds.lower[a]);
          cell = cell * static_cast<std::size_t>(cells) +
                 static_cast<std::size_t>(std::clamp(at * cells, 0.0, cells - 1.0));
        }
        weights.weight[cell] += weight;
      }
    }
  }
}

}  // namespace pellucid
