// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/native_base.h"

#if PELLUCID_HAS_SSE4
namespace pellucid::detail {

/// Blocks of four lanes, of which the wider machines' registers are put together. Each reads
/// exactly the two values of each lane, and nothing beyond.
template <class Value>
struct PairBlock {
  /// Loads the first and second value of two lanes: f0 s0 f1 s1, as 32-bit words. Values of 4
  /// bytes.
  PELLUCID_ALWAYS_INLINE static __m128 two_lanes(const Value* p0, const Value* p1) noexcept {
    static_assert(sizeof(Value) == 4);
    const __m128i a = _mm_loadu_si64(p0), b = _mm_loadu_si64(p1);
    return _mm_castsi128_ps(_mm_unpacklo_epi64(a, b));
  }
};

/// Doubles are rounded to float on the way.
template <>
struct PairBlock<double> {
  PELLUCID_ALWAYS_INLINE static __m128 two_lanes(const double* p0, const double* p1) noexcept {
    return _mm_movelh_ps(_mm_cvtpd_ps(_mm_loadu_pd(p0)), _mm_cvtpd_ps(_mm_loadu_pd(p1)));
  }
};

/// Loads both values of four lanes: values of 2 bytes, one 32-bit word per lane.
template <class Value, class Offset>
PELLUCID_ALWAYS_INLINE __m128i four_words(const Value* const* base, Offset offset) noexcept {
  static_assert(sizeof(Value) == 2);
  const __m128i a = _mm_loadu_si32(base[0] + offset[0]), b = _mm_loadu_si32(base[1] + offset[1]),
                c = _mm_loadu_si32(base[2] + offset[2]), d = _mm_loadu_si32(base[3] + offset[3]);
  return _mm_unpacklo_epi64(_mm_unpacklo_epi32(a, b), _mm_unpacklo_epi32(c, d));
}

/// Loads both values of Lanes <= 8 lanes: values of 1 byte, one 16-bit word per lane.
template <int Lanes, class Value, class Offset>
PELLUCID_ALWAYS_INLINE __m128i short_words(const Value* const* base, Offset offset) noexcept {
  static_assert(sizeof(Value) == 1);
  const auto word = [&](int lane) __attribute__((always_inline)) {
    short both;
    __builtin_memcpy(&both, base[lane] + offset[lane], 2);
    return both;
  };
  __m128i x = _mm_setzero_si128();
  x = _mm_insert_epi16(x, word(0), 0);
  x = _mm_insert_epi16(x, word(1), 1);
  x = _mm_insert_epi16(x, word(2), 2);
  x = _mm_insert_epi16(x, word(3), 3);
  if constexpr (Lanes == 8) {
    x = _mm_insert_epi16(x, word(4), 4);
    x = _mm_insert_epi16(x, word(5), 5);
    x = _mm_insert_epi16(x, word(6), 6);
    x = _mm_insert_epi16(x, word(7), 7);
  }
  return x;
}

template <>
struct Native<4> : LibraryOperations {
  using Arch = xsimd::sse4_1;
  using Float = __m128;
  using Int = __m128i;
  using Double = __m128d;

  /// A mask is what a comparison of floats gives: all bits of a lane or none. Comparisons of
  /// doubles give two halves of twice the width, which are narrowed to one mask, and widened where
  /// they choose doubles.
  using Mask = __m128;
  struct WideMask {
    __m128d low, high;
  };
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<float, Arch> m) noexcept { return m; }
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<std::int32_t, Arch> m) noexcept {
    return _mm_castsi128_ps(m);
  }
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<double, Arch> low,
                                          xsimd::batch_bool<double, Arch> high) noexcept {
    return _mm_shuffle_ps(_mm_castpd_ps(low), _mm_castpd_ps(high), 0x88);
  }
  PELLUCID_ALWAYS_INLINE static WideMask widen(Mask m) noexcept {
    return {_mm_castps_pd(_mm_unpacklo_ps(m, m)), _mm_castps_pd(_mm_unpackhi_ps(m, m))};
  }
  PELLUCID_ALWAYS_INLINE static Mask none() noexcept { return _mm_setzero_ps(); }
  PELLUCID_ALWAYS_INLINE static Mask every() noexcept {
    return _mm_castsi128_ps(_mm_set1_epi32(-1));
  }
  PELLUCID_ALWAYS_INLINE static Mask mask_of_bits(unsigned bits) noexcept {
    const __m128i lane = _mm_setr_epi32(1, 2, 4, 8);
    const __m128i set = _mm_and_si128(_mm_set1_epi32(static_cast<int>(bits)), lane);
    return _mm_castsi128_ps(_mm_cmpeq_epi32(set, lane));
  }
  PELLUCID_ALWAYS_INLINE static unsigned bits(Mask m) noexcept {
    return static_cast<unsigned>(_mm_movemask_ps(m));
  }
  PELLUCID_ALWAYS_INLINE static Mask both(Mask a, Mask b) noexcept { return _mm_and_ps(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask either(Mask a, Mask b) noexcept { return _mm_or_ps(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask differ(Mask a, Mask b) noexcept { return _mm_xor_ps(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask both_not(Mask a, Mask b) noexcept {
    return _mm_andnot_ps(b, a);  // a and not b
  }

  PELLUCID_ALWAYS_INLINE static Float choose(Mask m, Float a, Float b) noexcept {
    return _mm_blendv_ps(b, a, m);
  }
  PELLUCID_ALWAYS_INLINE static Int choose(Mask m, Int a, Int b) noexcept {
    return _mm_blendv_epi8(b, a, _mm_castps_si128(m));
  }
  PELLUCID_ALWAYS_INLINE static Double choose(__m128d m, Double a, Double b) noexcept {
    return _mm_blendv_pd(b, a, m);
  }

  /// Return the numbers with sign bits flipped, taken or put.
  PELLUCID_ALWAYS_INLINE static Float flip(Float a, Float b) noexcept { return _mm_xor_ps(a, b); }
  PELLUCID_ALWAYS_INLINE static Double flip(Double a, Double b) noexcept {
    return _mm_xor_pd(a, b);
  }
  PELLUCID_ALWAYS_INLINE static Float merge(Float sign_bit, Float s, Float x) noexcept {
    return _mm_or_ps(_mm_and_ps(sign_bit, s), _mm_andnot_ps(sign_bit, x));
  }
  PELLUCID_ALWAYS_INLINE static Double merge(Double sign_bit, Double s, Double x) noexcept {
    return _mm_or_pd(_mm_and_pd(sign_bit, s), _mm_andnot_pd(sign_bit, x));
  }

#if defined(__FMA__)
  static constexpr bool has_fma = true;
  PELLUCID_ALWAYS_INLINE static Float fused(Float a, Float b, Float c) noexcept {
    return _mm_fmadd_ps(a, b, c);
  }
  PELLUCID_ALWAYS_INLINE static Double fused(Double a, Double b, Double c) noexcept {
    return _mm_fmadd_pd(a, b, c);
  }
#else
  /// No such instruction: lane by lane, by calls.
  static constexpr bool has_fma = false;
  static Float fused(Float a, Float b, Float c) noexcept {
    alignas(16) float p[4], q[4], r[4];
    _mm_store_ps(p, a);
    _mm_store_ps(q, b);
    _mm_store_ps(r, c);
    for (int i = 0; i < 4; ++i) r[i] = __builtin_fmaf(p[i], q[i], r[i]);
    return _mm_load_ps(r);
  }
  static Double fused(Double a, Double b, Double c) noexcept {
    alignas(16) double p[2], q[2], r[2];
    _mm_store_pd(p, a);
    _mm_store_pd(q, b);
    _mm_store_pd(r, c);
    for (int i = 0; i < 2; ++i) r[i] = __builtin_fma(p[i], q[i], r[i]);
    return _mm_load_pd(r);
  }
#endif

  PELLUCID_ALWAYS_INLINE static Float round_down(Float x) noexcept {
    return _mm_floor_ps(x);
  }
  PELLUCID_ALWAYS_INLINE static Double round_down(Double x) noexcept {
    return _mm_floor_pd(x);
  }
  PELLUCID_ALWAYS_INLINE static Float round_to_nearest(Float x) noexcept {
    return _mm_round_ps(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  }
  PELLUCID_ALWAYS_INLINE static Double round_to_nearest(Double x) noexcept {
    return _mm_round_pd(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  }

  /// Returns x 2^n for whole n, |n| <= 2^8 (float), 2^11 (double): by two factors, so that neither
  /// over- nor underflows before the result does, which is then rounded once.
  PELLUCID_ALWAYS_INLINE static Float scale(Float x, Float n) noexcept {
    const __m128i whole = _mm_cvtps_epi32(n), half = _mm_srai_epi32(whole, 1);
    const __m128i rest = _mm_sub_epi32(whole, half), bias = _mm_set1_epi32(127);
    const __m128 p = _mm_castsi128_ps(_mm_slli_epi32(_mm_add_epi32(half, bias), 23));
    const __m128 q = _mm_castsi128_ps(_mm_slli_epi32(_mm_add_epi32(rest, bias), 23));
    return _mm_mul_ps(_mm_mul_ps(x, p), q);
  }
  PELLUCID_ALWAYS_INLINE static Double scale(Double x, Double n) noexcept {
    const __m128i whole = _mm_cvtpd_epi32(n), half = _mm_srai_epi32(whole, 1);
    const __m128i rest = _mm_sub_epi32(whole, half), bias = _mm_set1_epi32(1023);
    const __m128i p = _mm_slli_epi64(_mm_cvtepi32_epi64(_mm_add_epi32(half, bias)), 52);
    const __m128i q = _mm_slli_epi64(_mm_cvtepi32_epi64(_mm_add_epi32(rest, bias)), 52);
    return _mm_mul_pd(_mm_mul_pd(x, _mm_castsi128_pd(p)), _mm_castsi128_pd(q));
  }

  PELLUCID_ALWAYS_INLINE static Int to_int(Float x) noexcept {
    return _mm_cvttps_epi32(x);
  }
  PELLUCID_ALWAYS_INLINE static Int to_int(Double low, Double high) noexcept {
    return _mm_unpacklo_epi64(_mm_cvttpd_epi32(low), _mm_cvttpd_epi32(high));
  }
  PELLUCID_ALWAYS_INLINE static Float to_float(Int x) noexcept {
    return _mm_cvtepi32_ps(x);
  }
  PELLUCID_ALWAYS_INLINE static Float to_float(Double low, Double high) noexcept {
    return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
  }
  /// Converts 0 ... 2^32 - 1, rounded once: the halves are exact, and so is the shift of the upper
  /// one.
  PELLUCID_ALWAYS_INLINE static Float unsigned_to_float(Int x) noexcept {
    const __m128 high = _mm_cvtepi32_ps(_mm_srli_epi32(x, 16));
    const __m128 low = _mm_cvtepi32_ps(_mm_and_si128(x, _mm_set1_epi32(0xffff)));
    return _mm_add_ps(_mm_mul_ps(high, _mm_set1_ps(65536.0f)), low);
  }
  PELLUCID_ALWAYS_INLINE static void to_double(Float x, Double& low, Double& high) noexcept {
    low = _mm_cvtps_pd(x);
    high = _mm_cvtps_pd(_mm_movehl_ps(x, x));
  }
  PELLUCID_ALWAYS_INLINE static void to_double(Int x, Double& low, Double& high) noexcept {
    low = _mm_cvtepi32_pd(x);
    high = _mm_cvtepi32_pd(_mm_unpackhi_epi64(x, x));
  }

  PELLUCID_ALWAYS_INLINE static Float gather(const float* base, Int index) noexcept {
    alignas(16) std::int32_t i[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(i), index);
    return _mm_setr_ps(base[i[0]], base[i[1]], base[i[2]], base[i[3]]);
  }
  PELLUCID_ALWAYS_INLINE static Int gather(const std::int32_t* base, Int index) noexcept {
    alignas(16) std::int32_t i[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(i), index);
    return _mm_setr_epi32(base[i[0]], base[i[1]], base[i[2]], base[i[3]]);
  }
  PELLUCID_ALWAYS_INLINE static void gather(const double* base, Int index, Double& low,
                                            Double& high) noexcept {
    alignas(16) std::int32_t i[4];
    _mm_store_si128(reinterpret_cast<__m128i*>(i), index);
    low = _mm_setr_pd(base[i[0]], base[i[1]]);
    high = _mm_setr_pd(base[i[2]], base[i[3]]);
  }

  /// True if there is a lookup() of 16 numbers in registers, index 0 … 15.
  template <class T>
  static constexpr bool has_lookup = false;

  /// Loads pairs of values of 4 or 8 bytes: 32-bit words of the first and of the second ones,
  /// doubles already rounded to float.
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static void pairs(const Value* const* base, Offset offset, Float& first,
                                           Float& second) noexcept {
    using Block = PairBlock<Value>;
    const __m128 a = Block::two_lanes(base[0] + offset[0], base[1] + offset[1]);
    const __m128 b = Block::two_lanes(base[2] + offset[2], base[3] + offset[3]);
    first = _mm_shuffle_ps(a, b, 0x88);
    second = _mm_shuffle_ps(a, b, 0xdd);
  }
  /// True if there is pairs_in_rows().
  static constexpr bool has_pairs_in_rows = false;
  /// Loads pairs of values of 2 bytes: one word per lane, the first value in its lower half.
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static Int words(const Value* const* base, Offset offset) noexcept {
    return four_words(base, offset);
  }
  /// Loads pairs of bytes: the first in the lowest byte of the lane, the second above, the rest 0.
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static Int bytes(const Value* const* base, Offset offset) noexcept {
    return _mm_cvtepu16_epi32(short_words<4>(base, offset));
  }

  /// Loads four consecutive floats of each lane, from base + stride · index[lane], transposed.
  PELLUCID_ALWAYS_INLINE static void four_fields(const float* base, std::ptrdiff_t stride,
                                                 const std::int32_t* index, Float* out) noexcept {
    __m128 r[4];
    for (int j = 0; j < 4; ++j) r[j] = _mm_loadu_ps(base + stride * index[j]);
    const __m128 a = _mm_unpacklo_ps(r[0], r[1]), b = _mm_unpackhi_ps(r[0], r[1]);
    const __m128 c = _mm_unpacklo_ps(r[2], r[3]), d = _mm_unpackhi_ps(r[2], r[3]);
    out[0] = _mm_movelh_ps(a, c);
    out[1] = _mm_movehl_ps(c, a);
    out[2] = _mm_movelh_ps(b, d);
    out[3] = _mm_movehl_ps(d, b);
  }
  /// Stores four floats of each lane, in[0] to in[3], at base + stride · index[lane].
  PELLUCID_ALWAYS_INLINE static void store_four_fields(const Float* in, float* base,
                                                       std::ptrdiff_t stride,
                                                       const std::int32_t* index) noexcept {
    const __m128 a = _mm_unpacklo_ps(in[0], in[1]), b = _mm_unpackhi_ps(in[0], in[1]);
    const __m128 c = _mm_unpacklo_ps(in[2], in[3]), d = _mm_unpackhi_ps(in[2], in[3]);
    _mm_storeu_ps(base + stride * index[0], _mm_movelh_ps(a, c));
    _mm_storeu_ps(base + stride * index[1], _mm_movehl_ps(c, a));
    _mm_storeu_ps(base + stride * index[2], _mm_movelh_ps(b, d));
    _mm_storeu_ps(base + stride * index[3], _mm_movehl_ps(d, b));
  }

  /// Loads the four doubles at base + 4 · index[lane] of every lane.
  PELLUCID_ALWAYS_INLINE static void four_doubles(const double* base, const std::int32_t* index,
                                                  Double* low, Double* high) noexcept {
    Double* const half[2] = {low, high};
    for (int h = 0; h < 2; ++h) {
      const double* const p = base + 4 * static_cast<std::ptrdiff_t>(index[2 * h]);
      const double* const q = base + 4 * static_cast<std::ptrdiff_t>(index[2 * h + 1]);
      for (int j = 0; j < 4; j += 2) {
        const __m128d a = _mm_loadu_pd(p + j), b = _mm_loadu_pd(q + j);
        half[h][j] = _mm_unpacklo_pd(a, b);
        half[h][j + 1] = _mm_unpackhi_pd(a, b);
      }
    }
  }

  /// True if there are store_packed() and load_spread().
  static constexpr bool has_packing = false;
};

}  // namespace pellucid::detail
#endif
