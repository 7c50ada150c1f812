// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace pellucid {

/// How much the data of a block and of all that touch it vary: the largest of their records'
/// (traverse/block_record.h), so that it holds for any way that begins or ends in the block and
/// goes no further than a block's width along each axis. Upper halves of floats, as there; infinite
/// near vacuum. In loads of 32 bits: oscillation x and y; oscillation z and bend x; bend y and z.
struct alignas(16) BlockVariation {
  std::uint16_t oscillation[3];
  std::uint16_t bend[3];
  std::uint16_t unused[2];
};
static_assert(sizeof(BlockVariation) == 16);

}  // namespace pellucid
