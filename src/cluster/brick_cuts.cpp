// SPDX-License-Identifier: Apache-2.0
#include "brick_cuts.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "pellucid/scene/error.h"

namespace pellucid {
namespace {

/// Position of faces between the whole numbers of a grid: the golden section, far from halves,
/// thirds and quarters.
constexpr double between = 0.38196601125010515;
/// Distance of faces from equal shares elsewhere, of the side that is cut.
constexpr double beside = between / 64;
/// The thinnest brick, of the side that is cut: data are read in bricks, whatever they weigh.
constexpr double thinnest = 1.0 / 16;
/// Inverse of how much longer than others a side must be to be cut where all rays cross the cut.
constexpr double min_preference = 0.4;

}  // namespace

BrickCuts::BrickCuts(const Affine<double>& world_from_frame, const Box<double>& bounds,
                     const BrickWeights& weights, bool on_grid, const Vec3<double>& view)
    : bounds_(bounds), weights_(weights), on_grid_(on_grid) {
  const Mat3<double> frame_from_world = inverse(world_from_frame).matrix;
  const double ray = length(view);
  for (int a = 0; a < 3; ++a) {
    world_length_[a] = length(world_from_frame.matrix.column[a]);
    const Vec3<double> normal{frame_from_world.column[0][a], frame_from_world.column[1][a],
                              frame_from_world.column[2][a]};
    const double across = ray > 0 ? std::abs(dot(normal, view)) / (length(normal) * ray) : 0;
    preference_[a] = 1 - (1 - min_preference) * across;
    if (!(bounds.lower[a] < bounds.upper[a])) {
      throw Error("bricks: the bounds of the data are empty along axis " + std::to_string(a));
    }
  }
}

BrickCuts::Cut BrickCuts::find(const Box<double>& box, int below, int count) const {
  int axis = 0;
  double longest = 0;
  for (int a = 0; a < 3; ++a) {
    const double side = (box.upper[a] - box.lower[a]) * world_length_[a] * preference_[a];
    if (side > longest) {
      longest = side;
      axis = a;
    }
  }
  const double share = static_cast<double>(below) / count;
  const double lower = box.lower[axis], upper = box.upper[axis];
  const auto at = [&](double part) { return lower + part * (upper - lower); };
  double part = share;
  if (const double all = weights_.weight.empty() ? 0 : weight(box); all > 0) {
    double least = thinnest, most = 1 - thinnest;
    for (int n = 0; n < 40; ++n) {
      part = 0.5 * (least + most);
      Box<double> side = box;
      side.upper[axis] = at(part);
      (weight(side) < share * all ? least : most) = part;
    }
  }
  return {axis, snapped(box, axis, at(part))};
}

double BrickCuts::snapped(const Box<double>& box, int axis, double position) const {
  // Faces of cells lie at fractions of the sides with small denominators.
  if (!on_grid_) return position + beside * (box.upper[axis] - box.lower[axis]);
  const double at = std::round(position - between) + between;
  return at > box.lower[axis] && at < box.upper[axis] ? at : position;
}

double BrickCuts::weight(const Box<double>& box) const {
  // The share of each lattice cell that lies in the box, along each axis.
  std::array<std::vector<double>, 3> inside;
  std::array<int, 3> first{};
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const double cell = (bounds_.upper[a] - bounds_.lower[a]) / weights_.cells[axis];
    const double lower = (box.lower[a] - bounds_.lower[a]) / cell;
    const double upper = (box.upper[a] - bounds_.lower[a]) / cell;
    first[axis] = std::clamp(static_cast<int>(std::floor(lower)), 0, weights_.cells[axis] - 1);
    for (int i = first[axis]; i < weights_.cells[axis] && i < upper; ++i) {
      inside[axis].push_back(std::max(std::min(upper, i + 1.0) - std::max(lower, 1.0 * i), 0.0));
    }
  }
  double sum = 0;
  for (std::size_t k = 0; k < inside[2].size(); ++k) {
    for (std::size_t j = 0; j < inside[1].size(); ++j) {
      const std::size_t y = static_cast<std::size_t>(first[1]) + j,
                        z = static_cast<std::size_t>(first[2]) + k;
      const std::size_t row = static_cast<std::size_t>(weights_.cells[0]) *
                                  (y + static_cast<std::size_t>(weights_.cells[1]) * z) +
                              static_cast<std::size_t>(first[0]);
      for (std::size_t i = 0; i < inside[0].size(); ++i) {
        sum += weights_.weight[row + i] * inside[0][i] * inside[1][j] * inside[2][k];
      }
    }
  }
  return sum;
}

}  // namespace pellucid
