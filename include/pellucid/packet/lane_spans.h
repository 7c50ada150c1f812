// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Which rows of spans lanes have left to integrate, of at most 32 rows.
template <int N>
struct LaneSpans {
  using I = Batch<std::int32_t, N>;
  using M = BatchMask<N>;

  I waiting{0};      ///< the rows whose spans are not taken yet, a bit each
  M pending{false};  ///< whether a lane works on one

  void put_down(M found, int row) noexcept { waiting += select(found, I(1 << row), I(0)); }
  /// Lanes that can take another one.
  M ready() const noexcept { return (!pending) & (waiting != I(0)); }
  /// Takes from each of these lanes, all of which are to have some (ready()), the row that waits
  /// longest: from row `next` on, which is written next, and then from the first one. Calls
  /// take(lanes, at) for those that have the same row, whose numbers begin at `at`: rays beside
  /// each other are at nearly the same step, so that this is a few loads instead of a gather.
  template <class Take>
  void take_oldest(M lanes, int next, Take&& take) noexcept {
    const I old = waiting & I(static_cast<std::int32_t>(~0u << next));
    const I candidates = select(old != I(0), old, waiting);
    const I lowest_bit = select(lanes, candidates & (I(0) - candidates), I(0));
    waiting -= lowest_bit;
    std::int32_t bit_of[N];
    lowest_bit.store(bit_of);
    for (unsigned left = bits(lanes); left != 0;) {
      const std::int32_t bit = bit_of[__builtin_ctz(left)];
      const M here = lowest_bit == I(bit);
      take(here, __builtin_ctz(static_cast<unsigned>(bit)) * N);
      left &= ~bits(here);
    }
  }
  void forget(M lanes) noexcept {
    pending = pending & !lanes;
    waiting = select(lanes, I(0), waiting);
  }
};

}  // namespace pellucid
#endif
