// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/native_sse4.h"

#if PELLUCID_HAS_BATCH_16
namespace pellucid::detail {

/// Members as in Native<4>; a mask is one bit per lane.
template <>
struct Native<16> : LibraryOperations {
  using Arch = xsimd::avx512bw;
  using Float = __m512;
  using Int = __m512i;
  using Double = __m512d;

  using Mask = __mmask16;
  struct WideMask {
    __mmask8 low, high;
  };
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<float, Arch> m) noexcept { return m; }
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<std::int32_t, Arch> m) noexcept {
    return m;
  }
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<double, Arch> low,
                                          xsimd::batch_bool<double, Arch> high) noexcept {
    return _mm512_kunpackb(__mmask8(high), __mmask8(low));
  }
  PELLUCID_ALWAYS_INLINE static WideMask widen(Mask m) noexcept {
    return {static_cast<__mmask8>(m), static_cast<__mmask8>(m >> 8)};
  }
  PELLUCID_ALWAYS_INLINE static Mask none() noexcept { return 0; }
  PELLUCID_ALWAYS_INLINE static Mask every() noexcept { return 0xffff; }
  PELLUCID_ALWAYS_INLINE static Mask mask_of_bits(unsigned bits) noexcept {
    return static_cast<Mask>(bits);
  }
  PELLUCID_ALWAYS_INLINE static unsigned bits(Mask m) noexcept { return m; }
  PELLUCID_ALWAYS_INLINE static Mask both(Mask a, Mask b) noexcept { return _kand_mask16(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask either(Mask a, Mask b) noexcept { return _kor_mask16(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask differ(Mask a, Mask b) noexcept { return _kxor_mask16(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask both_not(Mask a, Mask b) noexcept {
    return _kandn_mask16(b, a);
  }

  PELLUCID_ALWAYS_INLINE static Float choose(Mask m, Float a, Float b) noexcept {
    return _mm512_mask_blend_ps(m, b, a);
  }
  PELLUCID_ALWAYS_INLINE static Int choose(Mask m, Int a, Int b) noexcept {
    return _mm512_mask_blend_epi32(m, b, a);
  }
  PELLUCID_ALWAYS_INLINE static Double choose(__mmask8 m, Double a, Double b) noexcept {
    return _mm512_mask_blend_pd(m, b, a);
  }

  PELLUCID_ALWAYS_INLINE static Float flip(Float a, Float b) noexcept {
    return _mm512_xor_ps(a, b);
  }
  PELLUCID_ALWAYS_INLINE static Double flip(Double a, Double b) noexcept {
    return _mm512_xor_pd(a, b);
  }
  // 0xca: the second where the first has a bit, else the third.
  PELLUCID_ALWAYS_INLINE static Float merge(Float sign_bit, Float s, Float x) noexcept {
    return _mm512_castsi512_ps(_mm512_ternarylogic_epi32(
        _mm512_castps_si512(sign_bit), _mm512_castps_si512(s), _mm512_castps_si512(x), 0xca));
  }
  PELLUCID_ALWAYS_INLINE static Double merge(Double sign_bit, Double s, Double x) noexcept {
    return _mm512_castsi512_pd(_mm512_ternarylogic_epi64(
        _mm512_castpd_si512(sign_bit), _mm512_castpd_si512(s), _mm512_castpd_si512(x), 0xca));
  }

  static constexpr bool has_fma = true;
  PELLUCID_ALWAYS_INLINE static Float fused(Float a, Float b, Float c) noexcept {
    return _mm512_fmadd_ps(a, b, c);
  }
  PELLUCID_ALWAYS_INLINE static Double fused(Double a, Double b, Double c) noexcept {
    return _mm512_fmadd_pd(a, b, c);
  }

  PELLUCID_ALWAYS_INLINE static Float round_down(Float x) noexcept {
    return _mm512_roundscale_ps(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
  }
  PELLUCID_ALWAYS_INLINE static Double round_down(Double x) noexcept {
    return _mm512_roundscale_pd(x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
  }
  PELLUCID_ALWAYS_INLINE static Float round_to_nearest(Float x) noexcept {
    return _mm512_roundscale_ps(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  }
  PELLUCID_ALWAYS_INLINE static Double round_to_nearest(Double x) noexcept {
    return _mm512_roundscale_pd(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  }

  PELLUCID_ALWAYS_INLINE static Float scale(Float x, Float n) noexcept {
    return _mm512_scalef_ps(x, n);
  }
  PELLUCID_ALWAYS_INLINE static Double scale(Double x, Double n) noexcept {
    return _mm512_scalef_pd(x, n);
  }

  PELLUCID_ALWAYS_INLINE static Int to_int(Float x) noexcept { return _mm512_cvttps_epi32(x); }
  PELLUCID_ALWAYS_INLINE static Int to_int(Double low, Double high) noexcept {
    return _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvttpd_epi32(low)),
                              _mm512_cvttpd_epi32(high), 1);
  }
  PELLUCID_ALWAYS_INLINE static Float to_float(Int x) noexcept { return _mm512_cvtepi32_ps(x); }
  PELLUCID_ALWAYS_INLINE static Float to_float(Double low, Double high) noexcept {
    return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high),
                              1);
  }
  PELLUCID_ALWAYS_INLINE static Float unsigned_to_float(Int x) noexcept {
    return _mm512_cvtepu32_ps(x);
  }
  PELLUCID_ALWAYS_INLINE static void to_double(Float x, Double& low, Double& high) noexcept {
    low = _mm512_cvtps_pd(_mm512_castps512_ps256(x));
    high = _mm512_cvtps_pd(_mm512_extractf32x8_ps(x, 1));
  }
  PELLUCID_ALWAYS_INLINE static void to_double(Int x, Double& low, Double& high) noexcept {
    low = _mm512_cvtepi32_pd(_mm512_castsi512_si256(x));
    high = _mm512_cvtepi32_pd(_mm512_extracti64x4_epi64(x, 1));
  }

  PELLUCID_ALWAYS_INLINE static Float gather(const float* base, Int index) noexcept {
    return _mm512_i32gather_ps(index, base, 4);
  }
  PELLUCID_ALWAYS_INLINE static Int gather(const std::int32_t* base, Int index) noexcept {
    return _mm512_i32gather_epi32(index, base, 4);
  }
  PELLUCID_ALWAYS_INLINE static void gather(const double* base, Int index, Double& low,
                                            Double& high) noexcept {
    low = _mm512_i32gather_pd(_mm512_castsi512_si256(index), base, 8);
    high = _mm512_i32gather_pd(_mm512_extracti64x4_epi64(index, 1), base, 8);
  }

  template <class T>
  static constexpr bool has_lookup = sizeof(T) == 4 || sizeof(T) == 8;
  PELLUCID_ALWAYS_INLINE static Float lookup(const float* table, Int index) noexcept {
    return _mm512_permutexvar_ps(index, _mm512_loadu_ps(table));
  }
  PELLUCID_ALWAYS_INLINE static Int lookup(const std::int32_t* table, Int index) noexcept {
    return _mm512_permutexvar_epi32(index, _mm512_loadu_si512(table));
  }
  PELLUCID_ALWAYS_INLINE static void lookup(const double* table, Int index, Double& low,
                                            Double& high) noexcept {
    const __m512d first = _mm512_loadu_pd(table), second = _mm512_loadu_pd(table + 8);
    const __m512i i_low = _mm512_cvtepi32_epi64(_mm512_castsi512_si256(index));
    const __m512i i_high = _mm512_cvtepi32_epi64(_mm512_extracti64x4_epi64(index, 1));
    low = _mm512_permutex2var_pd(first, i_low, second);
    high = _mm512_permutex2var_pd(first, i_high, second);
  }

  /// Joins four blocks of four lanes.
  PELLUCID_ALWAYS_INLINE static __m512 blocks(__m128 a, __m128 b, __m128 c, __m128 d) noexcept {
    const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(a), b, 1);
    const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(c), d, 1);
    return _mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1);
  }
  PELLUCID_ALWAYS_INLINE static __m512i blocks(__m128i a, __m128i b, __m128i c,
                                               __m128i d) noexcept {
    const __m256i low = _mm256_inserti128_si256(_mm256_castsi128_si256(a), b, 1);
    const __m256i high = _mm256_inserti128_si256(_mm256_castsi128_si256(c), d, 1);
    return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
  }

  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static void pairs(const Value* const* base, Offset offset, Float& first,
                                           Float& second) noexcept {
    // Shuffles act within blocks of four lanes: the lower two lanes of each block in one register,
    // the upper two in the other.
    const auto two = [&](int lane) __attribute__((always_inline)) {
      return PairBlock<Value>::two_lanes(base[lane] + offset[lane],
                                         base[lane + 1] + offset[lane + 1]);
    };
    const __m512 a = blocks(two(0), two(4), two(8), two(12));
    const __m512 b = blocks(two(2), two(6), two(10), two(14));
    first = _mm512_shuffle_ps(a, b, 0x88);
    second = _mm512_shuffle_ps(a, b, 0xdd);
  }
  static constexpr bool has_pairs_in_rows = true;
  /// Returns whether gathers of 64 bits take less than loads of 64 bits one by one: half as long on
  /// Intel's processors since Sapphire Rapids. Those before it may guard gathers against other
  /// programs that read along (Downfall), and AMD's take them apart.
  PELLUCID_ALWAYS_INLINE static bool gathers_are_fast() noexcept {
    return __builtin_cpu_is("intel") && __builtin_cpu_supports("avx512bf16") &&
           __builtin_cpu_supports("avx512vbmi2");
  }
  /// Gathers the pairs of each lane at base + offset + row[k]: first and second values of row k,
  /// both of 4 bytes, become out[2 k] and out[2 k + 1].
  template <class Value, std::size_t Rows>
  PELLUCID_ALWAYS_INLINE static void pairs_in_rows(const Value* const* base,
                                                   const std::int32_t* offset,
                                                   const std::ptrdiff_t (&row)[Rows],
                                                   Float* out) noexcept {
    static_assert(sizeof(Value) == 4 && sizeof(Value*) == 8);
    const auto address = [&](int lane) __attribute__((always_inline)) {
      const __m512i on = _mm512_cvtepi32_epi64(
          _mm256_loadu_si256(reinterpret_cast<const __m256i*>(offset + lane)));
      return _mm512_add_epi64(_mm512_loadu_si512(base + lane), _mm512_slli_epi64(on, 2));
    };
    const __m512i low = address(0), high = address(8);
    const __m512i first =
        _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    const __m512i second = _mm512_add_epi32(first, _mm512_set1_epi32(1));
    for (std::size_t k = 0; k < Rows; ++k) {
      const auto bytes = row[k] * static_cast<std::ptrdiff_t>(sizeof(Value));
      const auto pairs = [&](__m512i at) __attribute__((always_inline)) {
        return _mm512_castpd_ps(
            _mm512_i64gather_pd(_mm512_add_epi64(at, _mm512_set1_epi64(bytes)), nullptr, 1));
      };
      const __m512 a = pairs(low), b = pairs(high);
      out[2 * k] = _mm512_permutex2var_ps(a, first, b);
      out[2 * k + 1] = _mm512_permutex2var_ps(a, second, b);
    }
  }
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static Int words(const Value* const* base, Offset offset) noexcept {
    return blocks(four_words(base, offset), four_words(base + 4, offset + 4),
                  four_words(base + 8, offset + 8), four_words(base + 12, offset + 12));
  }
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static Int bytes(const Value* const* base, Offset offset) noexcept {
    return _mm512_cvtepu16_epi32(
        _mm256_set_m128i(short_words<8>(base + 8, offset + 8), short_words<8>(base, offset)));
  }

  PELLUCID_ALWAYS_INLINE static void four_fields(const float* base, std::ptrdiff_t stride,
                                                 const std::int32_t* index, Float* out) noexcept {
    __m512 r[4];
    for (int j = 0; j < 4; ++j) {
      r[j] = blocks(
          _mm_loadu_ps(base + stride * index[j]), _mm_loadu_ps(base + stride * index[4 + j]),
          _mm_loadu_ps(base + stride * index[8 + j]), _mm_loadu_ps(base + stride * index[12 + j]));
    }
    const __m512 a = _mm512_unpacklo_ps(r[0], r[1]), b = _mm512_unpackhi_ps(r[0], r[1]);
    const __m512 c = _mm512_unpacklo_ps(r[2], r[3]), d = _mm512_unpackhi_ps(r[2], r[3]);
    out[0] = _mm512_shuffle_ps(a, c, 0x44);
    out[1] = _mm512_shuffle_ps(a, c, 0xee);
    out[2] = _mm512_shuffle_ps(b, d, 0x44);
    out[3] = _mm512_shuffle_ps(b, d, 0xee);
  }
  PELLUCID_ALWAYS_INLINE static void store_four_fields(const Float* in, float* base,
                                                       std::ptrdiff_t stride,
                                                       const std::int32_t* index) noexcept {
    const __m512 a = _mm512_unpacklo_ps(in[0], in[1]), b = _mm512_unpackhi_ps(in[0], in[1]);
    const __m512 c = _mm512_unpacklo_ps(in[2], in[3]), d = _mm512_unpackhi_ps(in[2], in[3]);
    const __m512 r[4] = {_mm512_shuffle_ps(a, c, 0x44), _mm512_shuffle_ps(a, c, 0xee),
                         _mm512_shuffle_ps(b, d, 0x44), _mm512_shuffle_ps(b, d, 0xee)};
    for (int j = 0; j < 4; ++j) {
      _mm_storeu_ps(base + stride * index[j], _mm512_castps512_ps128(r[j]));
      _mm_storeu_ps(base + stride * index[4 + j], _mm512_extractf32x4_ps(r[j], 1));
      _mm_storeu_ps(base + stride * index[8 + j], _mm512_extractf32x4_ps(r[j], 2));
      _mm_storeu_ps(base + stride * index[12 + j], _mm512_extractf32x4_ps(r[j], 3));
    }
  }

  PELLUCID_ALWAYS_INLINE static void four_doubles(const double* base, const std::int32_t* index,
                                                  Double* low, Double* high) noexcept {
    const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13),
                  second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    Double* const half[2] = {low, high};
    for (int h = 0; h < 2; ++h) {
      const auto row = [&](int lane) __attribute__((always_inline)) {
        return _mm256_loadu_pd(base + 4 * static_cast<std::ptrdiff_t>(index[8 * h + lane]));
      };
      __m512d r[4];
      for (int j = 0; j < 4; ++j) {
        r[j] = _mm512_insertf64x4(_mm512_castpd256_pd512(row(j)), row(4 + j), 1);
      }
      const __m512d a = _mm512_unpacklo_pd(r[0], r[1]), b = _mm512_unpackhi_pd(r[0], r[1]);
      const __m512d c = _mm512_unpacklo_pd(r[2], r[3]), d = _mm512_unpackhi_pd(r[2], r[3]);
      half[h][0] = _mm512_permutex2var_pd(a, first, c);
      half[h][1] = _mm512_permutex2var_pd(b, first, d);
      half[h][2] = _mm512_permutex2var_pd(a, second, c);
      half[h][3] = _mm512_permutex2var_pd(b, second, d);
    }
  }

  static constexpr bool has_packing = true;
  PELLUCID_ALWAYS_INLINE static void store_packed(Mask m, Float x, float* to) noexcept {
    _mm512_storeu_ps(to, _mm512_maskz_compress_ps(m, x));
  }
  PELLUCID_ALWAYS_INLINE static void store_packed(Mask m, Int x, std::int32_t* to) noexcept {
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(m, x));
  }
  PELLUCID_ALWAYS_INLINE static void store_packed(Mask m, Double low, Double high,
                                                  double* to) noexcept {
    const WideMask wide = widen(m);
    _mm512_storeu_pd(to, _mm512_maskz_compress_pd(wide.low, low));
    _mm512_storeu_pd(to + __builtin_popcount(wide.low), _mm512_maskz_compress_pd(wide.high, high));
  }
  PELLUCID_ALWAYS_INLINE static Float load_spread(Mask m, const float* from, Float rest) noexcept {
    return _mm512_mask_expand_ps(rest, m, _mm512_loadu_ps(from));
  }
  PELLUCID_ALWAYS_INLINE static Int load_spread(Mask m, const std::int32_t* from,
                                                Int rest) noexcept {
    return _mm512_mask_expand_epi32(rest, m, _mm512_loadu_si512(from));
  }
  /// Reads beyond the numbers that the lower lanes take, but no more than 16 in all.
  template <class Part>
  PELLUCID_ALWAYS_INLINE static void load_spread(Mask m, const double* from, Part& low,
                                                 Part& high) noexcept {
    const WideMask wide = widen(m);
    low = _mm512_mask_expand_pd(low, wide.low, _mm512_loadu_pd(from));
    high = _mm512_mask_expand_pd(high, wide.high,
                                 _mm512_loadu_pd(from + __builtin_popcount(wide.low)));
  }
};

}  // namespace pellucid::detail
#endif
