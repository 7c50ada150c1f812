// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pellucid {

/// Bounds on the variation of the data of a block and of all that touch it: the largest of their
/// records' (traverse/block_record.h). Upper halves of floats, as there; all infinite beside
/// vacuum, through which data are not continuous. In loads of 32 bits: oscillation x and y;
/// oscillation z and bend x; bend y and z; twist.
///
/// What they say of a straight way that begins in the block and goes no further than a block's
/// width along each axis: it is in m + 1 blocks at most, m the number of axes on which it ends in
/// another block. Along its own axis the derivative jumps at a face between two of them by `bend`
/// at most; the two others are continuous there, so that their ranges in both blocks have a value
/// in common. Hence over the whole way the derivative by axis a is within a range of (m + 1)
/// oscillation_a, and bend_a more if the way ends in another block of that axis. Of a part of the
/// way bend and twist alone say how much it may vary, too: derivative_variation()
/// (curvature_bounds.h).
struct alignas(16) BlockVariation {
  std::uint16_t oscillation[3];
  std::uint16_t second_difference[3];
  std::uint16_t twist;  ///< the largest of the three
  std::uint16_t unused;
};
static_assert(sizeof(BlockVariation) == 16);

}  // namespace pellucid
