// SPDX-License-Identifier: Apache-2.0
#include "boundary_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pellucid {
namespace {

struct Leaf {
  std::array<float, 3> lower, upper;
  std::int32_t face;

  float middle(std::size_t axis) const { return 0.5f * (lower[axis] + upper[axis]); }
};

/// Halves the faces at the median along the longest axis of their middles.
class Builder {
 public:
  Builder(std::vector<Leaf>& leaves, BoundaryTree& tree) : leaves_(leaves), tree_(tree) {}

  void fill(std::size_t node, std::size_t first, std::size_t last) {
    constexpr float far = std::numeric_limits<float>::max();
    std::array<float, 3> least{far, far, far}, most{-far, -far, -far};
    BoundaryNode box{{far, far, far}, {-far, -far, -far}};
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        box.lower[a] = std::min(box.lower[a], leaves_[i].lower[a]);
        box.upper[a] = std::max(box.upper[a], leaves_[i].upper[a]);
        least[a] = std::min(least[a], leaves_[i].middle(a));
        most[a] = std::max(most[a], leaves_[i].middle(a));
      }
    }
    constexpr std::size_t faces_of_a_leaf = 4;
    if (last - first <= faces_of_a_leaf) {
      box.first = static_cast<std::int32_t>(first);
      box.count = static_cast<std::int32_t>(last - first);
      tree_.node[node] = box;
      return;
    }
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (most[a] - least[a] > most[axis] - least[axis]) axis = a;
    }
    const std::size_t middle = (first + last) / 2;
    const auto at = [&](std::size_t i) { return leaves_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(first), at(middle), at(last), [axis](const Leaf& a, const Leaf& b) {
      const float p = a.middle(axis), q = b.middle(axis);
      return p != q ? p < q : a.face < b.face;
    });
    const std::size_t children = tree_.node.size();
    tree_.node.resize(children + 2);
    box.first = static_cast<std::int32_t>(children);
    tree_.node[node] = box;
    fill(children, first, middle);
    fill(children + 1, middle, last);
  }

 private:
  std::vector<Leaf>& leaves_;
  BoundaryTree& tree_;
};

}  // namespace

BoundaryTree build_boundary_tree(const std::vector<Tetrahedron>& tetrahedra,
                                 const std::vector<Vec3<double>>& points,
                                 const Box<double>& bounds) {
  double reach = 0;
  for (int a = 0; a < 3; ++a) {
    reach = std::max({reach, std::fabs(bounds.lower[a]), std::fabs(bounds.upper[a])});
  }
  const double margin = 0x1p-21 * reach;
  std::size_t count = 0;
  for (const Tetrahedron& t : tetrahedra) {
    for (const std::int32_t behind : t.neighbor) count += behind == Tetrahedron::outside ? 1 : 0;
  }
  std::vector<Leaf> leaves;
  leaves.reserve(count);
  for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
    const Tetrahedron& t = tetrahedra[i];
    for (int f = 0; f < 4; ++f) {
      if (t.neighbor[f] != Tetrahedron::outside) continue;
      Leaf leaf{{}, {}, static_cast<std::int32_t>(4 * i) + f};
      for (int a = 0; a < 3; ++a) {
        double lower = std::numeric_limits<double>::infinity(), upper = -lower;
        for (int k = 0; k < 4; ++k) {
          if (k == f) continue;
          const double x = points[static_cast<std::size_t>(t[k])][a];
          lower = std::min(lower, x);
          upper = std::max(upper, x);
        }
        // Rounding to float is 2^-24 of it.
        leaf.lower[static_cast<std::size_t>(a)] = static_cast<float>(lower - margin);
        leaf.upper[static_cast<std::size_t>(a)] = static_cast<float>(upper + margin);
      }
      leaves.push_back(leaf);
    }
  }
  BoundaryTree tree;
  tree.node.reserve(leaves.size());
  tree.node.emplace_back();
  Builder(leaves, tree).fill(0, 0, leaves.size());
  tree.face.reserve(leaves.size());
  for (const Leaf& leaf : leaves) tree.face.push_back(leaf.face);
  return tree;
}

}  // namespace pellucid
