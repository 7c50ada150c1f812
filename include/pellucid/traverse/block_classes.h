// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/traverse/block_records.h"

namespace pellucid {

/// Treatment of a block under one transfer function.
enum class BlockKind : std::uint8_t {
  cells,     ///< gone through
  constant,  ///< the transfer function is constant over the range of the data, and no cell is
             ///<   vacuum; or the data is one number: in either case the material is that at the
             ///<   lower end of the range
  skip,      ///< nothing absorbs, whatever the data in the range; or all cells are vacuum
  smooth     ///< as cells; and with its neighbours so smooth that it may be sampled (SmoothBlocks)
};

/// A block under one transfer function, in 4 bytes: in a load of 32 bits roughness is the lower
/// half, then kind, then level. It is found from the block's record alone.
struct alignas(4) BlockClass {
  /// The upper half of a float (from_upper_half()), rounded upward: what a distance of the data
  /// from their chord, times a length, can make of the ray's error:
  ///
  ///   largest color · slope + color range · slope + color slope
  ///
  /// over the block's range (transfer/antiderivative.h), slope = max |extinction'|. Infinite where
  /// there is a jump, and where some cells are vacuum; 0 where the block is skipped or constant.
  std::uint16_t roughness;
  BlockKind kind;
  /// Level of a block to skip: the largest k <= 7 such that all blocks are to be skipped in the
  /// cube of (2^k)³ blocks, aligned at multiples of its side, which holds this one. What of the
  /// cube is outside of the grid counts as to be skipped. Of a smooth block likewise. 0 elsewhere.
  std::uint8_t level;

  PELLUCID_HD constexpr bool absorbs_in_cells() const noexcept {
    return kind == BlockKind::cells || kind == BlockKind::smooth;
  }
};
static_assert(sizeof(BlockClass) == 4);

/// Bounds that all smooth blocks of a grid share: on the second differences of their data, and on
/// the effect of these. Between two samples of such a block lies no feature that neither shows, but
/// for what one bend can be: over four blocks each way, and over the range of each, neither the
/// data nor the transfer function bend much more in one place than they do all over.
struct SmoothBlocks {
  float second_difference[3] = {};  ///< as in CurvatureBounds
  /// largest color · slope + color slope (see BlockClass), the largest of the blocks.
  double roughness = 0;
  /// Cells; the longest of any block. 0: none is smooth.
  double longest_step = 0;
  /// Records of each block, smooth or not, of `fields` numbers: roughness times bend along x, y and
  /// z; and 1 / the longest step, in cells: waves of the data are longer than three times that. The
  /// largest of all smooth blocks among it and those that touch it.
  const float* local = nullptr;
  static constexpr int fields = 4;
  /// Number of lengths that steps may have: longest_step times sampled_step_share() of each.
  int levels = 0;
};
/// Cells; half the width of a block.
inline constexpr double longest_sampled_step = 4;
inline constexpr int max_sampled_step_levels = 11;
/// Returns the length of a level's steps, of that of the longest.
constexpr float sampled_step_share(int level) noexcept {
  return (level % 2 == 0 ? 1 : 0.7071068f) / static_cast<float>(1 << level / 2);
}

/// The classes of a grid's blocks, in the order of BlockRecords. A view; owns nothing. Built by
/// scene/internal/block_classes_storage.h.
struct BlockClasses {
  const BlockClass* block = nullptr;

  static constexpr int highest_level = 7;

  PELLUCID_HD const BlockClass& operator[](int index) const noexcept { return block[index]; }
};

/// Records and classes of all blocks, for rays. Views; own nothing.
struct ClassifiedBlocks {
  BlockRecords records;
  BlockClasses classes;
};

}  // namespace pellucid
