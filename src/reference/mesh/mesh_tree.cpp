// SPDX-License-Identifier: Apache-2.0
#include "mesh_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace pellucid::reference {
namespace {

using Bounds = MeshTree::Bounds;

constexpr std::size_t leaf_size = 4;
/// Widening of a box for a ray, as a share of the distances that occur: well above the rounding.
constexpr double margin = 1e-12;

Bounds joined(const Bounds& p, const Bounds& q) {
  Bounds result;
  for (int a = 0; a < 3; ++a) {
    result.lower[a] = std::min(p.lower[a], q.lower[a]);
    result.upper[a] = std::max(p.upper[a], q.upper[a]);
  }
  return result;
}

/// Returns whether the ray meets the box, widened, at t >= 0.
bool meets(const RealRay& ray, const Bounds& bounds, Real widening) {
  Real begin = 0, end = std::numeric_limits<Real>::infinity();
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    const Real lower = bounds.lower[a] - widening - ray.origin[axis];
    const Real upper = bounds.upper[a] + widening - ray.origin[axis];
    if (ray.direction[axis] == 0) {
      if (lower > 0 || upper < 0) return false;
      continue;
    }
    const auto [first, last] =
        std::minmax({lower / ray.direction[axis], upper / ray.direction[axis]});
    begin = std::max(begin, first);
    end = std::min(end, last);
  }
  return begin <= end;
}

/// Returns a bound on the distance of the box's corners from the ray's origin.
Real farthest(const RealRay& ray, const Bounds& bounds) {
  Real sum = 0;
  for (int a = 0; a < 3; ++a) {
    const Real origin = ray.origin[static_cast<std::size_t>(a)];
    sum += std::max(std::abs(bounds.lower[a] - origin), std::abs(bounds.upper[a] - origin));
  }
  return sum;
}

}  // namespace

MeshTree::MeshTree(const std::vector<Bounds>& boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  nodes_.emplace_back();
  if (!boxes.empty()) build(0, 0, boxes.size(), boxes);
}

void MeshTree::build(std::size_t node, std::size_t begin, std::size_t end,
                     const std::vector<Bounds>& boxes) {
  const auto box = [&](std::int32_t i) -> const Bounds& {
    return boxes[static_cast<std::size_t>(i)];
  };
  const auto first = order_.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = order_.begin() + static_cast<std::ptrdiff_t>(end);
  Bounds all = box(*first);
  for (auto i = first; i != last; ++i) all = joined(all, box(*i));
  nodes_[node] = {all, begin, end, 0};
  if (end - begin <= leaf_size) return;

  const Vec3<double> extent = all.upper - all.lower;
  int axis = extent.y > extent.x ? 1 : 0;
  if (extent.z > extent[axis]) axis = 2;
  const auto centre = [&](std::int32_t i) { return box(i).lower[axis] + box(i).upper[axis]; };
  const std::size_t middle = (begin + end) / 2;
  std::nth_element(first, order_.begin() + static_cast<std::ptrdiff_t>(middle), last,
                   [&](std::int32_t i, std::int32_t j) { return centre(i) < centre(j); });
  const std::size_t child = nodes_.size();
  nodes_.resize(child + 2);
  nodes_[node] = {all, 0, 0, child};
  build(child, begin, middle, boxes);
  build(child + 1, middle, end, boxes);
}

std::vector<std::int32_t> MeshTree::near(const RealRay& ray) const {
  std::vector<std::int32_t> result;
  if (order_.empty()) return result;
  const Real widening = margin * farthest(ray, nodes_.front().bounds);
  std::vector<std::size_t> todo{0};
  while (!todo.empty()) {
    const Node& node = nodes_[todo.back()];
    todo.pop_back();
    if (!meets(ray, node.bounds, widening)) continue;
    for (std::size_t i = node.begin; i < node.end; ++i) result.push_back(order_[i]);
    if (node.child == 0) continue;
    todo.push_back(node.child);
    todo.push_back(node.child + 1);
  }
  return result;
}

}  // namespace pellucid::reference
