// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "pellucid/cpu/ray_region.h"
#include "pellucid/geometry/affine.h"
#include "pellucid/geometry/box.h"
#include "pellucid/render/camera.h"

namespace pellucid {

/// Weights of the parts of a box: numbers on a lattice of equal cells, x fastest.
struct BrickWeights {
  std::array<int, 3> cells{0, 0, 0};
  std::vector<double> weight;  ///< >= 0
};

/// A k-d tree of bricks, one for each rank: boxes along the axes of a *frame*, such as the
/// coordinates of a grid. They partition the world: bricks at the border of the data go on to
/// infinity.
class BrickTree {
 public:
  /// Splits the bounds of the data, in the frame, into so many bricks of nearly equal weight,
  /// across their longest side. Without weights each part weighs as much as its volume. If
  /// `on_grid`, faces are between the whole numbers of the frame, nowhere near the values or the
  /// middles of a grid's cells, where surfaces of stored data lie; else a little beside equal
  /// parts. `view`: the direction of a camera's rays in the world, if it is known: of sides of
  /// like length that is cut which puts bricks beside each other on the screen, so that few rays
  /// meet several. Throws Error unless 1 <= bricks <= 65536.
  static BrickTree split(const Affine<double>& world_from_frame, const Box<double>& bounds,
                         int bricks, const BrickWeights& weights = {}, bool on_grid = false,
                         const Vec3<double>& view = {0, 0, 0});
  /// Makes the tree of boxes that fill a box, as a simulation has them; brick i is boxes[i]. Throws
  /// Error if no plane along an axis separates some of them from the others.
  static BrickTree of_boxes(const Affine<double>& world_from_frame,
                            const std::vector<Box<double>>& boxes);

  int count() const noexcept { return static_cast<int>(box_.size()); }
  const Box<double>& bounds() const noexcept { return bounds_; }
  /// Returns whether the bounds are the box of the only grid, and the frame its coordinates.
  bool is_on_grid() const noexcept { return on_grid_; }
  const Affine<double>& world_from_frame() const noexcept { return world_from_frame_; }
  /// Returns a brick within the bounds, in the frame.
  const Box<double>& box(int brick) const noexcept { return box_[static_cast<std::size_t>(brick)]; }
  /// Returns the corners of the same in the world: bit a of the index tells the side along axis a.
  std::array<Vec3<double>, 8> corners(int brick) const noexcept;
  /// Returns the brick's part of the world. Its allowance is empty.
  RayRegion region(int brick) const;
  /// Returns the bricks such that each ray of the camera meets them in this order.
  std::vector<int> front_to_back(const CameraFrame<double>& camera) const;
  /// Returns how many bricks a ray meets within the bounds.
  int bricks_on(const Ray<double>& ray) const noexcept;

 private:
  struct Node {
    RayRegion::HalfSpace above{};  ///< half-space of the plane
    int below_child = -1, above_child = -1;
    int brick = -1;  ///< index of a leaf
  };
  class Splitter;
  class Assembler;

  BrickTree(const Affine<double>& world_from_frame, const Box<double>& bounds);
  /// Returns the plane at a position along an axis of the frame.
  RayRegion::HalfSpace plane(int axis, double position) const noexcept;
  int count_on(int node, const Ray<double>& ray, Interval<double> range) const noexcept;

  Affine<double> world_from_frame_, frame_from_world_;
  Box<double> bounds_;
  std::vector<Node> node_;  ///< the first is the root
  std::vector<Box<double>> box_;
  bool on_grid_ = false;
};

}  // namespace pellucid
