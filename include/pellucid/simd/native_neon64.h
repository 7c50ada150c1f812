// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/native_base.h"

#if PELLUCID_HAS_NEON64
namespace pellucid::detail {

/// Members as in Native<4> of native_sse4.h. The library's float quotient and square root are
/// approximate on this machine, and its minimum and maximum of a NaN are NaN.
template <>
struct Native<4> {
  using Arch = xsimd::neon64;
  using Float = float32x4_t;
  using Int = int32x4_t;
  using Double = float64x2_t;

  using Mask = uint32x4_t;
  struct WideMask {
    uint64x2_t low, high;
  };
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<float, Arch> m) noexcept { return m; }
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<std::int32_t, Arch> m) noexcept {
    return m;
  }
  PELLUCID_ALWAYS_INLINE static Mask mask(xsimd::batch_bool<double, Arch> low,
                                          xsimd::batch_bool<double, Arch> high) noexcept {
    return vcombine_u32(vmovn_u64(low), vmovn_u64(high));
  }
  PELLUCID_ALWAYS_INLINE static WideMask widen(Mask m) noexcept {
    return {vreinterpretq_u64_u32(vzip1q_u32(m, m)), vreinterpretq_u64_u32(vzip2q_u32(m, m))};
  }
  PELLUCID_ALWAYS_INLINE static Mask none() noexcept { return vdupq_n_u32(0); }
  PELLUCID_ALWAYS_INLINE static Mask every() noexcept { return vdupq_n_u32(~0u); }
  PELLUCID_ALWAYS_INLINE static Mask mask_of_bits(unsigned bits) noexcept {
    return vtstq_u32(vdupq_n_u32(bits), bit_of_lane());
  }
  PELLUCID_ALWAYS_INLINE static unsigned bits(Mask m) noexcept {
    return vaddvq_u32(vandq_u32(m, bit_of_lane()));
  }
  PELLUCID_ALWAYS_INLINE static Mask both(Mask a, Mask b) noexcept { return vandq_u32(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask either(Mask a, Mask b) noexcept { return vorrq_u32(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask differ(Mask a, Mask b) noexcept { return veorq_u32(a, b); }
  PELLUCID_ALWAYS_INLINE static Mask both_not(Mask a, Mask b) noexcept { return vbicq_u32(a, b); }

  PELLUCID_ALWAYS_INLINE static Float choose(Mask m, Float a, Float b) noexcept {
    return vbslq_f32(m, a, b);
  }
  PELLUCID_ALWAYS_INLINE static Int choose(Mask m, Int a, Int b) noexcept {
    return vbslq_s32(m, a, b);
  }
  PELLUCID_ALWAYS_INLINE static Double choose(uint64x2_t m, Double a, Double b) noexcept {
    return vbslq_f64(m, a, b);
  }

  PELLUCID_ALWAYS_INLINE static Float flip(Float a, Float b) noexcept {
    return vreinterpretq_f32_u32(veorq_u32(vreinterpretq_u32_f32(a), vreinterpretq_u32_f32(b)));
  }
  PELLUCID_ALWAYS_INLINE static Double flip(Double a, Double b) noexcept {
    return vreinterpretq_f64_u64(veorq_u64(vreinterpretq_u64_f64(a), vreinterpretq_u64_f64(b)));
  }
  PELLUCID_ALWAYS_INLINE static Float merge(Float sign_bit, Float s, Float x) noexcept {
    return vbslq_f32(vreinterpretq_u32_f32(sign_bit), s, x);
  }
  PELLUCID_ALWAYS_INLINE static Double merge(Double sign_bit, Double s, Double x) noexcept {
    return vbslq_f64(vreinterpretq_u64_f64(sign_bit), s, x);
  }

  PELLUCID_ALWAYS_INLINE static Float lesser(Float x, Float y) noexcept {
    return vbslq_f32(vcltq_f32(x, y), x, y);
  }
  PELLUCID_ALWAYS_INLINE static Double lesser(Double x, Double y) noexcept {
    return vbslq_f64(vcltq_f64(x, y), x, y);
  }
  PELLUCID_ALWAYS_INLINE static Int lesser(Int x, Int y) noexcept { return vminq_s32(x, y); }
  PELLUCID_ALWAYS_INLINE static Float greater(Float x, Float y) noexcept {
    return vbslq_f32(vcgtq_f32(x, y), x, y);
  }
  PELLUCID_ALWAYS_INLINE static Double greater(Double x, Double y) noexcept {
    return vbslq_f64(vcgtq_f64(x, y), x, y);
  }
  PELLUCID_ALWAYS_INLINE static Int greater(Int x, Int y) noexcept { return vmaxq_s32(x, y); }
  PELLUCID_ALWAYS_INLINE static Float quotient(Float x, Float y) noexcept {
    return vdivq_f32(x, y);
  }
  PELLUCID_ALWAYS_INLINE static Double quotient(Double x, Double y) noexcept {
    return vdivq_f64(x, y);
  }
  PELLUCID_ALWAYS_INLINE static Float root(Float x) noexcept { return vsqrtq_f32(x); }
  PELLUCID_ALWAYS_INLINE static Double root(Double x) noexcept { return vsqrtq_f64(x); }
  PELLUCID_ALWAYS_INLINE static Int shift_left(Int x, int n) noexcept {
    return vshlq_s32(x, vdupq_n_s32(n));
  }
  PELLUCID_ALWAYS_INLINE static Int shift_right(Int x, int n) noexcept {
    return vshlq_s32(x, vdupq_n_s32(-n));
  }

  static constexpr bool has_fma = true;
  PELLUCID_ALWAYS_INLINE static Float fused(Float a, Float b, Float c) noexcept {
    return vfmaq_f32(c, a, b);
  }
  PELLUCID_ALWAYS_INLINE static Double fused(Double a, Double b, Double c) noexcept {
    return vfmaq_f64(c, a, b);
  }

  PELLUCID_ALWAYS_INLINE static Float round_down(Float x) noexcept { return vrndmq_f32(x); }
  PELLUCID_ALWAYS_INLINE static Double round_down(Double x) noexcept { return vrndmq_f64(x); }
  PELLUCID_ALWAYS_INLINE static Float round_to_nearest(Float x) noexcept { return vrndnq_f32(x); }
  PELLUCID_ALWAYS_INLINE static Double round_to_nearest(Double x) noexcept { return vrndnq_f64(x); }

  PELLUCID_ALWAYS_INLINE static Float scale(Float x, Float n) noexcept {
    const int32x4_t whole = vcvtnq_s32_f32(n), half = vshrq_n_s32(whole, 1);
    const int32x4_t rest = vsubq_s32(whole, half), bias = vdupq_n_s32(127);
    const float32x4_t p = vreinterpretq_f32_s32(vshlq_n_s32(vaddq_s32(half, bias), 23));
    const float32x4_t q = vreinterpretq_f32_s32(vshlq_n_s32(vaddq_s32(rest, bias), 23));
    return vmulq_f32(vmulq_f32(x, p), q);
  }
  PELLUCID_ALWAYS_INLINE static Double scale(Double x, Double n) noexcept {
    const int64x2_t whole = vcvtnq_s64_f64(n), half = vshrq_n_s64(whole, 1);
    const int64x2_t rest = vsubq_s64(whole, half), bias = vdupq_n_s64(1023);
    const float64x2_t p = vreinterpretq_f64_s64(vshlq_n_s64(vaddq_s64(half, bias), 52));
    const float64x2_t q = vreinterpretq_f64_s64(vshlq_n_s64(vaddq_s64(rest, bias), 52));
    return vmulq_f64(vmulq_f64(x, p), q);
  }

  /// Converts to int. The machine gives the nearest int of what does not fit, and 0 of NaN; both
  /// become the smallest one.
  PELLUCID_ALWAYS_INLINE static Int to_int(Float x) noexcept {
    return vbslq_s32(vcltq_f32(x, vdupq_n_f32(0x1p31f)), vcvtq_s32_f32(x), vdupq_n_s32(smallest));
  }
  PELLUCID_ALWAYS_INLINE static Int to_int(Double low, Double high) noexcept {
    return vcombine_s32(to_two_ints(low), to_two_ints(high));
  }
  PELLUCID_ALWAYS_INLINE static Float to_float(Int x) noexcept { return vcvtq_f32_s32(x); }
  PELLUCID_ALWAYS_INLINE static Float to_float(Double low, Double high) noexcept {
    return vcombine_f32(vcvt_f32_f64(low), vcvt_f32_f64(high));
  }
  PELLUCID_ALWAYS_INLINE static Float unsigned_to_float(Int x) noexcept {
    return vcvtq_f32_u32(vreinterpretq_u32_s32(x));
  }
  PELLUCID_ALWAYS_INLINE static void to_double(Float x, Double& low, Double& high) noexcept {
    low = vcvt_f64_f32(vget_low_f32(x));
    high = vcvt_high_f64_f32(x);
  }
  PELLUCID_ALWAYS_INLINE static void to_double(Int x, Double& low, Double& high) noexcept {
    low = vcvtq_f64_s64(vmovl_s32(vget_low_s32(x)));
    high = vcvtq_f64_s64(vmovl_high_s32(x));
  }

  PELLUCID_ALWAYS_INLINE static Float gather(const float* base, Int index) noexcept {
    const float lane[4] = {base[vgetq_lane_s32(index, 0)], base[vgetq_lane_s32(index, 1)],
                           base[vgetq_lane_s32(index, 2)], base[vgetq_lane_s32(index, 3)]};
    return vld1q_f32(lane);
  }
  PELLUCID_ALWAYS_INLINE static Int gather(const std::int32_t* base, Int index) noexcept {
    const std::int32_t lane[4] = {base[vgetq_lane_s32(index, 0)], base[vgetq_lane_s32(index, 1)],
                                  base[vgetq_lane_s32(index, 2)], base[vgetq_lane_s32(index, 3)]};
    return vld1q_s32(lane);
  }
  PELLUCID_ALWAYS_INLINE static void gather(const double* base, Int index, Double& low,
                                            Double& high) noexcept {
    const double lane[4] = {base[vgetq_lane_s32(index, 0)], base[vgetq_lane_s32(index, 1)],
                            base[vgetq_lane_s32(index, 2)], base[vgetq_lane_s32(index, 3)]};
    low = vld1q_f64(lane);
    high = vld1q_f64(lane + 2);
  }

  template <class T>
  static constexpr bool has_lookup = false;

  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static void pairs(const Value* const* base, Offset offset, Float& first,
                                           Float& second) noexcept {
    const float32x4_t a = vcombine_f32(pair(base[0] + offset[0]), pair(base[1] + offset[1]));
    const float32x4_t b = vcombine_f32(pair(base[2] + offset[2]), pair(base[3] + offset[3]));
    first = vuzp1q_f32(a, b);
    second = vuzp2q_f32(a, b);
  }
  static constexpr bool has_pairs_in_rows = false;
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static Int words(const Value* const* base, Offset offset) noexcept {
    static_assert(sizeof(Value) == 2);
    std::int32_t lane[4];
    for (int l = 0; l < 4; ++l) __builtin_memcpy(&lane[l], base[l] + offset[l], 4);
    return vld1q_s32(lane);
  }
  template <class Value, class Offset>
  PELLUCID_ALWAYS_INLINE static Int bytes(const Value* const* base, Offset offset) noexcept {
    static_assert(sizeof(Value) == 1);
    std::uint16_t lane[4];
    for (int l = 0; l < 4; ++l) __builtin_memcpy(&lane[l], base[l] + offset[l], 2);
    return vreinterpretq_s32_u32(vmovl_u16(vld1_u16(lane)));
  }

  PELLUCID_ALWAYS_INLINE static void four_fields(const float* base, std::ptrdiff_t stride,
                                                 const std::int32_t* index, Float* out) noexcept {
    float32x4_t r[4];
    for (int j = 0; j < 4; ++j) r[j] = four_words(base + stride * index[j]);
    transpose(r, out);
  }
  PELLUCID_ALWAYS_INLINE static void store_four_fields(const Float* in, float* base,
                                                       std::ptrdiff_t stride,
                                                       const std::int32_t* index) noexcept {
    float32x4_t r[4];
    transpose(in, r);
    for (int j = 0; j < 4; ++j) vst1q_f32(base + stride * index[j], r[j]);
  }

  PELLUCID_ALWAYS_INLINE static void four_doubles(const double* base, const std::int32_t* index,
                                                  Double* low, Double* high) noexcept {
    Double* const half[2] = {low, high};
    for (int h = 0; h < 2; ++h) {
      const double* const p = base + 4 * static_cast<std::ptrdiff_t>(index[2 * h]);
      const double* const q = base + 4 * static_cast<std::ptrdiff_t>(index[2 * h + 1]);
      for (int j = 0; j < 4; j += 2) {
        const float64x2_t a = vld1q_f64(p + j), b = vld1q_f64(q + j);
        half[h][j] = vzip1q_f64(a, b);
        half[h][j + 1] = vzip2q_f64(a, b);
      }
    }
  }

  static constexpr bool has_packing = false;

 private:
  static constexpr std::int32_t smallest = -0x7fffffff - 1;

  PELLUCID_ALWAYS_INLINE static Mask bit_of_lane() noexcept {
    const std::uint32_t bit[4] = {1, 2, 4, 8};
    return vld1q_u32(bit);
  }
  PELLUCID_ALWAYS_INLINE static int32x2_t to_two_ints(Double x) noexcept {
    const uint64x2_t fits = vcltq_f64(x, vdupq_n_f64(0x1p31));
    return vqmovn_s64(vbslq_s64(fits, vcvtq_s64_f64(x), vdupq_n_s64(smallest)));
  }
  /// Loads two values of 4 bytes, whatever they are, or two doubles, rounded.
  template <class Value>
  PELLUCID_ALWAYS_INLINE static float32x2_t pair(const Value* from) noexcept {
    static_assert(sizeof(Value) == 4);
    return vreinterpret_f32_u8(vld1_u8(reinterpret_cast<const std::uint8_t*>(from)));
  }
  PELLUCID_ALWAYS_INLINE static float32x2_t pair(const double* from) noexcept {
    return vcvt_f32_f64(vld1q_f64(from));
  }
  /// Loads four floats, or ints under that name.
  PELLUCID_ALWAYS_INLINE static float32x4_t four_words(const float* from) noexcept {
    return vreinterpretq_f32_u8(vld1q_u8(reinterpret_cast<const std::uint8_t*>(from)));
  }
  PELLUCID_ALWAYS_INLINE static void transpose(const Float* in, Float* out) noexcept {
    const float64x2_t a = vreinterpretq_f64_f32(vzip1q_f32(in[0], in[1]));
    const float64x2_t b = vreinterpretq_f64_f32(vzip2q_f32(in[0], in[1]));
    const float64x2_t c = vreinterpretq_f64_f32(vzip1q_f32(in[2], in[3]));
    const float64x2_t d = vreinterpretq_f64_f32(vzip2q_f32(in[2], in[3]));
    out[0] = vreinterpretq_f32_f64(vzip1q_f64(a, c));
    out[1] = vreinterpretq_f32_f64(vzip2q_f64(a, c));
    out[2] = vreinterpretq_f32_f64(vzip1q_f64(b, d));
    out[3] = vreinterpretq_f32_f64(vzip2q_f64(b, d));
  }
};

}  // namespace pellucid::detail
#endif
