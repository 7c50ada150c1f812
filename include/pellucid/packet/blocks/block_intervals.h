// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pellucid {

/// Intervals of the rays of a packet, each inside of one block that is not to be skipped, in
/// arrays: what lies ahead of the rays, to be gone through by as many lanes as there are, whichever
/// ray's they are. Those of a ray come in order.
template <int N>
struct BlockIntervals {
  /// Number of stretches that are found ahead of a ray at a time.
  static constexpr int of_a_ray = 12;
  static constexpr int most = N * of_a_ray;
  /// Arrays are written and read by the vector, and so a little beyond their end.
  static constexpr int capacity = most + N;

  int count;
  std::int32_t ray[capacity];             ///< its lane in the packet
  std::int32_t block[3][capacity];        ///< that it lies in
  std::int32_t constant[capacity];        ///< 1: of one material
  double begin[capacity], end[capacity];  ///< world length from the ray's entry into the grid

  // What was found in them.
  std::int32_t cells[capacity];  ///< looked at
  std::int32_t spans[capacity];  ///< that absorb
};

/// Intervals that are to be gone through cell by cell, packed, in order.
template <int N>
struct BlockSegments {
  static constexpr int capacity = BlockIntervals<N>::capacity;

  int count;
  std::int32_t stretch[capacity], ray[capacity];
  double place[3][capacity];  ///< of its entry into the block, from the block's lower corner
  float last[3][capacity];    ///< the last cell of the block
  float least[3][capacity], highest[3][capacity];  ///< the cells of it whose values are there
  double length[capacity];                         ///< world length
  float left[capacity];                            ///< of the ray at the entry, world length
  /// By how much the data's derivative by world length varies along the ray: at most by
  /// jump + 2 second_difference · (length of a part), and by `variation` in all. Infinite where it
  /// is not known.
  float jump[capacity], second_difference[capacity], variation[capacity];
  const void* base[capacity];  ///< the value at the lower corner of cell `least`
};

}  // namespace pellucid
