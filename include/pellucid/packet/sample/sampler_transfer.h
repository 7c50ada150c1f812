// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/simd/batch.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// A piecewise-linear transfer function for samples in lanes: uniform bins over the control points'
/// range, each of a single line where that line holds all over it, and otherwise the lines one by
/// one, so that the function is met exactly and not at the bins' resolution. A view; owns nothing.
struct SamplerTransfer {
  /// Per bin: extinction and color at its lower edge, and how much they rise over the bin. NaN: it
  /// holds control points.
  const float* bins = nullptr;
  const float* first_line = nullptr;  ///< per bin: the line at its lower edge
  /// Per line: lower, upper, two unused; extinction and color at lower; their slopes.
  const float* lines = nullptr;
  /// Per bin, and once more, in two numbers that are to be added: of the control points below its
  /// lower edge the squares, summed, of what their slopes change by: of extinction times the
  /// largest color, and of colors times the extinction there, largest channel.
  const float* breakpoints = nullptr;
  /// The same of each control point, where there are few at which slopes change; else `breakpoints`
  /// says it in less time.
  static constexpr int max_breakpoints = 4;
  int few_breakpoints = max_breakpoints + 1;  ///< how many, and one more if there are too many
  float breakpoint[max_breakpoints] = {}, square[max_breakpoints] = {};
  float origin = 0, bins_per_value = 0;
  float bin_count = 0, bins_end = 0;       ///< how many, and just below that
  float support_min = 0, support_max = 0;  ///< nothing absorbs outside; crossed over: nowhere

  static constexpr int bin_fields = 8, line_fields = 12;
};

#if PELLUCID_HAS_BATCH_4
namespace detail {

template <int N>
Material<Batch<float, N>> material_on_lines(const SamplerTransfer& t, Batch<std::int32_t, N> bin,
                                            Batch<float, N> value) noexcept {
  using F = Batch<float, N>;
  auto line = convert<std::int32_t>(gather(t.first_line, bin));
  F r[SamplerTransfer::line_fields];
  load_records<SamplerTransfer::line_fields>(t.lines, line, r);
  for (auto further = value >= r[1]; any(further); further = value >= r[1]) {
    line = select(further, line + Batch<std::int32_t, N>(1), line);
    load_records<SamplerTransfer::line_fields>(t.lines, line, r);
  }
  const F offset = value - r[0];
  return {multiply_add(offset, r[8], r[4]),
          {multiply_add(offset, r[9], r[5]), multiply_add(offset, r[10], r[6]),
           multiply_add(offset, r[11], r[7])}};
}

}  // namespace detail

/// Returns the sum of squares of SamplerTransfer::breakpoints over the control points between two
/// values: where there are few, and a bin beside; else and up to two bins beside, with 2^-44 of
/// that of all points below, for what their sum has lost.
template <int N>
Batch<float, N> corners_between(const SamplerTransfer& t, Batch<float, N> least,
                                Batch<float, N> most) noexcept {
  using F = Batch<float, N>;
  using I = Batch<std::int32_t, N>;
  if (t.few_breakpoints <= SamplerTransfer::max_breakpoints) {
    const F bin = F(1) / F(t.bins_per_value), from = least - bin, to = most + bin;
    F sum(0);
    for (int i = 0; i < t.few_breakpoints; ++i) {
      const F breakpoint(t.breakpoint[i]);
      sum += select((from <= breakpoint) & (breakpoint <= to), F(t.square[i]), F(0));
    }
    return sum;
  }
  const auto at = [&](F value, float aside) noexcept {
    const F place = (value - F(t.origin)) * F(t.bins_per_value) + F(aside);
    return I(2) * convert<std::int32_t>(clamp(place, F(0), F(t.bin_count)));
  };
  const I first = at(least, -1), last = at(most, 2);
  const F below = gather(t.breakpoints, last);
  return (below - gather(t.breakpoints, first)) +
         (gather(t.breakpoints, last + I(1)) - gather(t.breakpoints, first + I(1))) +
         F(0x1p-44f) * below;
}

/// The material at values that are no NaN. Error: 4 u of the largest extinction and color of the
/// line, beside that of the value's own and what 4 u of the control points' range make.
template <int N>
PELLUCID_ALWAYS_INLINE Material<Batch<float, N>> material_at(const SamplerTransfer& t,
                                                             Batch<float, N> value) noexcept {
  using F = Batch<float, N>;
  const F place = clamp((value - F(t.origin)) * F(t.bins_per_value), F(0), F(t.bins_end));
  const Batch<std::int32_t, N> bin = convert<std::int32_t>(place);
  const F s = place - convert<float>(bin);
  F r[SamplerTransfer::bin_fields];
  load_records<SamplerTransfer::bin_fields>(t.bins, bin, r);
  Material<F> found{
      multiply_add(s, r[4], r[0]),
      {multiply_add(s, r[5], r[1]), multiply_add(s, r[6], r[2]), multiply_add(s, r[7], r[3])}};
  const auto several = is_nan(r[0]);
  if (any(several)) {
    const Material<F> exact = detail::material_on_lines(t, bin, value);
    found.extinction = select(several, exact.extinction, found.extinction);
    found.color.r = select(several, exact.color.r, found.color.r);
    found.color.g = select(several, exact.color.g, found.color.g);
    found.color.b = select(several, exact.color.b, found.color.b);
  }
  found.extinction = max(found.extinction, F(0));
  return found;
}
#endif

}  // namespace pellucid
