// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

/// Which widths there are in this translation unit.
#if defined(__SSE4_1__)
#define PELLUCID_HAS_BATCH_4 1
#else
#define PELLUCID_HAS_BATCH_4 0
#endif
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
#include <immintrin.h>
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

}  // namespace pellucid::detail
