// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/packet/sample/sampler_transfer.h"
#include "pellucid/segment/sampled.h"
#include "pellucid/transfer/gaussian.h"

namespace pellucid {

/// A table of one channel alone, for samples in lanes.
struct SampledTable {
  int channel = 0;
  SamplerTransfer table;
};

/// A transfer function of several variables (transfer/multivariate.h) for samples in lanes. A view;
/// owns nothing.
struct SampledMultivariate {
  GaussianMixture<float> gaussians;
  const float* far = nullptr;  ///< per primitive: the exponent from which on it does not matter
  const SampledTable* table = nullptr;
  int tables = 0;
};

#if PELLUCID_HAS_BATCH_4  // in sources compiled per instruction set
/// Returns extinction and source of the primitives of a set and of all tables for data that are no
/// NaN, in the lanes of `wanted`; in others anything.
template <int N>
PELLUCID_ALWAYS_INLINE StepEnd<Batch<float, N>> extinction_and_emission(
    const SampledMultivariate& t, PrimitiveSet set, BatchMask<N> wanted,
    const Batch<float, N>* value) noexcept {
  using F = Batch<float, N>;
  StepEnd<F> sum{};
  for (int i = 0; i < t.gaussians.count; ++i) {
    if (!set.contains(i)) continue;
    const Gaussian<float>& g = t.gaussians.primitive[i];
    F square(0);
    for (int row = 0; row < g.rows; ++row) {
      F p(0);
      for (int c = 0; c < g.channels; ++c) {
        p = multiply_add(F(g.matrix[row][c]), value[c] - F(g.center[c]), p);
      }
      square = multiply_add(p, p, square);
    }
    const auto near = wanted & (square < F(t.far[i]));
    if (none(near)) continue;
    // Nothing where it does not matter: numbers that are not normal take many times as long.
    const F extinction = select(near, F(g.peak) * exp(F(0) - select(near, square, F(0))), F(0));
    sum.add(extinction, {F(g.color.r), F(g.color.g), F(g.color.b)});
  }
  for (int i = 0; i < t.tables; ++i) {
    const SamplerTransfer& table = t.table[i].table;
    const F& v = value[t.table[i].channel];
    const auto inside = wanted & (v >= F(table.support_min)) & (v <= F(table.support_max));
    if (none(inside)) continue;
    const Material<F> m = material_at(table, select(inside, v, F(table.support_min)));
    sum.add(select(inside, m.extinction, F(0)), m.color);
  }
  return sum;
}
#endif

}  // namespace pellucid
