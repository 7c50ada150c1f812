// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

/// Which widths there are in this translation unit. Every source for AArch64 may use NEON; those
/// have batches that are compiled for it as an instruction set, as on x86-64.
#if defined(__SSE4_1__)
#define PELLUCID_HAS_SSE4 1
#else
#define PELLUCID_HAS_SSE4 0
#endif
#if defined(__aarch64__) && defined(__ARM_NEON) && defined(PELLUCID_INSTRUCTION_SET)
#define PELLUCID_HAS_NEON64 1
#else
#define PELLUCID_HAS_NEON64 0
#endif
#define PELLUCID_HAS_BATCH_4 (PELLUCID_HAS_SSE4 || PELLUCID_HAS_NEON64)
#if defined(__AVX2__) && defined(__FMA__)
#define PELLUCID_HAS_BATCH_8 1
#else
#define PELLUCID_HAS_BATCH_8 0
#endif
#if defined(__AVX512F__) && defined(__AVX512CD__) && defined(__AVX512DQ__) && \
    defined(__AVX512BW__) && defined(__AVX512VL__)
#define PELLUCID_HAS_BATCH_16 1
#else
#define PELLUCID_HAS_BATCH_16 0
#endif

#if PELLUCID_HAS_BATCH_4
#if PELLUCID_HAS_NEON64
#include <arm_neon.h>
#else
#include <immintrin.h>
#endif
#if __has_include(<xsimd/xsimd.hpp>)
#include <xsimd/xsimd.hpp>
#else
#error "pellucid/simd/batch.h needs the headers of xsimd 8.1 or later (Debian: libxsimd-dev)"
#endif
#endif

/// On what must never become a call: a batch that crosses one goes through memory.
#define PELLUCID_ALWAYS_INLINE [[gnu::always_inline]] inline

namespace pellucid::detail {

/// Per width: see native_sse4.h, which says what each of its members is.
template <int N>
struct Native;

#if PELLUCID_HAS_SSE4
/// Operations that the SIMD library has right on x86-64. A NaN among the arguments of lesser() and
/// greater() gives y.
struct LibraryOperations {
  template <class Register>
  PELLUCID_ALWAYS_INLINE static Register lesser(Register x, Register y) noexcept {
    return xsimd::min(x, y);
  }
  template <class Register>
  PELLUCID_ALWAYS_INLINE static Register greater(Register x, Register y) noexcept {
    return xsimd::max(x, y);
  }
  template <class Register>
  PELLUCID_ALWAYS_INLINE static Register quotient(Register x, Register y) noexcept {
    return x / y;
  }
  template <class Register>
  PELLUCID_ALWAYS_INLINE static Register root(Register x) noexcept {
    return xsimd::sqrt(x);
  }
  template <class Register>
  PELLUCID_ALWAYS_INLINE static Register shift_left(Register x, int n) noexcept {
    return x << n;
  }
  template <class Register>
  PELLUCID_ALWAYS_INLINE static Register shift_right(Register x, int n) noexcept {
    return x >> n;
  }
};
#endif

}  // namespace pellucid::detail
