// SPDX-License-Identifier: Apache-2.0
#include "tests/simd/kernels.h"

#include "pellucid/error/bounds.h"
#include "pellucid/field/trilinear.h"
#include "pellucid/math/bernstein.h"
#include "pellucid/math/dawson.h"
#include "pellucid/math/error_function.h"
#include "pellucid/math/expm1_quotient_to_4.h"
#include "pellucid/math/scaled_tail.h"
#include "pellucid/segment/classical.h"
#include "pellucid/segment/gaussian_kniss.h"
#include "pellucid/segment/gaussian_line.h"
#include "pellucid/segment/gaussian_mixture.h"
#include "pellucid/segment/linear.h"
#include "pellucid/simd/batch.h"
#include "pellucid/simd/instruction_set.h"

namespace pellucid {
namespace {

#define UNARY(name)                                            \
  {                                                            \
#name, [](const T* x, T* y) { name(B::load(x)).store(y); } \
  }
template <class T, class B = Batch<T, PELLUCID_LANES>>
constexpr simd_kernels::Unary<T> unary[] = {
    UNARY(exp),
    UNARY(expm1_quotient),
    UNARY(expm1_quotient_derivative),
    UNARY(expm1_quotient_to_4),
    UNARY(one_minus_exp_neg),
    UNARY(exp_minus_square),
    UNARY(exp_square),
    UNARY(w0_plus),
    UNARY(w0_minus),
    UNARY(w1_plus),
    UNARY(w1_minus),
    UNARY(erf),
    UNARY(erfc),
    UNARY(erfcx),
    UNARY(dawson),
    UNARY(mean_color_bound),
};
#undef UNARY

template <class T>
struct On {
  using B = Batch<T, PELLUCID_LANES>;

  static void attenuation(const T* x, T* const out[2]) {
    const Attenuation<B> a = pellucid::attenuation(B::load(x));
    a.opacity.store(out[0]);
    a.transparency.store(out[1]);
  }

  static void linear(const T* f, const T* b, const T* length, T* const out[11]) {
    const LinearWeights<B> w = linear_weights(B::load(f), B::load(b), B::load(length));
    const EmissionWeights<B> e = emission_weights(B::load(f), B::load(b), B::load(length));
    int k = 0;
    for (const B& x : {w.optical_depth, w.opacity, w.transparency, w.psi, w.weight_f, w.weight_b,
                       e.optical_depth, e.opacity, e.transparency, e.weight_f, e.weight_b}) {
      x.store(out[k++]);
    }
  }

  static void bernstein(const T* const b[4], const T* ta, const T* tb, T* const out[5]) {
    CubicBernstein<B> f;
    for (int k = 0; k < 4; ++k) f.b[k] = B::load(b[k]);
    evaluate(f, B::load(ta)).store(out[0]);
    const CubicBernstein<B> part = restrict_to(f, B::load(ta), B::load(tb));
    for (int k = 0; k < 4; ++k) part.b[k].store(out[k + 1]);
  }

  static void trilinear(const T* const corners[8], const T* const entry[3], const T* const exit[3],
                        T* const out[4]) {
    CellCorners<B> v;
    for (int k = 0; k < 8; ++k) v.value[k] = B::load(corners[k]);
    const CubicBernstein<B> f =
        trilinear_cubic(v, Vec3<B>{B::load(entry[0]), B::load(entry[1]), B::load(entry[2])},
                        Vec3<B>{B::load(exit[0]), B::load(exit[1]), B::load(exit[2])});
    for (int k = 0; k < 4; ++k) f.b[k].store(out[k]);
  }

  static void classical(int rule, const T* const extinction[3], const T* const color[3],
                        const T* length, T* const out[4]) {
    Material<B> at[3];
    for (int i = 0; i < 3; ++i) {
      const B c = B::load(color[i]);
      at[i] = {B::load(extinction[i]), {c, c, c}};
    }
    const B l = B::load(length);
    const SegmentResult<B> s = rule == 0   ? rectangle_segment(at[0], l)
                               : rule == 1 ? taylor_segment(at[0], l)
                               : rule == 2 ? midpoint_segment(at[1], l)
                               : rule == 3 ? average_segment(at[0], at[2], l)
                               : rule == 4 ? trapezoid_segment(at[0], at[2], l)
                                           : simpson_segment(at[0], at[1], at[2], l);
    s.optical_depth.store(out[0]);
    s.opacity.store(out[1]);
    s.transparency.store(out[2]);
    s.radiance.g.store(out[3]);
  }

  static void gaussian(const T* const p1[8], const T* const p2[8], const T* const d[8],
                       T* const out[3]) {
    B front[8], back[8], step[8];
    for (int k = 0; k < 8; ++k) {
      front[k] = B::load(p1[k]);
      back[k] = B::load(p2[k]);
      step[k] = B::load(d[k]);
    }
    gaussian_mean_density(front, back, step, 8).store(out[0]);
    kniss_mean_density(front, back, step, 8).store(out[1]);
    GaussianLine<B>(front, back, step, 8).mean_density(B(T(0.25)), B(T(0.75))).store(out[2]);
  }

  static void mixture(const T* primitives, int count, const T* const data[5], T* const out[7]) {
    Gaussian<T> all[8];
    for (int i = 0; i < count; ++i) {
      const T* number = primitives + 10 * i;
      Gaussian<T>& g = all[i];
      g.channels = g.rows = 2;
      for (int k = 0; k < 2; ++k) {
        g.center[k] = number[k];
        g.matrix[0][k] = number[2 + k];
        g.matrix[1][k] = number[4 + k];
      }
      g.peak = number[6];
      g.color = {number[7], number[8], number[9]};
    }
    const GaussianMixture<T> sum{all, count};
    const B v1[2] = {B::load(data[0]), B::load(data[1])};
    const B v2[2] = {B::load(data[2]), B::load(data[3])};
    const B length = B::load(data[4]);
    const BoundedSegment<B> s = gaussian_mixture_mean(sum, v1, v2, length);
    s.segment.optical_depth.store(out[0]);
    s.segment.opacity.store(out[1]);
    s.segment.radiance.r.store(out[2]);
    s.color_error.store(out[3]);
    gaussian_mixture_depth(sum, v1, v2, length).store(out[4]);
    sum.evaluate(v1).extinction.store(out[5]);
    gaussian_segment(all[0], v1, v2, length).optical_depth.store(out[6]);
  }

  static constexpr simd_kernels::Table<T> table = {
      unary<T>,    sizeof unary<T> / sizeof unary<T>[0],
      attenuation, linear,
      bernstein,   trilinear,
      classical,   gaussian,
      mixture};
};

constexpr simd_kernels::Kernels kernels = {PELLUCID_LANES, On<float>::table, On<double>::table};

}  // namespace
}  // namespace pellucid

extern "C" const simd_kernels::Kernels* PELLUCID_ENTRY(pellucid_simd_kernels)() {
  return &pellucid::kernels;
}
