// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/field/trilinear.h"
#include "pellucid/packet/block_march.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Stretches in lanes, from cell to cell; a lane that is through takes the next stretch there is,
/// whichever ray's. In float, from the lower corner of the block and from where the ray enters it:
/// a place is off by no more than 16 u of a cell along each axis.
template <class Value, int N>
class CellMarch {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using All = Stretches<Value, N>;

  /// The cells of one step.
  struct Step {
    CellCorners<F> corners;
    F begin, end;  ///< world length from the block's entry
    F from[3];     ///< the lower corner's place in the block
    F cell[3];     ///< in the block
    M last;        ///< whether it is the stretch's last one
  };

  CellMarch(const PacketGrid<Value>& grid, const BlockMarch<Value, N>& rays) noexcept
      : grid_(grid), rays_(rays), padded_(grid.padding[0] + grid.padding[1] + grid.padding[2] > 0) {
    for (int l = 0; l < N; ++l) base_[l] = grid.data;
    for (int a = 0; a < 3; ++a) {
      for (int l = 0; l < N; ++l) {
        direction_of_[a][l] = static_cast<float>(rays.direction[a][l]);
        inverse_of_[a][l] = 1 / direction_of_[a][l];
      }
    }
  }

  M walking{false};  ///< whether a lane has cells of its stretch left
  I stretch;         ///< that a lane walks in
  F ray_left;        ///< of its ray, from the entry into the block on, world length

  /// Begins with new stretches.
  [[gnu::flatten]] void begin(All& stretches) noexcept {
    for (int i = 0; i < N; ++i) {
      const int k = stretches.count + i;
      stretches.ray[k] = stretches.constant[k] = 0;
      stretches.begin[k] = stretches.end[k] = 0;
      for (int a = 0; a < 3; ++a) stretches.block[a][k] = 0;
    }
    for (int i = 0; i < stretches.count; i += N) prepare(stretches, i);
    next_ = 0;
    stretch = I(All::most);
  }

  /// Whether enough lanes are free for stretches that wait.
  bool wants(const All& stretches) const noexcept {
    return next_ < stretches.count && N - count(walking) >= (N + 3) / 4;
  }

  /// Gives the lanes that are free the next stretches; the lanes that got one. Those of one
  /// material are not gone through.
  M take(const All& stretches) noexcept {
    unsigned lanes = bits(!walking);
    const int left = stretches.count - next_;
    for (int n = __builtin_popcount(lanes); n > left; --n) {
      lanes &= ~(0x80000000u >> __builtin_clz(lanes));
    }
    const M begun = M::from_bits(lanes);
    enter(begun, stretches);
    return begun;
  }

  /// The place in a step's cell, [0,1]³, so far from the block's entry.
  Vec3<F> place(const Step& s, F distance) const noexcept {
    Vec3<F> local;
    for (int a = 0; a < 3; ++a) {
      local[a] = clamp(multiply_add(distance, direction_[a], place_[a] - s.from[a]), F(0), F(1));
    }
    return local;
  }

  /// One cell of each of the lanes that walk; of the others something that can be read.
  void step(Step& s) noexcept {
    const M lanes = walking;
    const F infinity(std::numeric_limits<float>::infinity());
    F next[3];
    for (int a = 0; a < 3; ++a) {
      const F plane = cell_[a] + select(forward_[a], F(1), F(0));
      next[a] = select(cell_[a] == end_cell_[a], infinity, (plane - place_[a]) * inverse_[a]);
    }
    s.begin = begin_;
    s.end = max(min(min(next[0], next[1]), min(next[2], length_)), begin_);
    for (int a = 0; a < 3; ++a) {
      s.cell[a] = cell_[a];
      s.from[a] = padded_ ? clamp(cell_[a], least_[a], highest_[a]) : cell_[a];
    }
    gather_corners(s.from, s.corners);
    if (padded_) repeat_border(s);

    for (int a = 0; a < 3; ++a) {
      const F step = select(forward_[a], F(1), F(-1));
      cell_[a] = select(lanes & (next[a] <= s.end), cell_[a] + step, cell_[a]);
    }
    begin_ = select(lanes, s.end, begin_);
    s.last = begin_ >= length_;
    walking = walking & !s.last;
  }

  /// The values at the lower corners of the stretches first … first + N - 1.
  F first_values(const All& stretches, int first) const noexcept {
    float value[N];
    for (int l = 0; l < N; ++l) value[l] = static_cast<float>(*stretches.base[first + l]);
    return F::load(value);
  }

 private:
  /// Fills in what a march needs to know of the stretches first … first + N - 1.
  void prepare(All& stretches, int first) noexcept {
    const I ray = I::load(stretches.ray + first);
    const D begin = D::load(stretches.begin + first);
    std::int32_t first_value[3][N];
    for (int a = 0; a < 3; ++a) {
      const I first_cell = I::load(stretches.block[a] + first) * I(block_width);
      const D place = lookup(rays_.origin[a], ray) + begin * lookup(rays_.direction[a], ray) -
                      convert<double>(first_cell);
      convert<float>(place).store(stretches.place[a] + first);
      const I last = min(I(grid_.cells[a]) - first_cell, I(block_width)) - I(1);
      convert<float>(last).store(stretches.last[a] + first);
      const I first_of_block = first_cell - I(grid_.padding[a]);
      max(first_of_block, I(0)).store(first_value[a]);
      if (!padded_) continue;
      // At a border of cell-centred data both values of a cell are the border's: its neighbour's
      // cell is taken, at the end of it.
      const I least = max(I(0) - first_of_block, I(0)),
              highest = I(grid_.values[a] - 2) - first_of_block;
      convert<float>(least).store(stretches.least[a] + first);
      convert<float>(highest).store(stretches.highest[a] + first);
    }
    convert<float>(D::load(stretches.end + first) - begin).store(stretches.length + first);
    convert<float>(lookup(rays_.end, ray) - begin).store(stretches.left + first);
    for (int l = 0; l < N; ++l) {
      stretches.base[first + l] = grid_.data + (first_value[0][l] + grid_.row * first_value[1][l] +
                                                grid_.slice * first_value[2][l]);
    }
  }

  /// Begins the next stretches in these lanes.
  void enter(M lanes, const All& stretches) noexcept {
    const int taken = count(lanes), from = next_;
    next_ += taken;
    std::int32_t number[N];
    for (int l = 0; l < N; ++l) number[l] = from + l;
    const M constant = load_spread(lanes, stretches.constant + from, I(0)) > I(0);
    stretch = load_spread(lanes, number, stretch);
    const I ray = load_spread(lanes, stretches.ray + from, I(0));
    for (int a = 0; a < 3; ++a) {
      place_[a] = load_spread(lanes, stretches.place[a] + from, place_[a]);
      const F last = load_spread(lanes, stretches.last[a] + from, F(0));
      direction_[a] = select(lanes, lookup(direction_of_[a], ray), direction_[a]);
      const F inverse = lookup(inverse_of_[a], ray);
      inverse_[a] = select(lanes, inverse, inverse_[a]);
      forward_[a] = select(lanes, inverse > F(0), forward_[a]);
      const F cell = clamp(floor(place_[a]), F(0), last);
      cell_[a] = select(lanes, cell, cell_[a]);
      // Of a direction so small that its inverse is infinite nothing is met in a block.
      const M still = !(abs(inverse) <= F(std::numeric_limits<float>::max()));
      const F end_cell = select(still, cell, select(inverse > F(0), last, F(0)));
      end_cell_[a] = select(lanes, end_cell, end_cell_[a]);
      if (!padded_) continue;
      least_[a] = load_spread(lanes, stretches.least[a] + from, least_[a]);
      highest_[a] = load_spread(lanes, stretches.highest[a] + from, highest_[a]);
    }
    const Value* const* base = stretches.base + from;
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      base_[__builtin_ctz(left)] = *base++;
    }
    length_ = load_spread(lanes, stretches.length + from, length_);
    ray_left = load_spread(lanes, stretches.left + from, ray_left);
    begin_ = select(lanes, F(0), begin_);
    walking = walking | (lanes & (length_ > F(0)) & !constant);
  }

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
    I first[3];
    for (int a = 0; a < 3; ++a) {
      first[a] = convert<std::int32_t>(padded_ ? from[a] - least_[a] : from[a]);
    }
    const I offset = first[0] + I(static_cast<std::int32_t>(grid_.row)) * first[1] +
                     I(static_cast<std::int32_t>(grid_.slice)) * first[2];
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
  const BlockMarch<Value, N>& rays_;
  const bool padded_;  ///< whether there are cells outside of the outermost values
  float direction_of_[3][N], inverse_of_[3][N];  ///< by ray
  int next_ = 0;                                 ///< of the stretches, the first not taken

  // Of the stretches in the lanes.
  F direction_[3], inverse_[3];
  M forward_[3];
  F place_[3];               ///< of the entry into the block, from the block's lower corner
  F cell_[3], end_cell_[3];  ///< in the block; the last one along each axis
  F least_[3], highest_[3];  ///< the cells whose values are there
  F begin_, length_;
  const Value* base_[N];  ///< the value at the lower corner of cell `least`
};

}  // namespace pellucid
#endif
