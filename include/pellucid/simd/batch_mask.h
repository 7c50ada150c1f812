// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/native.h"
#include "pellucid/simd/scalar.h"

#if PELLUCID_HAS_BATCH_4
namespace pellucid {

/// N truth values, one per lane: what comparisons of batches give, one type for all number types.
template <int N>
class BatchMask {
 public:
  using Native = detail::Native<N>;
  static constexpr int lanes = N;

  /// Makes a mask that is false in all lanes.
  PELLUCID_ALWAYS_INLINE BatchMask() noexcept : native(Native::none()) {}
  PELLUCID_ALWAYS_INLINE explicit BatchMask(bool all_lanes) noexcept
      : native(all_lanes ? Native::every() : Native::none()) {}
  /// Returns the mask of these bits; lane 0 is the lowest one.
  PELLUCID_ALWAYS_INLINE static BatchMask from_bits(unsigned bits) noexcept {
    return from_native(Native::mask_of_bits(bits));
  }
  PELLUCID_ALWAYS_INLINE static BatchMask from_native(typename Native::Mask m) noexcept {
    BatchMask mask;
    mask.native = m;
    return mask;
  }

  PELLUCID_ALWAYS_INLINE bool operator[](int lane) const noexcept {
    return ((Native::bits(native) >> lane) & 1u) != 0;
  }

  PELLUCID_ALWAYS_INLINE friend BatchMask operator&(BatchMask a, BatchMask b) noexcept {
    return from_native(Native::both(a.native, b.native));
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask operator|(BatchMask a, BatchMask b) noexcept {
    return from_native(Native::either(a.native, b.native));
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask operator^(BatchMask a, BatchMask b) noexcept {
    return from_native(Native::differ(a.native, b.native));
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask operator!(BatchMask a) noexcept {
    return from_native(Native::both_not(Native::every(), a.native));
  }
  /// Compares lane by lane, as two bool are compared.
  PELLUCID_ALWAYS_INLINE friend BatchMask operator==(BatchMask a, BatchMask b) noexcept {
    return !(a ^ b);
  }
  PELLUCID_ALWAYS_INLINE friend BatchMask operator!=(BatchMask a, BatchMask b) noexcept {
    return a ^ b;
  }
  PELLUCID_ALWAYS_INLINE BatchMask& operator&=(BatchMask b) noexcept { return *this = *this & b; }
  PELLUCID_ALWAYS_INLINE BatchMask& operator|=(BatchMask b) noexcept { return *this = *this | b; }
  PELLUCID_ALWAYS_INLINE BatchMask& operator^=(BatchMask b) noexcept { return *this = *this ^ b; }

  PELLUCID_ALWAYS_INLINE friend unsigned bits(BatchMask m) noexcept {
    return Native::bits(m.native);
  }
  PELLUCID_ALWAYS_INLINE friend bool any(BatchMask m) noexcept { return bits(m) != 0; }
  PELLUCID_ALWAYS_INLINE friend bool none(BatchMask m) noexcept { return bits(m) == 0; }
  PELLUCID_ALWAYS_INLINE friend bool all(BatchMask m) noexcept { return bits(m) == (1u << N) - 1u; }
  PELLUCID_ALWAYS_INLINE friend int count(BatchMask m) noexcept {
    return __builtin_popcount(bits(m));
  }

  PELLUCID_ALWAYS_INLINE friend BatchMask select(BatchMask m, BatchMask a, BatchMask b) noexcept {
    return from_native(
        Native::either(Native::both(m.native, a.native), Native::both_not(b.native, m.native)));
  }
  PELLUCID_ALWAYS_INLINE friend void assign(BatchMask m, BatchMask& target,
                                            BatchMask value) noexcept {
    target = select(m, value, target);
  }

  /// For this folder alone.
  typename Native::Mask native;
};

}  // namespace pellucid
#endif
