// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <optional>

#include "layers/layer_points.h"
#include "pellucid/traverse/block_walk.h"

namespace pellucid {

/// Points in a grid: their places, and the blocks in which nothing absorbs.
class GridPoints : public LayerPoints {
 public:
  /// Takes points of a grid. All must outlive the object. `classes`: null: no block is skipped.
  GridPoints(const Volume& volume, const GridAxis<double> (&axis)[3], const BlockRecords& records,
             const BlockClass* classes)
      : volume_(volume), axis_(axis), records_(records), classes_(classes) {}

  Interval<double> start(const Ray<double>& ray) override {
    ray_ = volume_.grid_from_world().ray(ray);
    blocks_.reset();
    return grid_interval(axis_, ray_);
  }
  void restrict_to_range(Interval<double> range) override {
    blocks_.emplace(records_, ray_, range);
    block_ = {0, range.begin, range.begin};
    skipped_ = true;
  }
  bool goes_back() const override { return true; }
  double next_from(double t) override {
    while (skipped_ || !(t < block_.t_end)) {
      if (!blocks_->next(classes_, block_)) {
        skipped_ = true;
        return std::numeric_limits<double>::infinity();
      }
      skipped_ = classes_ != nullptr && classes_[block_.block].kind == BlockKind::skip;
    }
    return std::max(t, block_.t_begin);
  }

 protected:
  Vec3<double> position(double t) const { return ray_.at(t); }
  GridPlace<double> place(double t) const { return place_in_grid<double>(axis_, position(t)); }

 private:
  const Volume& volume_;
  const GridAxis<double> (&axis_)[3];
  const BlockRecords& records_;
  const BlockClass* classes_;
  Ray<double> ray_{};
  std::optional<BlockWalk> blocks_;
  BlockStep block_{};
  bool skipped_ = true;  ///< whether the block is
};

}  // namespace pellucid
