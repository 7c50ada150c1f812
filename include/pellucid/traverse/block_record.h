// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "pellucid/simd/scalar.h"

namespace pellucid {

/// Cells along an axis of a block; the last block of an axis may have fewer.
inline constexpr int block_width = 8;

/// Share of a block's cells that are vacuum because a corner is NaN.
enum class BlockVacuum : std::uint8_t { none, some, all };

/// Record of a block of cells: bounds on its data and on their second differences, in 24 bytes (4.7
/// % of 8³ values of one byte). Twelve numbers of 16 bits in this order, so that two loads of 8 and
/// 16 bytes, or three of 8, take it in:
///
///   bytes  0 …  3  lower, upper  the range of the data, as codes (BlockCode)
///   bytes  4 …  9  bend          along x, y, z
///   bytes 10 … 15  twist         by y and z, z and x, x and y
///   bytes 16 … 21  oscillation   along x, y, z
///   bytes 22, 23   flags
///
/// bend, twist (CurvatureBounds) and oscillation (BlockRange) are the upper halves of floats,
/// rounded upward: shifted left by 16 bits they are the bits of a float that is a bound, infinite
/// or >= 0.
struct alignas(8) BlockRecord {
  std::uint16_t lower, upper;
  std::uint16_t second_difference[3], twist[3];
  std::uint16_t oscillation[3];
  std::uint16_t flags;  ///< bits 0 and 1: BlockVacuum; bit 2: constant

  static constexpr std::uint16_t vacuum_bits = 3, constant_bit = 4;

  PELLUCID_HD constexpr BlockVacuum vacuum() const noexcept {
    return static_cast<BlockVacuum>(flags & vacuum_bits);
  }
  /// Returns whether the data is one number all over the block, and no cell is vacuum.
  PELLUCID_HD constexpr bool constant() const noexcept { return (flags & constant_bit) != 0; }
};
static_assert(sizeof(BlockRecord) == 24 && alignof(BlockRecord) == 8);

/// Meaning of the codes of ranges: code c is the number minimum + c · step, as computed here. Both
/// operations round, so that the order of codes is that of their numbers; minimum is code 0, and
/// code `last` is not below the volume's maximum. For integers whose range has at most 65535 steps
/// of 1, step is 1 and the code of a datum is exact.
struct BlockCode {
  double minimum = 0, step = 0;
  int last = 0;  ///< the largest code in use, at most `highest`

  static constexpr int highest = 65535;

  PELLUCID_HD constexpr double value(int code) const noexcept { return minimum + code * step; }
};

/// Returns the float whose upper half this is.
PELLUCID_HD inline float from_upper_half(std::uint16_t half) noexcept {
  return __builtin_bit_cast(float, static_cast<std::uint32_t>(half) << 16);
}

}  // namespace pellucid
