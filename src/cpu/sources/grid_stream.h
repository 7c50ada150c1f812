// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "layers/layer_stream.h"
#include "layers/plane_ambiguity.h"
#include "pellucid/traverse/block_walk.h"
#include "pellucid/traverse/structured_walk.h"

namespace pellucid {

/// Returns the rounding of the positions at which a ray meets a plane of a grid, world length.
inline double grid_position_error(double t) {
  return 8 * rounding_unit<double> * t;
}

/// Walks through the blocks of a grid, and through the cells of those that are not skipped.
class GridStream : public LayerStream {
 public:
  /// Walks through a grid. All must outlive the stream. `axis`: of the cells to walk through, in
  /// the grid's coordinates. Skipped blocks are visited where a slice is; `wholly`: from end to
  /// end.
  GridStream(const Volume& volume, const GridAxis<double> (&axis)[3], const BlockRecords& records,
             const BlockClass* classes, const std::vector<Slice>& slices, bool wholly)
      : volume_(volume),
        axis_(axis),
        records_(records),
        classes_(classes),
        slices_(slices),
        wholly_(wholly) {}

  Interval<double> start(const Ray<double>& ray) override {
    ray_ = grid_from_world().ray(ray);
    planes_.start(grid_from_world(), ray);
    if (!slices_.empty()) positions_ = slice_positions(slices_, ray);
    blocks_.reset();
    cells_.reset();
    return grid_interval(axis_, ray_);
  }
  void restrict_to_range(Interval<double> range) override {
    blocks_.emplace(records_, ray_, range);
    cells_.reset();
    is_ahead_ = false;
  }

 protected:
  /// Finds the next cell, or skipped blocks. Returns false behind the last one.
  bool next_cell(StructuredWalk<double>::Step& step, int& block, bool& skipped) {
    for (;;) {
      if (cells_ && cells_->next(step)) {
        block = block_.block;
        skipped = false;
        return true;
      }
      cells_.reset();
      if (!blocks_ || !blocks_->next(classes_, block_)) return false;
      Interval<double> visited{block_.t_begin, block_.t_end};
      if (classes_ != nullptr && classes_[block_.block].kind == BlockKind::skip &&
          !has_slice(visited)) {
        step.t_begin = block_.t_begin;
        step.t_end = block_.t_end;
        block = block_.block;
        skipped = true;
        return true;
      }
      cells_.emplace(axis_, ray_, visited);
    }
  }
  /// Finds the next run of blocks that are not skipped, one behind the other. Returns false behind
  /// the last one.
  bool next_run(Interval<double>& run) {
    bool begun = false;
    while (is_ahead_ || (blocks_ && blocks_->next(classes_, block_))) {
      is_ahead_ = false;
      if (classes_ != nullptr && classes_[block_.block].kind == BlockKind::skip) {
        if (begun) return true;
        continue;
      }
      if (begun && block_.t_begin > run.end) {
        is_ahead_ = true;
        return true;
      }
      if (!begun) run.begin = block_.t_begin;
      run.end = block_.t_end;
      begun = true;
    }
    return begun;
  }
  /// Returns whether the ray can be told in runs of cells. Beside a plane, gradients that jump
  /// there may be those of either cell.
  bool suits_runs(const Interval<double>& inside, bool continuous_gradients) const {
    return continuous_gradients || !planes_.runs_along_planes(ray_, inside);
  }
  /// Tells a run of cells that have the first function.
  static void tell_run(const Interval<double>& run, LayerStretch& stretch) {
    stretch.kind = LayerStretch::Kind::run;
    stretch.begin = run.begin;
    stretch.end = run.end;
    stretch.position_error = grid_position_error(run.end);
    stretch.function = 0;
  }
  const Affine<double>& grid_from_world() const { return volume_.grid_from_world(); }
  const Ray<double>& ray() const { return ray_; }
  const PlaneAmbiguity& planes() const { return planes_; }

 private:
  /// Returns whether a slice is in the range, which becomes what is to be visited of it.
  bool has_slice(Interval<double>& range) const {
    Interval<double> visited{range.end, range.begin};
    for (const SlicePosition& slice : positions_) {
      const double off = 64 * (slice.error + grid_position_error(slice.t));
      if (!(slice.t + off >= range.begin && slice.t - off <= range.end)) continue;
      visited.begin = std::max(range.begin, std::min(visited.begin, slice.t - off));
      visited.end = std::min(range.end, std::max(visited.end, slice.t + off));
    }
    if (!(visited.begin <= visited.end)) return false;
    if (!wholly_ && visited.begin < visited.end) range = visited;
    return true;
  }

  const Volume& volume_;
  const GridAxis<double> (&axis_)[3];
  const BlockRecords& records_;
  const BlockClass* classes_;  ///< null: none is skipped
  const std::vector<Slice>& slices_;
  bool wholly_;
  std::vector<SlicePosition> positions_;
  Ray<double> ray_{};
  PlaneAmbiguity planes_;
  std::optional<BlockWalk> blocks_;
  std::optional<StructuredWalk<double>> cells_;
  BlockStep block_{};
  bool is_ahead_ = false;  ///< whether the block is one that next_run() did not tell
};

}  // namespace pellucid
