// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch.h"

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
namespace pellucid {

/// Which primitives may matter to the ray of each lane: as PrimitiveSet.
template <int N>
struct LanePrimitiveSets {
  using I = Batch<std::int32_t, N>;

  I low{0}, high{0};

  BatchMask<N> contains(int primitive) const noexcept {
    return ((is_high(primitive) ? high : low) & bit(primitive)) != I(0);
  }
  void add(BatchMask<N> lanes, int primitive) noexcept {
    I& word = is_high(primitive) ? high : low;
    word = word | select(lanes, bit(primitive), I(0));
  }

 private:
  static bool is_high(int primitive) noexcept { return (primitive & 32) != 0; }
  static I bit(int primitive) noexcept {
    return I(static_cast<std::int32_t>(1u << (primitive & 31)));
  }
};

}  // namespace pellucid
#endif
