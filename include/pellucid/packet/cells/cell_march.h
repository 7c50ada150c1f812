// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include "pellucid/packet/blocks/block_march.h"
#include "pellucid/packet/cells/corner_loads.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Returns how far it is, world length, from a place to where rays leave cells along an axis, by a
/// plane at `plane`; infinite where the cell is the last one on the way.
template <int N>
Batch<double, N> plane_exit(Batch<double, N> plane, BatchMask<N> is_last, Batch<double, N> place,
                            Batch<double, N> inverse) noexcept {
  using D = Batch<double, N>;
  return select(is_last, D(std::numeric_limits<double>::infinity()), (plane - place) * inverse);
}

/// Returns the same of planes at whole numbers, all of it in the block.
template <int N>
Batch<double, N> cell_exit(Batch<float, N> cell, Batch<float, N> end_cell, Batch<double, N> place,
                           Batch<double, N> inverse, BatchMask<N> forward) noexcept {
  using F = Batch<float, N>;
  return plane_exit(convert<double>(cell + select(forward, F(1), F(0))), cell == end_cell, place,
                    inverse);
}

/// Returns the world length until rays enter cells along an axis.
template <int N>
Batch<double, N> cell_entry(Batch<float, N> cell, Batch<double, N> place, Batch<double, N> inverse,
                            BatchMask<N> forward) noexcept {
  using F = Batch<float, N>;
  return (convert<double>(cell + select(forward, F(0), F(1))) - place) * inverse;
}

/// The last cell on the way along an axis, whose cells in the block end with `last`. Of a direction
/// so small that its inverse is infinite nothing is met in a block.
template <int N>
Batch<float, N> end_of_cells(Batch<float, N> cell, Batch<float, N> last, Batch<double, N> inverse,
                             BatchMask<N> forward) noexcept {
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  const BatchMask<N> moves = abs(inverse) <= D(std::numeric_limits<double>::max());
  return select(moves, select(forward, last, F(0)), cell);
}

/// Walks in lanes, from cell to cell; a lane that is through takes the next walk there is,
/// whichever ray's. Places are in double, so that planes are where all other means see them: beside
/// vacuum nothing makes up for what one cell has too much. They count from the lower corner of the
/// block and from where the ray enters it.
template <int N>
class CellMarch {
 public:
  using F = Batch<float, N>;
  using D = Batch<double, N>;
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;
  using All = BlockSegments<N>;

  /// The cells of one step.
  struct Step {
    CellCorners<F> corners;
    D begin, end;  ///< world length from the block's entry
    F from[3];     ///< the lower corner's place in the block
    F cell[3];     ///< in the block
  };

  CellMarch(const PacketGrid& grid, const BlockMarch<N>& rays) noexcept
      : load_(grid), direction_of_(rays.direction) {
    for (int l = 0; l < N; ++l) base_[l] = grid.data;
    for (int l = 0; l < N; ++l) fastest_of_[l] = 0;
    for (int a = 0; a < 3; ++a) {
      for (int l = 0; l < N; ++l) {
        inverse_of_[a][l] = 1 / direction_of_[a][l];
        fastest_of_[l] = max(fastest_of_[l], static_cast<float>(abs(direction_of_[a][l])));
      }
    }
  }

  M walking{false};  ///< whether a lane has cells of its stretch left
  I stretch;         ///< that a lane walks in
  F ray_left;        ///< of its ray, from the entry into the block on, world length

  /// Begins with new walks.
  void begin() noexcept {
    next_ = 0;
    stretch = I(BlockIntervals<N>::most);
  }

  /// Returns whether enough lanes are free for walks that wait.
  bool wants(const All& walks) const noexcept {
    // Numbers are spread over lanes one by one where there is no instruction for it.
    constexpr int enough = N == 16 ? 2 : (N + 3) / 4;
    return next_ < walks.count && N - count(walking) >= enough;
  }

  /// Gives the lanes that are free the next walks; the lanes that got one.
  M take(const All& walks) noexcept {
    unsigned lanes = bits(!walking);
    const int waiting = walks.count - next_;
    for (int n = __builtin_popcount(lanes); n > waiting; --n) {
      lanes &= ~(0x80000000u >> __builtin_clz(lanes));
    }
    const M begun = M::from_bits(lanes);
    enter(begun, walks);
    return begun;
  }

  /// Returns the place among a step's corners, [0,1]³, so far from the block's entry; rounded by u.
  Vec3<F> place(const Step& s, D distance) const noexcept { return place(s.from, distance); }
  /// Returns the same in the step's own cell, which may be outside of the outermost values.
  Vec3<F> place_in_cell(const Step& s, D distance) const noexcept {
    return place(s.cell, distance);
  }

  /// One cell of each of the lanes that walk, of data of this type; of the others something that
  /// can be read.
  template <class Value>
  void step(Step& s) noexcept {
    const M lanes = walking;
    D next[3];
    for (int a = 0; a < 3; ++a) {
      next[a] = cell_exit(cell_[a], end_cell_[a], place_[a], inverse_[a], forward_[a]);
    }
    s.begin = begin_;
    s.end = max(min(min(next[0], next[1]), min(next[2], length_)), begin_);
    for (int a = 0; a < 3; ++a) s.cell[a] = cell_[a];
    load_.template load<Value>(base_, cell_, least_, highest_, s.from, s.corners);

    for (int a = 0; a < 3; ++a) {
      const F step = select(forward_[a], F(1), F(-1));
      cell_[a] = select(lanes & (next[a] <= s.end), cell_[a] + step, cell_[a]);
    }
    begin_ = select(lanes, s.end, begin_);
    walking = walking & (begin_ < length_);
  }

  /// Goes on by a distance behind which there is nothing, from where the last step ended: to the
  /// cell that holds its end, or out of the block. Less than a cell is not worth it.
  void skip(M lanes, F distance) noexcept {
    const D to = min(begin_ + convert<double>(distance), length_);
    lanes = lanes & walking & ((to >= length_) | (distance * fastest_ >= F(1.25f)));
    if (none(lanes)) return;
    walking = walking & !(lanes & (to >= length_));
    D begin = begin_;
    for (int a = 0; a < 3; ++a) {
      const F there = convert<float>(floor(multiply_add(to, direction_[a], place_[a])));
      // Never back.
      const F cell = select(forward_[a], min(max(there, cell_[a]), end_cell_[a]),
                            max(min(there, cell_[a]), end_cell_[a]));
      begin = max(cell_entry(cell, place_[a], inverse_[a], forward_[a]), begin);
      cell_[a] = select(lanes, cell, cell_[a]);
    }
    begin_ = select(lanes, min(begin, to), begin_);
  }

  // Of the walks in the lanes.
  F jump, second_difference, variation;

 private:
  Vec3<F> place(const F (&lower_corner)[3], D distance) const noexcept {
    Vec3<F> local;
    for (int a = 0; a < 3; ++a) {
      const D from_corner = place_[a] - convert<double>(lower_corner[a]);
      local[a] =
          clamp(convert<float>(multiply_add(distance, direction_[a], from_corner)), F(0), F(1));
    }
    return local;
  }
  /// Begins the next walks in these lanes.
  void enter(M lanes, const All& walks) noexcept {
    const int at = next_;
    next_ += count(lanes);
    stretch = load_spread(lanes, walks.stretch + at, stretch);
    const I ray = load_spread(lanes, walks.ray + at, I(0));
    for (int a = 0; a < 3; ++a) {
      const D place = load_spread(lanes, walks.place[a] + at, D(0));
      const F last = load_spread(lanes, walks.last[a] + at, F(0));
      const D direction = lookup(direction_of_[a], ray), inverse = lookup(inverse_of_[a], ray);
      const M forward = inverse > D(0);
      const F cell = clamp(convert<float>(floor(place)), F(0), last);
      const F end_cell = end_of_cells(cell, last, inverse, forward);
      place_[a] = select(lanes, place, place_[a]);
      direction_[a] = select(lanes, direction, direction_[a]);
      inverse_[a] = select(lanes, inverse, inverse_[a]);
      forward_[a] = select(lanes, forward, forward_[a]);
      cell_[a] = select(lanes, cell, cell_[a]);
      end_cell_[a] = select(lanes, end_cell, end_cell_[a]);
      if (!load_.padded) continue;
      least_[a] = load_spread(lanes, walks.least[a] + at, least_[a]);
      highest_[a] = load_spread(lanes, walks.highest[a] + at, highest_[a]);
    }
    const void* const* base = walks.base + at;
    for (unsigned left = bits(lanes); left != 0; left &= left - 1) {
      base_[__builtin_ctz(left)] = *base++;
    }
    length_ = load_spread(lanes, walks.length + at, length_);
    ray_left = load_spread(lanes, walks.left + at, ray_left);
    fastest_ = select(lanes, lookup(fastest_of_, ray), fastest_);
    jump = load_spread(lanes, walks.jump + at, jump);
    second_difference = load_spread(lanes, walks.second_difference + at, second_difference);
    variation = load_spread(lanes, walks.variation + at, variation);
    begin_ = select(lanes, D(0), begin_);
    walking = walking | lanes;
  }

  const CornerLoads<N> load_;
  const double (&direction_of_)[3][N];  ///< by ray
  double inverse_of_[3][N];
  float fastest_of_[N];  ///< the largest |direction|
  int next_ = 0;         ///< of the walks, the first not taken

  // Of the walks in the lanes.
  D direction_[3], inverse_[3];
  M forward_[3];
  D place_[3];               ///< of the entry into the block, from the block's lower corner
  F cell_[3], end_cell_[3];  ///< in the block; the last one along each axis
  F least_[3], highest_[3];  ///< the cells whose values are there
  D begin_, length_;
  F fastest_;
  const void* base_[N];  ///< the value at the lower corner of cell `least`
};

}  // namespace pellucid
#endif
