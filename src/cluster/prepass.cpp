// SPDX-License-Identifier: Apache-2.0
#include "prepass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pellucid {
namespace {

constexpr int side = 8;  ///< cells along a block
constexpr double infinity = std::numeric_limits<double>::infinity();

GridAxis<double> axis_of(const Volume::Description& description, int axis) {
  return {nullptr, description.dimensions[static_cast<std::size_t>(axis)],
          description.centering == Centering::cell ? 1 : 0};
}

/// Returns the position of the plane in front of a block.
double plane_of(const Volume::Description& description, int axis, int block) {
  const GridAxis<double> grid = axis_of(description, axis);
  return grid.plane(std::min(block * side, grid.cells()));
}

SurveySlab slab_from(const Volume::Description& description, int first, int end) {
  SurveySlab slab{first, end, {}, 0};
  const bool cells = description.centering == Centering::cell;
  // A part of cell-centred data begins with a half cell that the whole does not have there: one
  // block more, whose records do not count.
  slab.skipped = cells && first > 0 ? 1 : 0;
  const int lowest = side * (first - slab.skipped);
  const int highest = std::min(side * end + (cells ? 0 : 1), description.dimensions[2]);
  slab.values.first = {0, 0, lowest};
  slab.values.count = {description.dimensions[0], description.dimensions[1],
                       std::max(highest - lowest, 1)};
  return slab;
}

}  // namespace

std::vector<SurveySlab> slabs_of(const Volume::Description& description, int rank, int ranks,
                                 std::size_t most_values) {
  const int blocks = Survey::blocks_of(description)[2];
  const int first = static_cast<int>(std::int64_t{blocks} * rank / ranks);
  const int end = static_cast<int>(std::int64_t{blocks} * (rank + 1) / ranks);
  const std::size_t layer = static_cast<std::size_t>(description.dimensions[0]) *
                            static_cast<std::size_t>(description.dimensions[1]) * side;
  const int thick = std::max(static_cast<int>(most_values / std::max<std::size_t>(layer, 1)), 1);
  std::vector<SurveySlab> slabs;
  for (int block = first; block < end; block += thick) {
    slabs.push_back(slab_from(description, block, std::min(block + thick, end)));
  }
  return slabs;
}

Survey::Survey(const Volume::Description& description, const Affine<double>& frame_from_grid,
               const Box<double>& bounds, const std::array<int, 3>& cells)
    : description_(description),
      frame_from_grid_(frame_from_grid),
      bounds_(bounds),
      cells_(cells),
      absorbing_(static_cast<std::size_t>(cells[0]) * static_cast<std::size_t>(cells[1]) *
                 static_cast<std::size_t>(cells[2])),
      all_(absorbing_.size()),
      first_{infinity, infinity, infinity},
      last_{-infinity, -infinity, -infinity} {}

std::array<int, 3> Survey::blocks_of(const Volume::Description& description) {
  std::array<int, 3> count{};
  for (int a = 0; a < 3; ++a) {
    count[static_cast<std::size_t>(a)] = (axis_of(description, a).cells() + side - 1) / side;
  }
  return count;
}

void Survey::add(const SurveySlab& slab, const AbsorbingBlocks& found) {
  const std::array<int, 3> count = blocks_of(description_);
  std::size_t index = static_cast<std::size_t>(slab.skipped) * static_cast<std::size_t>(count[0]) *
                      static_cast<std::size_t>(count[1]);
  for (int k = slab.first; k < slab.end; ++k) {
    for (int j = 0; j < count[1]; ++j) {
      for (int i = 0; i < count[0]; ++i) {
        const bool absorbs = found.absorbs[index++] != 0;
        const std::array<int, 3> block{i, j, k};
        Vec3<double> middle;
        for (int a = 0; a < 3; ++a) {
          const auto axis = static_cast<std::size_t>(a);
          const int at = block[axis];
          middle[a] = 0.5 * (plane_of(description_, a, at) + plane_of(description_, a, at + 1));
          if (!absorbs) continue;
          first_[axis] = std::min(first_[axis], 1.0 * at);
          last_[axis] = std::max(last_[axis], 1.0 * at);
        }
        const Vec3<double> place = frame_from_grid_.point(middle);
        std::size_t cell = 0;
        for (int a = 2; a >= 0; --a) {
          const int cells = cells_[static_cast<std::size_t>(a)];
          const double at = (place[a] - bounds_.lower[a]) / (bounds_.upper[a] - bounds_.lower[a]);
          cell = cell * static_cast<std::size_t>(cells) +
                 static_cast<std::size_t>(std::clamp(at * cells, 0.0, cells - 1.0));
        }
        all_[cell] += 1;
        if (absorbs) absorbing_[cell] += 1;
      }
    }
  }
}

void Survey::join(Communicator& ranks) {
  ranks.reduce_all(all_, Communicator::Reduction::sum);
  ranks.reduce_all(absorbing_, Communicator::Reduction::sum);
  ranks.reduce_all(first_, Communicator::Reduction::minimum);
  ranks.reduce_all(last_, Communicator::Reduction::maximum);
}

std::optional<std::array<Vec3<double>, 8>> Survey::corners(
    const Affine<double>& world_from_grid) const {
  if (!(first_[0] <= last_[0])) return std::nullopt;
  std::array<Vec3<double>, 8> corners{};
  for (std::size_t n = 0; n < corners.size(); ++n) {
    Vec3<double> place;
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const double block = (n >> axis & 1) != 0 ? last_[axis] + 1 : first_[axis];
      place[a] = plane_of(description_, a, static_cast<int>(block));
    }
    corners[n] = world_from_grid.point(place);
  }
  return corners;
}

void Survey::add_to(BrickWeights& weights) const {
  const double all = std::accumulate(all_.begin(), all_.end(), 0.0);
  const double absorbing = std::accumulate(absorbing_.begin(), absorbing_.end(), 0.0);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    weights.weight[i] += 0.5 * all_[i] / all;
    if (absorbing > 0) weights.weight[i] += 0.5 * absorbing_[i] / absorbing;
  }
}

}  // namespace pellucid
