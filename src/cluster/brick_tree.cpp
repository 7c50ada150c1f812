// SPDX-License-Identifier: Apache-2.0
#include "pellucid/cluster/brick_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "brick_cuts.h"
#include "pellucid/scene/error.h"
#include "pellucid/scene/internal/box_corners.h"

namespace pellucid {

/// Splits the bounds from the root on.
class BrickTree::Splitter {
 public:
  Splitter(BrickTree& tree, const BrickCuts& cuts) : tree_(tree), cuts_(cuts) {}

  int add(const Box<double>& box, int first, int count) {
    const auto index = tree_.node_.size();
    tree_.node_.emplace_back();
    if (count == 1) {
      tree_.node_[index].brick = first;
      tree_.box_[static_cast<std::size_t>(first)] = box;
      return static_cast<int>(index);
    }
    const int below = count / 2;
    const BrickCuts::Cut cut = cuts_.find(box, below, count);
    tree_.node_[index].above = tree_.plane(cut.axis, cut.position);
    Box<double> lower = box, upper = box;
    lower.upper[cut.axis] = upper.lower[cut.axis] = cut.position;
    const int below_child = add(lower, first, below);
    const int above_child = add(upper, first + below, count - below);
    tree_.node_[index].below_child = below_child;
    tree_.node_[index].above_child = above_child;
    return static_cast<int>(index);
  }

 private:
  BrickTree& tree_;
  const BrickCuts& cuts_;
};

/// Finds planes that separate given boxes.
class BrickTree::Assembler {
 public:
  Assembler(BrickTree& tree, const std::vector<Box<double>>& boxes) : tree_(tree), boxes_(boxes) {}

  int add(const std::vector<int>& bricks) {
    const auto index = tree_.node_.size();
    tree_.node_.emplace_back();
    if (bricks.size() == 1) {
      tree_.node_[index].brick = bricks[0];
      return static_cast<int>(index);
    }
    std::vector<int> below, above;
    tree_.node_[index].above = separate(bricks, below, above);
    const int below_child = add(below), above_child = add(above);
    tree_.node_[index].below_child = below_child;
    tree_.node_[index].above_child = above_child;
    return static_cast<int>(index);
  }

 private:
  const Box<double>& box(int brick) const { return boxes_[static_cast<std::size_t>(brick)]; }

  /// Returns the plane that leaves both sides as equal as possible.
  RayRegion::HalfSpace separate(const std::vector<int>& bricks, std::vector<int>& below,
                                std::vector<int>& above) const {
    std::size_t best = 0;
    RayRegion::HalfSpace plane;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int candidate : bricks) {
        const double position = box(candidate).upper[axis];
        std::vector<int> low, high;
        for (const int brick : bricks) {
          if (box(brick).upper[axis] <= position) {
            low.push_back(brick);
          } else if (box(brick).lower[axis] >= position) {
            high.push_back(brick);
          }
        }
        if (low.size() + high.size() < bricks.size()) continue;
        const std::size_t smaller = std::min(low.size(), high.size());
        if (smaller <= best) continue;
        best = smaller;
        plane = tree_.plane(axis, position);
        below = low;
        above = high;
      }
    }
    if (best == 0) {
      throw Error("bricks: no plane separates the boxes of ranks " + std::to_string(bricks[0]) +
                  " and " + std::to_string(bricks[1]) +
                  " and others; boxes must meet in faces, without overlap, as a k-d tree has them");
    }
    return plane;
  }

  BrickTree& tree_;
  const std::vector<Box<double>>& boxes_;
};

BrickTree::BrickTree(const Affine<double>& world_from_frame, const Box<double>& bounds)
    : world_from_frame_(world_from_frame),
      frame_from_world_(inverse(world_from_frame)),
      bounds_(bounds) {}

BrickTree BrickTree::split(const Affine<double>& world_from_frame, const Box<double>& bounds,
                           int bricks, const BrickWeights& weights, bool on_grid,
                           const Vec3<double>& view) {
  constexpr int most = 65536;
  if (bricks < 1 || bricks > most) {
    throw Error("bricks: " + std::to_string(bricks) + " are asked for, but must be from 1 to " +
                std::to_string(most));
  }
  BrickTree tree(world_from_frame, bounds);
  tree.box_.resize(static_cast<std::size_t>(bricks));
  tree.on_grid_ = on_grid;
  const BrickCuts cuts(world_from_frame, bounds, weights, on_grid, view);
  Splitter(tree, cuts).add(bounds, 0, bricks);
  return tree;
}

BrickTree BrickTree::of_boxes(const Affine<double>& world_from_frame,
                              const std::vector<Box<double>>& boxes) {
  if (boxes.empty()) throw Error("bricks: there is no box; give one for each rank");
  Box<double> bounds = boxes.front();
  for (const Box<double>& box : boxes) {
    for (int a = 0; a < 3; ++a) {
      if (!(box.lower[a] < box.upper[a])) {
        throw Error("bricks: a box is empty or not a number; give its lower and upper corner");
      }
      bounds.lower[a] = std::min(bounds.lower[a], box.lower[a]);
      bounds.upper[a] = std::max(bounds.upper[a], box.upper[a]);
    }
  }
  BrickTree tree(world_from_frame, bounds);
  tree.box_ = boxes;
  std::vector<int> all(boxes.size());
  std::iota(all.begin(), all.end(), 0);
  Assembler(tree, boxes).add(all);
  return tree;
}

std::array<Vec3<double>, 8> BrickTree::corners(int brick) const noexcept {
  return box_corners(box(brick), world_from_frame_);
}

RayRegion::HalfSpace BrickTree::plane(int axis, double position) const noexcept {
  const Mat3<double>& m = frame_from_world_.matrix;
  return {{m.column[0][axis], m.column[1][axis], m.column[2][axis]},
          position - frame_from_world_.translation[axis],
          true};
}

RayRegion BrickTree::region(int brick) const {
  RayRegion region;
  region.corners = corners(brick);
  // Goes down to the leaf; the tree is small.
  const auto descend = [&](const auto& self, int index) -> bool {
    const Node& node = node_[static_cast<std::size_t>(index)];
    if (node.brick >= 0) return node.brick == brick;
    for (const bool above : {false, true}) {
      RayRegion::HalfSpace half = node.above;
      half.above = above;
      region.half_spaces.push_back(half);
      if (self(self, above ? node.above_child : node.below_child)) return true;
      region.half_spaces.pop_back();
    }
    return false;
  };
  descend(descend, 0);
  return region;
}

std::vector<int> BrickTree::front_to_back(const CameraFrame<double>& camera) const {
  std::vector<int> order, left{0};
  while (!left.empty()) {
    const Node& node = node_[static_cast<std::size_t>(left.back())];
    left.pop_back();
    if (node.brick >= 0) {
      order.push_back(node.brick);
      continue;
    }
    // The eye's side is in front; with parallel rays the side that they come from. As
    // RayRegion::range() rounds.
    const bool above = camera.perspective
                           ? dot(node.above.normal, camera.position) - node.above.offset >= 0
                           : dot(node.above.normal, camera.forward) < 0;
    left.push_back(above ? node.below_child : node.above_child);
    left.push_back(above ? node.above_child : node.below_child);
  }
  return order;
}

int BrickTree::bricks_on(const Ray<double>& ray) const noexcept {
  Interval<double> range = intersect(bounds_, frame_from_world_.ray(ray));
  range.begin = std::max(range.begin, 0.0);
  return range.empty() ? 0 : count_on(0, ray, range);
}

int BrickTree::count_on(int index, const Ray<double>& ray, Interval<double> range) const noexcept {
  const Node& node = node_[static_cast<std::size_t>(index)];
  if (node.brick >= 0) return 1;
  const double height = dot(node.above.normal, ray.origin) - node.above.offset;
  const double slope = dot(node.above.normal, ray.direction);
  if (slope == 0) return count_on(height >= 0 ? node.above_child : node.below_child, ray, range);
  const double t = -height / slope;
  const int first = slope > 0 ? node.below_child : node.above_child;
  const int second = slope > 0 ? node.above_child : node.below_child;
  int count = 0;
  if (range.begin < t) count += count_on(first, ray, {range.begin, std::min(range.end, t)});
  if (t <= range.end) count += count_on(second, ray, {std::max(range.begin, t), range.end});
  return count;
}

}  // namespace pellucid
