// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/cluster/brick_tree.h"

namespace pellucid {

/// Search for cuts of boxes into two of given shares of the weight.
class BrickCuts {
 public:
  struct Cut {
    int axis;
    double position;
  };

  /// Takes the arguments of BrickTree::split(). `weights` must outlive the object.
  BrickCuts(const Affine<double>& world_from_frame, const Box<double>& bounds,
            const BrickWeights& weights, bool on_grid, const Vec3<double>& view);

  /// Returns the cut that leaves `below` / `count` of the weight of a box below it.
  Cut find(const Box<double>& box, int below, int count) const;

 private:
  /// Returns the weight of the part of a box, whose sides are those of the lattice's cells or not.
  double weight(const Box<double>& box) const;
  double snapped(const Box<double>& box, int axis, double position) const;

  Vec3<double> world_length_;  ///< of a unit of the frame
  Vec3<double> preference_;    ///< for cuts across each axis: 1, less where rays cross them
  Box<double> bounds_;
  const BrickWeights& weights_;
  bool on_grid_;
};

}  // namespace pellucid
