// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/native_sse4.h"

#if PELLUCID_HAS_BATCH_8
namespace pellucid::detail {

/// Members as in Native<4>.
template <>
struct Native<8> : LibraryOperations {
  using Arch = xsimd::fma3<xsimd::avx2>;
  using Float = __m256;
  using Int = __m256i;
  using Double = __m256d;

  using Mask = __m256;
  struct WideMask {
    __m256d low, high;
  };
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<float, Arch> m) noexcept { return m; }
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<std::int32_t, Arch> m) noexcept {
    return _mm256_castsi256_ps(m);
  }
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<double, Arch> low,
                                          xsimd::batch_bool<double, Arch> high) noexcept {
    const __m256 halves = _mm256_shuffle_ps(_mm256_castpd_ps(low), _mm256_castpd_ps(high), 0x88);
    return _mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(halves), 0xd8));
  }
  PELLUCID_ALWAYS_INLINE static WideMask widen(Mask m) noexcept {
    const __m128i low = _mm_castps_si128(_mm256_castps256_ps128(m));
    const __m128i high = _mm_castps_si128(_mm256_extractf128_ps(m, 1));
    return {_mm256_castsi256_pd(_mm256_cvtepi32_epi64(low)),
            _mm256_castsi256_pd(_mm256_cvtepi32_epi64(high))};
  }
  PELLUCID_ALWAYS_INLINE static Mask none() noexcept { return _mm256_setzero_ps(); }
  PELLUCID_ALWAYS_INLINE static Mask every() noexcept {
    return _mm256_castsi256_ps(_mm256_set1_epi32(-1));
  }
  PELLUCID_ALWAYS_INLINE static Mask mask_of_bits(unsigned bits) noexcept {
    const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), lane);
    return _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, lane));
  }
  PELLUCID_ALWAYS_INLINE static unsigned bits(Mask m) noexcept {
    return static_cast<unsigned>(_mm256_movemask_ps(m));
  }
  PELLUCID_ALWAYS_INLINE static Mask both(Mask a, Mask b) noexcept { return _mm256_and_ps(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask either(Mask a, Mask b) noexcept { return _mm256_or_ps(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask differ(Mask a, Mask b) noexcept { return _mm256_xor_ps(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask both_not(Mask a, Mask b) noexcept {
    return _mm256_andnot_ps(b, a);
  }

  PELLUCID_ALWAYS_INLINE static Float choose(Mask m, Float a, Float b) noexcept {
    return _mm256_blendv_ps(b, a, m);
  }
  PELLUCID_ALWAYS_INLINE static Int choose(Mask m, Int a, Int b) noexcept {
    return _mm256_blendv_epi8(b, a, _mm256_castps_si256(m));
  }
  PELLUCID_ALWAYS_INLINE static Double choose(__m256d m, Double a, Double b) noexcept {
    return _mm256_blendv_pd(b, a, m);
  }

  PELLUCID_ALWAYS_INLINE static Float flip(Float a, Float b) noexcept {
    return _mm256_xor_ps(a, b);
  }
  PELLUCID_ALWAYS_INLINE static Double flip(Double a, Double b) noexcept {
    return _mm256_xor_pd(a, b);
  }
  PELLUCID_ALWAYS_INLINE static Float merge(Float sign_bit, Float s, Float x) noexcept {
    return _mm256_or_ps(_mm256_and_ps(sign_bit, s), _mm256_andnot_ps(sign_bit, x));
  }
  PELLUCID_ALWAYS_INLINE static Double merge(Double sign_bit, Double s, Double x) noexcept {
    return _mm256_or_pd(_mm256_and_pd(sign_bit, s), _mm256_andnot_pd(sign_bit, x));
  }

  static constexpr bool has_fma = true;
  PELLUCID_ALWAYS_INLINE static Float fused(Float a, Float b, Float c) noexcept {
    return _mm256_fmadd_ps(a, b, c);
  }
  PELLUCID_ALWAYS_INLINE static Double fused(Double a, Double b, Double c) noexcept {
    return _mm256_fmadd_pd(a, b, c);
  }

  PELLUCID_ALWAYS_INLINE static Float round_down(Float x) noexcept { return _mm256_floor_ps(x); }
  PELLUCID_ALWAYS_INLINE static Double round_down(Double x) noexcept { return _mm256_floor_pd(x); }
  PELLUCID_ALWAYS_INLINE static Float round_to_nearest(Float x) noexcept {
    return _mm256_round_ps(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  }
  PELLUCID_ALWAYS_INLINE static Double round_to_nearest(Double x) noexcept {
    return _mm256_round_pd(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  }

  PELLUCID_ALWAYS_INLINE static Float scale(Float x, Float n) noexcept {
    const __m256i whole = _mm256_cvtps_epi32(n), half = _mm256_srai_epi32(whole, 1);
    const __m256i rest = _mm256_sub_epi32(whole, half), bias = _mm256_set1_epi32(127);
    const __m256 p = _mm256_castsi256_ps(_mm256_slli_epi32(_mm256_add_epi32(half, bias), 23));
    const __m256 q = _mm256_castsi256_ps(_mm256_slli_epi32(_mm256_add_epi32(rest, bias), 23));
    return _mm256_mul_ps(_mm256_mul_ps(x, p), q);
  }
  PELLUCID_ALWAYS_INLINE static Double scale(Double x, Double n) noexcept {
    const __m128i whole = _mm256_cvtpd_epi32(n), half = _mm_srai_epi32(whole, 1);
    const __m128i rest = _mm_sub_epi32(whole, half), bias = _mm_set1_epi32(1023);
    const __m256i p = _mm256_slli_epi64(_mm256_cvtepi32_epi64(_mm_add_epi32(half, bias)), 52);
    const __m256i q = _mm256_slli_epi64(_mm256_cvtepi32_epi64(_mm_add_epi32(rest, bias)), 52);
    return _mm256_mul_pd(_mm256_mul_pd(x, _mm256_castsi256_pd(p)), _mm256_castsi256_pd(q));
  }

  PELLUCID_ALWAYS_INLINE static Int to_int(Float x) noexcept { return _mm256_cvttps_epi32(x); }
  PELLUCID_ALWAYS_INLINE static Int to_int(Double low, Double high) noexcept {
    return _mm256_set_m128i(_mm256_cvttpd_epi32(high), _mm256_cvttpd_epi32(low));
  }
  PELLUCID_ALWAYS_INLINE static Float to_float(Int x) noexcept { return _mm256_cvtepi32_ps(x); }
  PELLUCID_ALWAYS_INLINE static Float to_float(Double low, Double high) noexcept {
    return _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
  }
  PELLUCID_ALWAYS_INLINE static Float unsigned_to_float(Int x) noexcept {
    const __m256 high = _mm256_cvtepi32_ps(_mm256_srli_epi32(x, 16));
    const __m256 low = _mm256_cvtepi32_ps(_mm256_and_si256(x, _mm256_set1_epi32(0xffff)));
    return _mm256_add_ps(_mm256_mul_ps(high, _mm256_set1_ps(65536.0f)), low);
  }
  PELLUCID_ALWAYS_INLINE static void to_double(Float x, Double& low, Double& high) noexcept {
    low = _mm256_cvtps_pd(_mm256_castps256_ps128(x));
    high = _mm256_cvtps_pd(_mm256_extractf128_ps(x, 1));
  }
  PELLUCID_ALWAYS_INLINE static void to_double(Int x, Double& low, Double& high) noexcept {
    low = _mm256_cvtepi32_pd(_mm256_castsi256_si128(x));
    high = _mm256_cvtepi32_pd(_mm256_extracti128_si256(x, 1));
  }

  PELLUCID_ALWAYS_INLINE static Float gather(const float* base, Int index) noexcept {
    return _mm256_i32gather_ps(base, index, 4);
  }
  PELLUCID_ALWAYS_INLINE static Int gather(const std::int32_t* base, Int index) noexcept {
    return _mm256_i32gather_epi32(base, index, 4);
  }
  PELLUCID_ALWAYS_INLINE static void gather(const double* base, Int index, Double& low,
                                            Double& high) noexcept {
    low = _mm256_i32gather_pd(base, _mm256_castsi256_si128(index), 8);
    high = _mm256_i32gather_pd(base, _mm256_extracti128_si256(index, 1), 8);
  }

  template <class T>
  static constexpr bool has_lookup = std::is_same_v<T, float>;
  PELLUCID_ALWAYS_INLINE static Float lookup(const float* table, Int index) noexcept {
    const __m256 low = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table), index);
    const __m256 high = _mm256_permutevar8x32_ps(_mm256_loadu_ps(table + 8), index);
    return _mm256_blendv_ps(low, high, _mm256_castsi256_ps(_mm256_slli_epi32(index, 28)));
  }

  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static void pairs(const Value* const* base, Offset offset, Float& first,
                                           Float& second) noexcept {
    // Shuffles act within blocks of four lanes: lanes 0 1 and 4 5 in one register, 2 3 and 6 7 in
    // the other.
    using Block = PairBlock<Value>;
    const __m256 a = _mm256_set_m128(Block::two_lanes(base[4] + offset[4], base[5] + offset[5]),
                                     Block::two_lanes(base[0] + offset[0], base[1] + offset[1]));
    const __m256 b = _mm256_set_m128(Block::two_lanes(base[6] + offset[6], base[7] + offset[7]),
                                     Block::two_lanes(base[2] + offset[2], base[3] + offset[3]));
    first = _mm256_shuffle_ps(a, b, 0x88);
    second = _mm256_shuffle_ps(a, b, 0xdd);
  }
  static constexpr bool has_pairs_in_rows = false;
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static Int words(const Value* const* base, Offset offset) noexcept {
    return _mm256_set_m128i(four_words(base + 4, offset + 4), four_words(base, offset));
  }
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static Int bytes(const Value* const* base, Offset offset) noexcept {
    return _mm256_cvtepu16_epi32(short_words<8>(base, offset));
  }

  PELLUCID_ALWAYS_INLINE static void four_fields(const float* base, std::ptrdiff_t stride,
                                                 const std::int32_t* index, Float* out) noexcept {
    __m256 r[4];
    for (int j = 0; j < 4; ++j) {
      r[j] = _mm256_set_m128(_mm_loadu_ps(base + stride * index[4 + j]),
                             _mm_loadu_ps(base + stride * index[j]));
    }
    const __m256 a = _mm256_unpacklo_ps(r[0], r[1]), b = _mm256_unpackhi_ps(r[0], r[1]);
    const __m256 c = _mm256_unpacklo_ps(r[2], r[3]), d = _mm256_unpackhi_ps(r[2], r[3]);
    out[0] = _mm256_shuffle_ps(a, c, 0x44);
    out[1] = _mm256_shuffle_ps(a, c, 0xee);
    out[2] = _mm256_shuffle_ps(b, d, 0x44);
    out[3] = _mm256_shuffle_ps(b, d, 0xee);
  }
  PELLUCID_ALWAYS_INLINE static void store_four_fields(const Float* in, float* base,
                                                       std::ptrdiff_t stride,
                                                       const std::int32_t* index) noexcept {
    const __m256 a = _mm256_unpacklo_ps(in[0], in[1]), b = _mm256_unpackhi_ps(in[0], in[1]);
    const __m256 c = _mm256_unpacklo_ps(in[2], in[3]), d = _mm256_unpackhi_ps(in[2], in[3]);
    const __m256 r[4] = {_mm256_shuffle_ps(a, c, 0x44), _mm256_shuffle_ps(a, c, 0xee),
                         _mm256_shuffle_ps(b, d, 0x44), _mm256_shuffle_ps(b, d, 0xee)};
    for (int j = 0; j < 4; ++j) {
      _mm_storeu_ps(base + stride * index[j], _mm256_castps256_ps128(r[j]));
      _mm_storeu_ps(base + stride * index[4 + j], _mm256_extractf128_ps(r[j], 1));
    }
  }

  PELLUCID_ALWAYS_INLINE static void four_doubles(const double* base, const std::int32_t* index,
                                                  Double* low, Double* high) noexcept {
    Double* const half[2] = {low, high};
    for (int h = 0; h < 2; ++h) {
      __m256d r[4];
      for (int j = 0; j < 4; ++j) {
        r[j] = _mm256_loadu_pd(base + 4 * static_cast<std::ptrdiff_t>(index[4 * h + j]));
      }
      const __m256d a = _mm256_unpacklo_pd(r[0], r[1]), b = _mm256_unpackhi_pd(r[0], r[1]);
      const __m256d c = _mm256_unpacklo_pd(r[2], r[3]), d = _mm256_unpackhi_pd(r[2], r[3]);
      half[h][0] = _mm256_permute2f128_pd(a, c, 0x20);
      half[h][1] = _mm256_permute2f128_pd(b, d, 0x20);
      half[h][2] = _mm256_permute2f128_pd(a, c, 0x31);
      half[h][3] = _mm256_permute2f128_pd(b, d, 0x31);
    }
  }

  static constexpr bool has_packing = false;
};

}  // namespace pellucid::detail
#endif
