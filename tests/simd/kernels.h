// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/instruction_set.h"

/// What kernels.cpp, compiled once per instruction set, gives to the tests, which are compiled for
/// none: the core's kernels on `lanes` numbers each. Arrays of batches are given as out[k][lane].
namespace simd_kernels {

template <class T>
struct Unary {
  const char* name;
  void (*run)(const T* x, T* y);
};
template <class T>
struct Table {
  const Unary<T>* unary;
  int unary_count;
  /// opacity, transparency
  void (*attenuation)(const T* x, T* const out[2]);
  /// depth, opacity, transparency, psi, weight_f, weight_b of linear_weights(); depth, opacity,
  /// transparency, weight_f, weight_b of emission_weights()
  void (*linear)(const T* extinction_f, const T* extinction_b, const T* length, T* const out[11]);
  /// f(ta); the four coefficients between ta and tb
  void (*bernstein)(const T* const b[4], const T* ta, const T* tb, T* const out[5]);
  /// eight corners, entry, exit; four coefficients
  void (*trilinear)(const T* const corners[8], const T* const entry[3], const T* const exit[3],
                    T* const out[4]);
  /// `rule` by its place in classical.h: rectangle, taylor, midpoint, average, trapezoid, simpson;
  /// extinction and color (one channel) in front, in the middle, behind; depth, opacity,
  /// transparency, radiance
  void (*classical)(int rule, const T* const extinction[3], const T* const color[3],
                    const T* length, T* const out[4]);
  /// The places of both ends and their difference, 8 numbers each; mean density, Kniss's, the mean
  /// density over [1/4, 3/4] of the line
  void (*gaussian)(const T* const p1[8], const T* const p2[8], const T* const d[8],
                   T* const out[3]);
  /// `count` primitives over two channels, each center, K by rows, peak, color: 10 numbers; data
  /// (v1 in 0 and 1, v2 in 2 and 3) and the length; depth, opacity, radiance (red), color_error,
  /// the depth by gaussian_mixture_depth(), the extinction at the front, the first one's depth
  void (*mixture)(const T* primitives, int count, const T* const data[5], T* const out[7]);
};
struct Kernels {
  int lanes;
  Table<float> single;
  Table<double> twice;
};

}  // namespace simd_kernels

extern "C" {
PELLUCID_DECLARE_ENTRIES(const simd_kernels::Kernels*, pellucid_simd_kernels, ());
}
