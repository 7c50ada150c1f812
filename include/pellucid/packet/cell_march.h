// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/packet/block_march.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Rays in lanes, from cell to cell inside of the blocks that they stand in. In float, from the
/// lower corner of the block and from where the ray enters it: a place is off by no more than 16 u
/// of a cell along each axis.
template <class Value, int N>
class CellMarch {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  /// The cells of one step.
  struct Step {
    CellCorners<F> corners;
    F begin, end;  ///< world length from the block's entry
    F from[3];     ///< the lower corner's place in the block
    I cell[3];     ///< in the block
  };

  CellMarch(const PacketGrid<Value>& grid, const BlockMarch<Value, N>& blocks) noexcept
      : grid_(grid), padded_(grid.padding[0] + grid.padding[1] + grid.padding[2] > 0) {
    for (int l = 0; l < N; ++l) base_[l] = grid.data;
    for (int a = 0; a < 3; ++a) {
      direction_[a] = convert<float>(blocks.direction[a]);
      inverse_[a] = F(1) / direction_[a];
      forward_[a] = direction_[a] > F(0);
      // Of a direction so small that its inverse is infinite nothing is met in a block.
      still_[a] = !(abs(inverse_[a]) <= F(std::numeric_limits<float>::max()));
    }
  }

  M walking{false};  ///< whether a lane has cells of its block left
  F block_length;    ///< world length of the stretch in the block

  /// Begins the blocks that the lanes stand in.
  void enter(M lanes, const BlockMarch<Value, N>& blocks) noexcept {
    for (int a = 0; a < 3; ++a) {
      const D corner = convert<double>(blocks.block[a]) * D(block_width);
      const F place =
          convert<float>(blocks.origin[a] + blocks.begin * blocks.direction[a] - corner);
      const F count = convert<float>(I(grid_.cells[a]) - blocks.block[a] * I(block_width));
      place_[a] = select(lanes, place, place_[a]);
      last_[a] = select(lanes, min(count, F(block_width)) - F(1), last_[a]);
      cell_[a] = select(lanes, clamp(floor(place), F(0), last_[a]), cell_[a]);
      // At a border of cell-centred data both values of a cell are the border's: its neighbour's
      // cell is taken, at the end of it.
      const I first = blocks.block[a] * I(block_width) - I(grid_.padding[a]);
      const I least = max(I(0) - first, I(0)), most = I(grid_.values[a] - 2) - first;
      least_[a] = select(lanes, convert<float>(least), least_[a]);
      most_[a] = select(lanes, convert<float>(most), most_[a]);
      std::int32_t value[N];
      max(first, I(0)).store(value);
      for (int l = 0; l < N; ++l) first_value_[a][l] = value[l];
    }
    const unsigned bits_of_lanes = bits(lanes);
    for (int l = 0; l < N; ++l) {
      if ((bits_of_lanes >> l & 1) != 0) {
        base_[l] = grid_.data + (first_value_[0][l] + grid_.row * first_value_[1][l] +
                                 grid_.slice * first_value_[2][l]);
      }
    }
    begin_ = select(lanes, F(0), begin_);
    block_length = select(lanes, convert<float>(blocks.next - blocks.begin), block_length);
    walking = walking | (lanes & (block_length > F(0)));
  }

  /// The place in a step's cell, [0,1]³, so far from the block's entry.
  Vec3<F> place(const Step& s, F distance) const noexcept {
    Vec3<F> local;
    for (int a = 0; a < 3; ++a) {
      local[a] = clamp(multiply_add(distance, direction_[a], place_[a] - s.from[a]), F(0), F(1));
    }
    return local;
  }

  /// One cell of each of the lanes, which walk; of the others something that can be read.
  void step(M lanes, Step& s) noexcept {
    const F infinity(std::numeric_limits<float>::infinity());
    F next[3];
    for (int a = 0; a < 3; ++a) {
      const F plane = cell_[a] + select(forward_[a], F(1), F(0));
      const M at_end = select(forward_[a], cell_[a] >= last_[a], cell_[a] <= F(0)) | still_[a];
      next[a] = select(at_end, infinity, (plane - place_[a]) * inverse_[a]);
    }
    s.begin = begin_;
    s.end = max(min(min(next[0], next[1]), min(next[2], block_length)), begin_);
    for (int a = 0; a < 3; ++a) {
      s.from[a] = clamp(cell_[a], least_[a], most_[a]);
      s.cell[a] = convert<std::int32_t>(cell_[a]);
    }
    gather_corners(s.from, s.corners);
    if (padded_) repeat_border(s);

    for (int a = 0; a < 3; ++a) {
      const F step = select(forward_[a], F(1), F(-1));
      cell_[a] = select(lanes & (next[a] <= s.end), cell_[a] + step, cell_[a]);
    }
    begin_ = select(lanes, s.end, begin_);
    walking = walking & !(lanes & (begin_ >= block_length));
  }

 private:
  /// Cells outside of the outermost values have the border's twice.
  void repeat_border(Step& s) const noexcept {
    for (int a = 0; a < 3; ++a) {
      const M below = cell_[a]<s.from[a], beyond = cell_[a]> s.from[a];
      if (none(below | beyond)) continue;
      for (int n = 0; n < 8; ++n) {
        if ((n >> a & 1) != 0) continue;
        F &lower = s.corners.value[n], &upper = s.corners.value[n | 1 << a];
        upper = select(below, lower, upper);
        lower = select(beyond, upper, lower);
      }
    }
  }

  void gather_corners(const F* from, CellCorners<F>& corners) const noexcept {
    const I offset =
        convert<std::int32_t>(from[0] - least_[0]) +
        I(static_cast<std::int32_t>(grid_.row)) * convert<std::int32_t>(from[1] - least_[1]) +
        I(static_cast<std::int32_t>(grid_.slice)) * convert<std::int32_t>(from[2] - least_[2]);
    std::int32_t o[N];
    offset.store(o);
    const Value* at[N];
    for (int l = 0; l < N; ++l) at[l] = base_[l] + o[l];
    const std::ptrdiff_t rows[4] = {0, grid_.row, grid_.slice, grid_.slice + grid_.row};
    for (int k = 0; k < 4; ++k) {
      gather_pairs(at, SameOffset{rows[k]}, corners.value[2 * k], corners.value[2 * k + 1]);
    }
  }

  const PacketGrid<Value>& grid_;
  const bool padded_;  ///< whether there are cells outside of the outermost values
  F direction_[3], inverse_[3];
  M forward_[3], still_[3];
  F place_[3];            ///< of the entry into the block, from the block's lower corner
  F cell_[3], last_[3];   ///< in the block; the last one of it
  F least_[3], most_[3];  ///< the cells whose values are there
  F begin_;
  const Value* base_[N];  ///< the value at the lower corner of cell `least`
  std::int32_t first_value_[3][N];
};

}  // namespace pellucid
#endif
