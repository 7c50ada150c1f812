// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/linear.h"
#include "pellucid/transfer/piecewise_linear.h"

namespace pellucid {

/// Integrates the volume rendering integral (particle model) over data that are linear from v_f
/// (front) to v_b over the length, through a piecewise-linear transfer function. It cuts at the
/// control points in between, in ray order; each part is a linear_segment(), so that the sum is
/// exact (specification, 3.6).
///
/// Parts between control points begin and end with the table's own materials, not with interpolated
/// ones, and their lengths are differences of control values: nothing cancels in narrow intervals.
/// At a jump (two equal control values) one side ends and the other begins. v_f = v_b is one
/// constant segment; at a jump itself the right value holds.
///
/// Largest error: 16 u · opacity in opacity and, for colors <= 1, in each channel of radiance, if
/// at most 16 control points are crossed (3 u · opacity for each further one). Asserted in
/// tests/segment. Finite if the data's difference and extinction · length are.
template <class T>
PELLUCID_HD SegmentResult<T> piecewise_linear_segment(const PiecewiseLinear<T>& table, T v_f, T v_b,
                                                      T length) noexcept {
  int interval = table.interval(v_f);
  if (v_f == v_b) {
    const Material<T> m = table.evaluate_in(interval, v_f);
    return constant_segment(m.extinction, m.color, length);
  }
  const bool rising = v_b > v_f;
  SegmentResult<T> result;
  const T per_value = v_b - v_f;
  T value = v_f;
  Material<T> front = table.evaluate_in(interval, v_f);
  for (;;) {
    const bool crosses = rising ? interval < table.count && table.value[interval] < v_b
                                : interval > 0 && table.value[interval - 1] > v_b;
    const T next = crosses ? table.value[rising ? interval : interval - 1] : v_b;
    const Material<T> back = table.evaluate_in(interval, next);
    // A jump has no length, nor has the way from a control value into the interval below it.
    const T share = (next - value) / per_value;
    if (share > T(0) && (front.extinction > T(0) || back.extinction > T(0))) {
      result = compose(result, linear_segment(front.extinction, back.extinction, front.color,
                                              back.color, length * share));
    }
    if (!crosses) break;
    interval += rising ? 1 : -1;
    value = next;
    front = table.evaluate_in(interval, next);
  }
  result.opacity = min(result.opacity, T(1));
  return result;
}

}  // namespace pellucid
