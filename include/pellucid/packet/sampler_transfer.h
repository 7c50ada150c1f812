// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// A piecewise-linear transfer function for samples in lanes: a record of one line, by uniform bins
/// over the control points' range. A record that ends within its bin names the one that goes on, so
/// that the function is met exactly and not at the bins' resolution. A view; owns nothing.
struct SamplerTransfer {
  /// lower, upper, next, unused; extinction and color at lower; their slopes. A value >= upper is
  /// looked up in record `next`.
  const float* records = nullptr;
  float origin = 0, bins_per_value = 0;
  float last_bin = 0;
  float support_min = 0, support_max = 0;  ///< nothing absorbs outside; crossed over: nowhere

  static constexpr int fields = 12;
};

#if PELLUCID_HAS_BATCH_4
/// The material at values that are no NaN. Error: 4 u of the largest extinction and color of the
/// line, beside that of the value's own.
template <int N>
PELLUCID_ALWAYS_INLINE Material<Batch<float, N>> material_at(const SamplerTransfer& t,
                                                             Batch<float, N> value) noexcept {
  using F = Batch<float, N>;
  const F place = clamp((value - F(t.origin)) * F(t.bins_per_value), F(0), F(t.last_bin));
  Batch<std::int32_t, N> index = convert<std::int32_t>(place);
  F r[SamplerTransfer::fields];
  load_records<SamplerTransfer::fields>(t.records, index, r);
  for (auto further = value >= r[1]; any(further); further = value >= r[1]) {
    index = select(further, convert<std::int32_t>(r[2]), index);
    load_records<SamplerTransfer::fields>(t.records, index, r);
  }
  const F offset = value - r[0];
  return {max(multiply_add(offset, r[8], r[4]), F(0)),
          {multiply_add(offset, r[9], r[5]), multiply_add(offset, r[10], r[6]),
           multiply_add(offset, r[11], r[7])}};
}
#endif

}  // namespace pellucid
