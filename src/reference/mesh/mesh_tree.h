// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "pellucid/geometry/vec3.h"
#include "real.h"

namespace pellucid::reference {

/// Boxes halved again and again at the median of their centres: finds those that a ray may meet.
class MeshTree {
 public:
  struct Bounds {
    Vec3<double> lower, upper;
  };

  explicit MeshTree(const std::vector<Bounds>& boxes);

  /// Returns the numbers of all boxes that the ray meets at t >= 0, and of some more.
  std::vector<std::int32_t> near(const RealRay& ray) const;

 private:
  struct Node {
    Bounds bounds;
    /// Range of `order_`, in leaves; inner nodes have none, and their children at `child` and after
    /// it.
    std::size_t begin = 0, end = 0;
    std::size_t child = 0;
  };

  void build(std::size_t node, std::size_t begin, std::size_t end,
             const std::vector<Bounds>& boxes);

  std::vector<Node> nodes_;
  std::vector<std::int32_t> order_;
};

}  // namespace pellucid::reference
